"""Power spectral density of a series, by averaging over overlapping segments (Welch 1967), each without its mean and under a Hann window."""

from __future__ import annotations

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from rovval.core.data import Array, Flags

SEGMENT_S = 51.2  # chosen: 512 rows at 10 Hz, slow enough for a swing of half a minute; half of a shorter log


def power_spectrum(values: Array, ok: Flags, dt: float) -> tuple[Array, Array]:
    """Frequencies (k,) Hz from the lowest that a segment holds, and the one-sided density (k,) in unit^2/Hz, of the segments all of whose rows are
    ``ok``; empty where there is none. Its integral over frequency is the variance."""
    from scipy.signal import periodogram

    length = min(round(SEGMENT_S / dt), len(values) // 2)
    if length < 8:
        return np.empty(0), np.empty(0)
    begins = slice(None, None, length // 2)
    whole = sliding_window_view(ok, length)[begins].all(axis=1)
    if not whole.any():
        return np.empty(0), np.empty(0)
    segments = sliding_window_view(values, length)[begins][whole]
    frequencies, densities = periodogram(segments, 1.0 / dt, window="hann", detrend="constant")
    return np.asarray(frequencies[1:]), np.asarray(densities.mean(axis=0)[1:])
