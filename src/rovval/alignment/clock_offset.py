"""How late the navigation is stamped against the thrusters, from the log alone: a clue, not a measurement.

A change of thrust (of the signed square of the thrusters' speed) is followed at once by an acceleration that then dies away with
the drag, so that the correlation of the two sizes peaks at the change. The lag of the highest correlation within +-2 s is the offset of the two clocks
plus the thrusters' own lag (some 0.1 s); where the correlation is low there is no answer.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from rovval.core.channels import members
from rovval.core.data import Array
from rovval.core.peak import peak

LARGEST_OFFSET_S = 2.0
TREND_S = 5.0  # what is slower than this is trim, not a manoeuvre
LEAST_CORRELATION = 0.3  # correlation below which no lag is named
SHORTEST_LOG_S = 30.0  # a shorter log has too few manoeuvres


def estimated_offset(values: Mapping[str, Array], dt: float) -> tuple[float | None, float | None, str]:
    """Offset (s, positive: navigation late), its correlation, and a note; None where it cannot be had."""
    drive, family = _drive(values)
    moved = [_filled(values[n]) for n in ("u", "v", "w") if n in values]
    if drive is None or not moved:
        return None, None, "no offset: needs thrusters or sticks, and velocity"
    if len(drive) * dt < SHORTEST_LOG_S:
        return None, None, f"no offset: shorter than {SHORTEST_LOG_S:g} s"
    acceleration = np.sqrt(sum(_quick(np.diff(v, append=v[-1]) / dt, dt) ** 2 for v in moved))
    a, b = (_standard(x) for x in (drive, acceleration))
    if a is None or b is None:
        return None, None, "no offset: nothing moves"
    reach = round(LARGEST_OFFSET_S / dt)
    score = np.array([_overlap(a, b, k) for k in range(-reach, reach + 1)])
    best = int(np.argmax(score))
    if score[best] < LEAST_CORRELATION:
        return None, float(score[best]), f"no offset: best correlation {score[best]:.2f} is below {LEAST_CORRELATION:g}"
    at = peak(score)
    if at is None:
        return None, float(score[best]), f"no offset: not within {LARGEST_OFFSET_S:g} s"
    return float((at - reach) * dt), float(score[best]), f"of {family} against acceleration; includes the thrusters' own lag"


def _drive(values: Mapping[str, Array]) -> tuple[Array | None, str]:
    """Size of the change of what the thrusters (or sticks) do, thrust being near the signed square of speed."""
    for family, zero in (("n", 0.0), ("n_cmd", 0.0), ("pwm", 1500.0), ("stick", 0.0)):
        names = [f"{family}:{m}" for m in members(tuple(values), family)]
        if names:
            x = [_filled(values[n] - zero) for n in names]
            return np.asarray(np.sqrt(sum(np.diff(v * np.abs(v), prepend=v[0] * abs(v[0])) ** 2 for v in x))), family
    return None, ""


def _filled(v: Array) -> Array:
    """Missing values take the last one before them, so that a hole is no manoeuvre."""
    ok = np.isfinite(v)
    if not ok.any():
        return np.zeros(len(v))
    at = np.maximum.accumulate(np.where(ok, np.arange(len(v)), np.flatnonzero(ok)[0]))
    return np.asarray(v[at])


def _smooth(v: Array, n: int) -> Array:
    n = max(1, min(n, len(v)))
    padded = np.concatenate((np.full(n // 2, v[0]), v, np.full(n - 1 - n // 2, v[-1])))
    total = np.cumsum(np.concatenate(([0.0], padded)))
    return np.asarray((total[n:] - total[:-n]) / n)


def _quick(v: Array, dt: float) -> Array:
    return np.asarray(v - _smooth(v, round(TREND_S / dt) | 1))


def _standard(v: Array) -> Array | None:
    spread = float(np.std(v))
    return None if spread < 1e-12 else np.asarray((v - v.mean()) / spread)


def _overlap(a: Array, b: Array, k: int) -> float:
    x, y = (a[: len(a) - k], b[k:]) if k >= 0 else (a[-k:], b[:k])
    return float(np.mean(x * y))
