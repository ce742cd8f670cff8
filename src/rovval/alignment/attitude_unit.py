"""Angles in radians that a profile calls degrees: too small by 57.3, which rates that are wrong alike do not show."""

from __future__ import annotations

import numpy as np

from rovval.core.data import Array, RawLog, Series
from rovval.core.errors import Finding
from rovval.core.frames import rotation_from_euler
from rovval.core.units import DEGREES

EULER = ("phi", "theta", "psi")
LEAST_SAMPLES = 50
TURN = 2.0 * np.pi / DEGREES  # rad: what is left of a whole turn in radians that is taken for degrees
WRAP_SHARE = 0.02  # of `TURN`: how exactly a step of the heading is a wrap
BETTER, GOOD = 4.0, 0.2  # misfit of the way covered, as a share of it: so many times better with angles 57.3 times as large, and then this good


def attitude_in_radians(raw: RawLog) -> tuple[Finding, ...]:
    """A finding where the heading wraps at 2 pi of its own unit, or where the velocities lead along the positions only with angles 57.3 times as large."""
    if "psi" in raw.channels and (wraps := _wraps(raw.channels["psi"])):
        seen = f"the heading stays below 6.29 degrees and steps by just 6.28 of them {wraps} time{'s'[: wraps > 1]}"
        return (Finding("unit", "phi, theta, psi", f"{seen}: it is in radians, which the profile calls degrees"),)
    misfit = _misfits(raw)
    if misfit is not None and misfit[1] < GOOD and misfit[0] > BETTER * misfit[1]:
        detail = (
            f"turned by the attitude as logged, the velocities miss {100 * misfit[0]:.0f} % of the way that the positions cover, with angles 57.3 times "
            f"as large {100 * misfit[1]:.0f} %: they are in radians, which the profile calls degrees"
        )
        return (Finding("unit", "phi, theta, psi", detail),)
    return ()


def _wraps(heading: Series) -> int:
    """How often a heading that stays within a turn of radians taken for degrees steps by just that turn."""
    if len(heading.values) < LEAST_SAMPLES or np.abs(heading.values).max() > TURN * (1.0 + WRAP_SHARE):
        return 0
    step = np.abs(np.diff(heading.values))
    return int((np.abs(step / TURN - 1.0) < WRAP_SHARE).sum()) if np.median(step) < 0.1 * TURN else 0


def _misfits(raw: RawLog) -> tuple[float, float] | None:
    """Mean square of what the velocities miss of the horizontal way over a second, as a share of the way's: as logged, and with angles 57.3 times larger."""
    names = ("x", "y", "u", "v", "w", *EULER)
    if not all(n in raw.channels for n in names) or len(raw.channels["phi"].t) < LEAST_SAMPLES:
        return None
    t = raw.channels["phi"].t
    c = {n: np.interp(t, raw.channels[n].t, raw.channels[n].values, np.nan, np.nan) for n in names if n not in EULER}
    c |= {n: _nearest(raw.channels[n], t) for n in EULER}
    k = max(1, round(1.0 / float(np.median(np.diff(t)))))
    moved = np.stack([c[n][k:] - c[n][:-k] for n in "xy"], axis=1)
    body = np.stack([c[n] for n in "uvw"], axis=1)
    shares = []
    for times in (1.0, DEGREES):
        rate = np.einsum("nij,nj->ni", rotation_from_euler(times * np.stack([c[n] for n in EULER], axis=1)), body)[:, :2]
        way = np.concatenate((np.zeros((1, 2)), np.cumsum(0.5 * (rate[1:] + rate[:-1]) * np.diff(t)[:, None], axis=0)))
        missed = moved - (way[k:] - way[:-k])
        known = np.isfinite(missed).all(axis=1) & (t[k:] - t[:-k] < 2.0)
        if known.sum() < LEAST_SAMPLES or not moved[known].any():
            return None
        shares.append(float(np.square(missed[known]).sum() / np.square(moved[known]).sum()))
    return shares[0], shares[1]


def _nearest(series: Series, t: Array) -> Array:
    """The last value at each ``t``: an angle that wraps is not interpolated over its wrap."""
    return np.asarray(series.values[np.clip(np.searchsorted(series.t, t, "right") - 1, 0, None)])
