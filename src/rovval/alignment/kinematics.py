"""Pose against velocities, which are one by kinematics: a wrong sign, unit or scale shows without any dynamics.

A long log is taken in pieces whose sums are added up, so that the memory is that of a piece.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from rovval.core.data import Array, Flags, RawLog, Series
from rovval.core.errors import Finding
from rovval.core.frames import EULER_RANGE, euler_rates, rotation_from_euler
from rovval.core.units import mistaken_units

EULER = ("phi", "theta", "psi")
MOTION = ("u", "v", "w", "p", "q", "r", "x", "y", "z", *EULER)
CORRELATION = 0.5  # of two signals that are one by kinematics, beyond which a sign or a scale may be named
LEAST_SAMPLES = 50
PIECE = 1 << 18  # samples: some 70 MB while it is looked at, and the better part of an hour at 100 Hz


@dataclass(frozen=True, slots=True)
class Moments:
    """Of n pairs: their means, and their sums of squares and products about these."""

    n: int
    a: float
    b: float
    aa: float
    ab: float
    bb: float

    @classmethod
    def of(cls, a: Array, b: Array) -> Moments:
        """Of two arrays (n,)."""
        if not len(a):
            return cls(0, 0.0, 0.0, 0.0, 0.0, 0.0)
        ma, mb = float(a.mean()), float(b.mean())
        da, db = a - ma, b - mb
        return cls(len(a), ma, mb, float((da * da).sum()), float((da * db).sum()), float((db * db).sum()))

    def __add__(self, other: Moments) -> Moments:
        """Of both together (Chan, Golub and LeVeque, Am. Stat. 37, 1983, equation 2.1)."""
        n = self.n + other.n
        if not self.n or not other.n:
            return other if other.n else self
        da, db, share = other.a - self.a, other.b - self.b, self.n * other.n / n
        a, b = self.a + da * other.n / n, self.b + db * other.n / n
        return Moments(n, a, b, self.aa + other.aa + da * da * share, self.ab + other.ab + da * db * share, self.bb + other.bb + db * db * share)


def pose_against_velocities(raw: RawLog) -> list[Finding]:
    """Pose against the integral of the body velocities over a second: the same way twice."""
    if not all(n in raw.channels for n in EULER) or len(raw.channels["phi"].t) < LEAST_SAMPLES:
        return []
    t = raw.channels["phi"].t
    k = samples_of_a_second(t)
    pairs: list[tuple[str, Moments]] = []
    for piece in pieces(t, k):
        more = [(names, Moments.of(a, b)) for names, a, b in _moved(raw, t[piece], k)]
        pairs = [(names, old + new) for (names, old), (_, new) in zip(pairs, more, strict=True)] if pairs else more
    found: list[Finding] = []
    for names, moments in pairs:
        if moments.n >= LEAST_SAMPLES and not any(f.where == names for f in found):
            found += _agree(names, moments)
    return found


def _moved(raw: RawLog, t: Array, k: int) -> list[tuple[str, Array, Array]]:
    """The way over each ``k`` steps of ``t`` by the pose and by the velocities, where both are known: channels' names, (n,), (n,)."""
    c = {n: channel_at(raw.channels[n], t, n in EULER) for n in MOTION if n in raw.channels}
    euler = np.stack([c[n] for n in EULER], axis=1)
    moved: list[tuple[str, Array, Array]] = []
    if all(n in c for n in "pqr"):
        rates = euler_rates(euler, np.stack([c[n] for n in "pqr"], axis=1))
        moved += [(f"{n}, {b}", _step(c[n], k), way_over(rates[:, i], t, k)) for i, (n, b) in enumerate(zip(EULER, "pqr", strict=True))]
    if all(n in c for n in "uvwz"):
        down = np.einsum("ni,ni->n", rotation_from_euler(euler)[:, 2], np.stack([c[n] for n in "uvw"], axis=1))
        moved.append(("z, w", _step(c["z"], k), way_over(down, t, k)))
    if all(n in c for n in "uvwxyz"):
        turn = rotation_from_euler(euler)[k // 2 : k // 2 + len(t) - k]
        room = np.einsum("nji,nj->ni", turn, np.stack([_step(c[n], k) for n in "xyz"], axis=1))
        moved += [(f"{n}, {b}", room[:, i], way_over(c[b], t, k)) for i, (n, b) in enumerate(zip("xyz", "uvw", strict=True))]
    level = _while(np.abs(euler[:, :2]).max(axis=1) < EULER_RANGE, k) & (t[k:] - t[:-k] < 2.0)
    known = [level & np.isfinite(way) & np.isfinite(said) for _, way, said in moved]
    return [(names, way[there], said[there]) for (names, way, said), there in zip(moved, known, strict=True)]


def level_pose_against_velocities(raw: RawLog) -> list[Finding]:
    """Heading against r and depth against w, of a log that holds neither roll nor pitch: a vehicle that is level, or nearly."""
    found: list[Finding] = []
    for pose, rate in (("psi", "r"), ("z", "w")):
        if "phi" in raw.channels or "theta" in raw.channels or pose not in raw.channels or rate not in raw.channels:
            continue
        series, velocity = raw.channels[pose], raw.channels[rate]
        k = samples_of_a_second(series.t)
        moments = Moments.of(np.zeros(0), np.zeros(0))
        for piece in pieces(series.t, k):
            t, x = series.t[piece], series.values[piece]
            moved, said = _step(np.unwrap(x) if pose == "psi" else x, k), way_over(channel_at(velocity, t), t, k)
            known = np.isfinite(said) & (t[k:] - t[:-k] < 2.0)
            moments += Moments.of(moved[known], said[known])
        if moments.n >= LEAST_SAMPLES:
            agree = _agree(f"{pose}, {rate}", moments)
            found += [replace(f, detail=f"{f.detail}; roll and pitch are not logged, taken as none") for f in agree]
    return found


def samples_of_a_second(t: Array) -> int:
    """How many steps of ``t`` (s) are a second."""
    return max(1, round(1.0 / float(np.median(np.diff(t)))))


def pieces(t: Array, k: int) -> Iterator[slice]:
    """Stretches of ``t`` of which each ``k`` steps lie in one, and in one alone."""
    return (slice(first, min(first + PIECE, len(t) - k) + k) for first in range(0, len(t) - k, PIECE))


def channel_at(series: Series, t: Array, angle: bool = False) -> Array:
    """A channel at ``t`` (n,), NaN before and after its samples; an ``angle`` is interpolated over its wrap."""
    first = max(int(np.searchsorted(series.t, t[0], "right")) - 1, 0)
    end = int(np.searchsorted(series.t, t[-1], "left")) + 1
    at, values = series.t[first:end], series.values[first:end]
    return np.interp(t, at, np.unwrap(values) if angle else values, np.nan, np.nan) if len(at) else np.full(len(t), np.nan)


def way_over(rate: Array, t: Array, k: int) -> Array:
    """Integral of ``rate`` over each ``k`` steps; NaN where it is not known all along."""
    whole = np.concatenate(([0.0], np.cumsum(np.nan_to_num(0.5 * (rate[1:] + rate[:-1]) * np.diff(t)))))
    return np.where(_while(np.isfinite(rate), k), whole[k:] - whole[:-k], np.nan)


def _step(x: Array, k: int) -> Array:
    return np.asarray(x[k:] - x[:-k])


def _while(flag: Flags, k: int) -> Flags:
    """Whether ``flag`` holds all along each ``k`` steps."""
    broken = np.concatenate(([0], np.cumsum(~flag)))
    return np.asarray(broken[k + 1 :] == broken[: -k - 1])


def _agree(names: str, moments: Moments) -> list[Finding]:
    """A finding where the way of the pose, a, is not that of the velocities, b."""
    size = float(np.sqrt(moments.aa * moments.bb))
    if size < 1e-12 * moments.n:
        return []
    correlation, scale = moments.ab / size, moments.ab / moments.bb
    if correlation < -CORRELATION:
        detail = f"the pose runs against the velocity that is its rate (correlation {correlation:.2f}): one of the signs is wrong"
        return [Finding("sign", names, detail)]
    if correlation > 0.9 and not 0.8 < scale < 1.25:
        units = mistaken_units(scale)
        detail = f"the pose moves {scale:.3g} times what the velocity that is its rate gives: one of the units or scales is wrong" + (
            f" (the ratio of {units})" if units else ""
        )
        return [Finding("scale", names, detail)]
    return []
