"""How alike the values of a series are to those a lag later (Box and Jenkins 1976, 2.1), over what is there."""

from __future__ import annotations

import numpy as np

from rovval.core.data import Array, Flags


def autocovariance(values: Array, most: int) -> Array:
    """Of a series (n,) without gaps at lags of 0 to ``most`` rows (most + 1,): sums over n, so that it is positive semidefinite."""
    return _lagged(values - values.mean(), most) / len(values)


def autocorrelation(values: Array, ok: Flags, most: int) -> Array:
    """At lags of 0 to ``most`` rows (most + 1,), over the pairs of rows of which both are ``ok``; NaN where there is no pair, and of a series that does
    not vary."""
    centred = np.where(ok, values - values[ok].mean() if ok.any() else 0.0, 0.0)
    pairs = np.round(_lagged(ok.astype(float), most))
    with np.errstate(invalid="ignore", divide="ignore"):
        covariance = _lagged(centred, most) / np.where(pairs > 0, pairs, np.nan)
        return np.asarray(covariance / covariance[0] if covariance[0] > 0.0 else np.full(most + 1, np.nan))


def _lagged(values: Array, most: int) -> Array:
    """Sums of the products of values ``0`` to ``most`` rows apart."""
    size = 1 << (len(values) + most).bit_length()
    spectrum = np.fft.rfft(values, size)
    return np.asarray(np.fft.irfft(np.abs(spectrum) ** 2, size)[: most + 1])
