"""How the error of restarted windows grows with the time since their start."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rovval.core.channels import AXES, VELOCITIES
from rovval.core.data import Array, Comparison

HORIZONS_S = (1.0, 2.0, 5.0, 10.0)


@dataclass(frozen=True, slots=True)
class ErrorGrowth:
    """How the windows' error grows from their start: ``rms`` (k,) at ``seconds`` (k,) after it, over ``n`` (k,) windows."""

    seconds: Array
    rms: Array
    n: NDArray[np.int64]

    def at(self, seconds: float) -> tuple[float, float] | None:
        """(time, rms) at the step nearest to ``seconds`` that a window reaches, None when they end over 5 % before it."""
        k = int(np.argmin(np.abs(self.seconds - seconds)))
        t = float(self.seconds[k])
        return (t, float(self.rms[k])) if abs(t - seconds) <= 0.05 * seconds else None


def error_growth(comparison: Comparison) -> Mapping[str, ErrorGrowth]:
    """Per axis of the windows, the error against the time since the window's start."""
    run, windowed = comparison.run, comparison.sim.windowed
    step = _since_start(windowed.stretch)
    result = {}
    for j, (axis, name) in enumerate(zip(AXES, VELOCITIES, strict=True)):
        if axis not in comparison.windowed:
            continue
        keep = run.ok(name) & windowed.ok & (step >= 0)
        square = np.square(windowed.nu[keep, j] - run.get(name)[keep])
        total, n = np.bincount(step[keep], square), np.bincount(step[keep])
        k = np.flatnonzero(n >= max(1, n.max() // 4))  # a last, shorter window must not bend the curve's end
        result[axis] = ErrorGrowth(np.asarray(k * run.dt, dtype=np.float64), np.sqrt(total[k] / n[k]).astype(np.float64), n[k])
    return result


def _since_start(stretch: NDArray[np.int64]) -> NDArray[np.int64]:
    """Rows since the stretch of each row began (n,), -1 outside any."""
    rows = np.arange(len(stretch))
    begins = np.r_[True, stretch[1:] != stretch[:-1]]
    since = rows - np.maximum.accumulate(np.where(begins, rows, 0))
    return np.where(stretch >= 0, since, -1)
