"""The hull that really flies: the sheet's numbers, each a little off, and its resistance by power laws and strips.

Resistance along an axis is a |v|^(n-1) v with n and a such that it equals the sheet's at working speed and at half of it: a friction coefficient
that falls with a power of the Reynolds number (Hoerner 1965, ch. 2). Sway and heave are taken at five Gauss points along the hull (cross-flow
principle, Faltinsen 1990, 6.1), so that slipping and turning act on each other: by `STRIP_SHARE` of the sheet's drag of turning, at working speed.
"""

from __future__ import annotations

import copy
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from rovval.blind.plant.spec import Array
from rovval.blind.second.sheet import TURN_RAD_S, Sheet

NODES, WEIGHTS = (x.tolist() for x in np.polynomial.legendre.leggauss(5))
STRIP_SHARE = 0.03  # of the drag of turning (chosen): more of it would couple slip and turn by more than a file within tolerance may be off
SLIP = 0.6  # of the working speed: how fast a vehicle at work goes sideways or down (as the pilots ask for it)


@dataclass(slots=True)
class Hull:
    """Numbers of one vehicle in one flight; an effect may change any of them. SI, gains in N/rpm^2."""

    mass: float
    inertia: Array
    added: Array
    cg: Array
    cb: Array
    volume: float
    density: float
    gravity: float
    level: list[float]  # (6,) a of the power law
    power: list[float]  # (6,) n of the power law
    span: tuple[float, float]  # half-length of the strips in sway and in heave, m
    ahead: Array
    astern: Array
    curve: float  # static thrust goes as |n|^(2 + curve)
    at: Array
    aim: Array

    def copy(self) -> Hull:
        """A copy that shares no array."""
        return copy.deepcopy(self)

    def rigid(self) -> Array:
        """6 x 6 mass matrix of the body about the origin."""
        x, y, z = (self.mass * self.cg).tolist()
        arm = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        return np.block([[self.mass * np.eye(3), -arm], [arm, self.inertia]])

    def reach(self) -> Array:
        """(6, N): thrust to wrench."""
        return np.vstack([self.aim.T, np.cross(self.at, self.aim).T])

    def resistance(self, rel: list[float]) -> list[float]:
        """Wrench (6,) of the water on the hull that moves through it with ``rel`` (m/s, rad/s)."""
        u, v, w, p, q, r = rel
        a, n = self.level, self.power
        out = [-a[i] * abs(x) ** (n[i] - 1.0) * x if x else 0.0 for i, x in ((0, u), (3, p), (4, q), (5, r))]
        side, down, nod, swing = 0.0, 0.0, 0.0, 0.0
        for node, weight in zip(NODES, WEIGHTS, strict=True):
            x = node * self.span[0]
            slip = v + x * r
            push = 0.5 * weight * a[1] * abs(slip) ** (n[1] - 1.0) * slip if slip else 0.0
            side, swing = side - push, swing - x * push
            x = node * self.span[1]
            fall = w - x * q
            push = 0.5 * weight * a[2] * abs(fall) ** (n[2] - 1.0) * fall if fall else 0.0
            down, nod = down - push, nod + x * push
        return [out[0], side, down, out[1], out[2] + nod, out[3] + swing]


def law(first: float, half: float, speed: float) -> tuple[float, float]:
    """Level and power of a |v|^(n-1) v that is ``first`` at ``speed`` and ``half`` at half of it; nothing where there is nothing."""
    if first <= 0.0 or half <= 0.0:
        return 0.0, 2.0
    power = float(np.clip(np.log2(first / half), 1.0, 2.5))
    return first / speed**power, power


def _turning(sheet: Sheet, axis: int, level: float, power: float) -> tuple[float, float, float]:
    """Half-length of the strips, and level and power of what else resists a turn about ``axis``; none of it where the sheet has none."""

    def strips(span: float, slip: float, rate: float) -> float:
        """Moment of the strips against a turn at ``rate`` while they slip."""
        speeds = [(w, x * span, slip + x * span * rate) for x, w in zip(NODES, WEIGHTS, strict=True)]
        return float(sum(0.5 * w * x * level * abs(v) ** (power - 1.0) * v for w, x, v in speeds if v))

    def beyond(span: float) -> float:
        return strips(span, SLIP * sheet.cruise, TURN_RAD_S) - STRIP_SHARE * sheet.drag(axis, TURN_RAD_S)

    if level <= 0.0 or sheet.drag(axis, TURN_RAD_S) <= 0.0:
        return 0.0, *law(sheet.drag(axis, TURN_RAD_S), sheet.drag(axis, TURN_RAD_S / 2.0), TURN_RAD_S)
    span = sheet.half_length if beyond(sheet.half_length) < 0.0 else float(brentq(beyond, 0.0, sheet.half_length))
    rest = [sheet.drag(axis, rate) - strips(span, 0.0, rate) for rate in (TURN_RAD_S, TURN_RAD_S / 2.0)]
    return span, *law(rest[0], rest[1], TURN_RAD_S)


def hull(sheet: Sheet, slop: float, rng: np.random.Generator) -> Hull:
    """The sheet's vehicle, each number off by a share that is uniform within ``slop`` (forces of balance: of the working force); at zero slop
    none is off and thrust at rest goes by the square of speed."""

    def off(many: int) -> Array:
        return np.asarray(1.0 + slop * rng.uniform(-1.0, 1.0, many))

    laws = [law(sheet.drag(i, v), sheet.drag(i, v / 2.0), v) for i, v in enumerate([sheet.cruise] * 3 + [TURN_RAD_S] * 3)]
    yaw, pitch = _turning(sheet, 5, *laws[1]), _turning(sheet, 4, *laws[2])
    laws[4], laws[5] = pitch[1:], yaw[1:]
    root, round_ = np.sqrt(off(6)), np.sqrt(off(3))
    many = len(sheet.units)
    gains = off(many)
    arm = sheet.cb - sheet.cg
    tilt = 0.2 * slop * float(np.linalg.norm(arm)) * np.array([*rng.uniform(-1.0, 1.0, 2), 0.0])
    aim = sheet.aim + 0.3 * slop * rng.uniform(-1.0, 1.0, (many, 3))
    return Hull(
        mass=sheet.mass,
        inertia=sheet.inertia * np.outer(round_, round_),
        added=sheet.added * np.outer(root, root),
        cg=sheet.cg.copy(),
        cb=sheet.cg + arm * off(1)[0] + tilt,
        volume=sheet.volume + 0.5 * slop * sheet.force * float(rng.uniform(-1.0, 1.0)) / (sheet.density * sheet.gravity),
        density=sheet.density,
        gravity=sheet.gravity,
        level=[a * b for (a, _), b in zip(laws, off(6).tolist(), strict=True)],
        power=[n for _, n in laws],
        span=(yaw[0], pitch[0]),
        ahead=sheet.ahead * gains * (1.0 + 0.3 * (off(many) - 1.0)),
        astern=sheet.astern * gains * (1.0 + 0.3 * (off(many) - 1.0)),
        curve=slop * float(rng.uniform(-1.0, 1.0)),
        at=sheet.at.copy(),
        aim=aim / np.linalg.norm(aim, axis=1, keepdims=True),
    )
