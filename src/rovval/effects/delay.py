"""What a sensor that is late writes of a motion."""

from __future__ import annotations

import numpy as np

from rovval.effects.lanes import Array


def delayed(true: Array, late: Array) -> Array:
    """Values (B, n, c) of ``late`` (B,) samples ago, linear between samples; held beyond the first and the last."""
    last = true.shape[1] - 1
    sample = np.arange(last + 1)
    seen = true.copy()
    for delay in np.unique(late[late != 0]):  # a diagnosis asks for few delays in many lanes
        lanes = np.flatnonzero(late == delay)
        x = np.clip(sample - delay, 0.0, last)
        low = np.minimum(x.astype(np.int64), max(last - 1, 0))
        own = true if len(lanes) == len(late) else true[lanes]
        before, between = own.take(low, axis=1), own.take(np.minimum(low + 1, last), axis=1)
        between -= before
        between *= (x - low)[:, None]
        between += before
        seen[lanes] = between
    return seen
