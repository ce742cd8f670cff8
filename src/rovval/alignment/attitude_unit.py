"""Angles in radians that a profile calls degrees: too small by 57.3, which rates that are wrong alike do not show."""

from __future__ import annotations

import numpy as np

from rovval.alignment.kinematics import channel_at, pieces, samples_of_a_second, way_over
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
    k = samples_of_a_second(t)
    known, covered, missed = 0, 0.0, np.zeros(2)
    for piece in pieces(t, k):
        samples, way, beside = _of_piece(raw, t[piece], k)
        known, covered, missed = known + samples, covered + way, missed + beside
    return (float(missed[0] / covered), float(missed[1] / covered)) if known >= LEAST_SAMPLES and covered else None


def _of_piece(raw: RawLog, t: Array, k: int) -> tuple[int, float, Array]:
    """Samples, sum of squares of the horizontal way over each ``k`` steps of ``t``, and that of what the velocities miss of it: as logged, and with angles
    57.3 times larger."""
    c = {n: channel_at(raw.channels[n], t) for n in ("x", "y", "u", "v", "w")}
    c |= {n: _nearest(raw.channels[n], t) for n in EULER}
    moved = np.stack([c[n][k:] - c[n][:-k] for n in "xy"], axis=1)
    body = np.stack([c[n] for n in "uvw"], axis=1)
    beside = []
    for times in (1.0, DEGREES):
        rate = np.einsum("nij,nj->ni", rotation_from_euler(times * np.stack([c[n] for n in EULER], axis=1)), body)[:, :2]
        beside.append(moved - np.stack([way_over(along, t, k) for along in rate.T], axis=1))
    known = np.isfinite(beside[0]).all(axis=1) & (t[k:] - t[:-k] < 2.0)
    return int(known.sum()), float(np.square(moved[known]).sum()), np.array([float(np.square(b[known]).sum()) for b in beside])


def _nearest(series: Series, t: Array) -> Array:
    """The last value at each ``t``: an angle that wraps is not interpolated over its wrap."""
    return np.asarray(series.values[np.clip(np.searchsorted(series.t, t, "right") - 1, 0, None)])
