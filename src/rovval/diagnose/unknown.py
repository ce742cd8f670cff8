"""What any systematic cause could explain: generic forces that depend on speed, attitude, heading, depth and thrusters.

They are never the explanation. Set free beside what was found and beside calibration slop, their evidence says how much of the gap is
systematic and still unexplained, so that a library effect that is only the least bad is not named; and on which axis and with
what the unexplained force varies.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from rovval.channels import AXES
from rovval.data import Array
from rovval.diagnose.contest import Fold, Prior, heldout
from rovval.diagnose.linearise import Linear, simulate_windows, state_spread
from rovval.diagnose.problem import Problem
from rovval.diagnose.products import Products, joined, products
from rovval.diagnose.settle import Point
from rovval.diagnose.stretches import Stretches, difference, predicted
from rovval.vehicle.model import allocation

SHARES = (0.01, 0.1, 1.0)  # prior sizes tried for a generic force, as a share of the thrusters' own rms on that axis


@dataclass(frozen=True, slots=True)
class Forces:
    """Generic forces ``names`` (axis, feature) beside the columns of a point: products of all (the forces last), the precision of the
    point's columns and the gradient that their priors add."""

    names: tuple[tuple[str, str], ...]
    data: Products
    precision: Array
    pull: Array
    inflation: float

    def evidence(self, axes: Sequence[str] = AXES, feature: str = "") -> float:
        """Twice the log Bayes factor of forces on ``axes`` (and of one feature only) over none, at the best of the prior sizes."""
        chosen = [i for i, (axis, name) in enumerate(self.names) if axis in axes and feature in ("", name)]
        return max(self._evidence(chosen, share) for share in SHARES) - self._evidence([], 1.0) if chosen else 0.0

    @property
    def features(self) -> tuple[str, ...]:
        """What the forces depend on."""
        return tuple(dict.fromkeys(name for _, name in self.names))

    def share(self, folds: Sequence[Fold]) -> float:
        """Part of the loss that all forces take away on held-out windows, everything else standing still."""
        k = len(self.precision)
        columns, whole = self.data.columns[k:], float(self.data.c.sum())
        kept = [float(heldout(self.data, folds, Prior(dict.fromkeys(columns, share)), self.inflation).sum()) for share in SHARES]
        return max(1.0 - min(kept) / whole, 0.0)

    def _evidence(self, chosen: Sequence[int], share: float) -> float:
        k = len(self.precision)
        free = np.array([*range(k), *(k + i for i in chosen)], dtype=int)
        ridge = np.concatenate([self.precision, np.full(len(chosen), self.inflation / share**2)])
        H = self.data.A.sum(axis=0)[np.ix_(free, free)] + np.diag(ridge)
        slope = self.data.b.sum(axis=0)[free] - np.concatenate([self.pull, np.zeros(len(chosen))])
        return float(slope @ np.linalg.solve(H, slope)) / self.inflation - float(np.linalg.slogdet(H)[1] - np.log(ridge).sum())


def forces(problem: Problem, point: Point) -> Forces:
    """Every feature on every axis, simulated about ``point``, with slop beside them."""
    return _beside(problem, point.beta, point.linear, point.precision, point.precision * point.offset)


def bare_forces(problem: Problem) -> Forces:
    """The same about the vehicle as it is, with nothing beside them: what the gap itself looks like."""
    still = tuple(replace(one, S=one.S[..., :0], columns=()) for one in problem.at_null)
    return _beside(problem, problem.origin, still, np.zeros(0), np.zeros(0))


def _beside(problem: Problem, beta: Array, linear: Sequence[Linear], precision: Array, pull: Array) -> Forces:
    banks = [features_of(part) for part in problem.parts]
    shared = [name for name in banks[0] if all(name in bank for bank in banks)]
    names = tuple((axis, feature) for axis in AXES for feature in shared)
    sizes = _typical_wrench(problem.parts)
    ids = tuple(range(len(beta), len(beta) + len(names)))
    parts = []
    for part, bank, one in zip(problem.parts, banks, linear, strict=True):
        extra = _forced(part, beta, [(a, bank[f] * sizes[AXES.index(a)]) for a, f in names])
        both = Linear(one.r, np.concatenate([one.S, extra], axis=-1), one.J, (*one.columns, *ids), one.valid)
        parts.append(products(both, part.ok, problem.variance, state_spread(part)))
    return Forces(names, joined(parts), precision, pull, problem.inflation)


def features_of(stretches: Stretches) -> dict[str, Array]:
    """What a generic force may depend on, on the run's grid (n,), each of unit rms."""
    run = stretches.run
    got = {c: np.nan_to_num(run.get(c)) for c in ("u", "v", "w", "p", "q", "r", "z", "phi", "theta", "psi") if run.measured(c)}
    found: dict[str, Array] = {"constant": np.ones(len(run))}
    for c in ("u", "v", "w", "p", "q", "r"):
        if c in got:
            found[c], found[f"{c}|{c}|"] = got[c], got[c] * np.abs(got[c])
            found[f"|{c}|"] = np.abs(got[c])
    for a, b in (("u", "v"), ("u", "r"), ("v", "r"), ("u", "w")):
        if a in got and b in got:
            found[f"{a}{b}"] = got[a] * got[b]
    if "psi" in got:
        found["cos heading"], found["sin heading"] = np.cos(got["psi"]), np.sin(got["psi"])
    for c, words in (("phi", "roll angle"), ("theta", "pitch angle"), ("z", "depth")):
        if c in got:
            found[words] = got[c] - got[c].mean()
    found["time"] = run.t - run.t.mean()
    if run.measured("altitude"):
        found["closeness to the bottom"] = np.exp(-np.maximum(np.nan_to_num(run.get("altitude"), nan=1e3), 0.0))
    thrust = stretches.plant.thrust(stretches.driven.inputs.speed)
    for i, name in enumerate(stretches.plant.vehicle.thrusters):
        found[f"thrust of {name}"], found[f"|thrust of {name}|"] = thrust[:, i], np.abs(thrust[:, i])
    scaled = {n: f / np.sqrt(np.mean(f**2)) for n, f in found.items() if np.mean(f**2) > 1e-12}
    return {n: f for n, f in scaled.items() if n == "constant" or np.std(f) > 1e-3}


def _forced(part: Stretches, beta: Array, forces: Sequence[tuple[str, Array]]) -> Array:
    """Sensitivity (m, n, c, f) to additional body forces given as sequences on the run's grid."""
    step = 0.05
    bank = np.zeros((len(forces), len(part.run), 6))
    for i, (axis, sequence) in enumerate(forces):
        bank[i, :, AXES.index(axis)] = sequence
    forced = replace(part, driven=replace(part.driven, inputs=replace(part.driven.inputs, extra=bank)))
    m = part.count
    which = np.arange(m)
    base, _ = simulate_windows(part, np.tile(beta, (m, 1)), part.nu0, part.eta0, which)
    S = np.zeros((*base.shape, len(forces)))
    each = max(1, 20_000 // m)
    for begin in range(0, len(forces), each):
        chosen = np.arange(begin, min(begin + each, len(forces)))
        lanes = len(chosen) * m
        motion = forced.plant.simulate(
            forced.driven.inputs, np.tile(part.start, len(chosen)), part.steps, np.tile(part.nu0, (len(chosen), 1)),
            np.tile(part.eta0, (len(chosen), 1)), np.tile(beta, (lanes, 1)), np.repeat(chosen, m), np.full(lanes, step),
        )
        out = predicted(part, motion.nu, motion.eta).reshape(len(chosen), *base.shape)
        S[..., chosen] = np.moveaxis(difference(part, out, base[None]) / step, 0, -1)
    return S


def _typical_wrench(parts: Sequence[Stretches]) -> Array:
    """Rms force of the thrusters on each axis (6,), N and N m; at least a hundredth of the largest, so that no axis is mute."""
    total = np.zeros(6)
    for part in parts:
        wrench = part.plant.thrust(part.driven.inputs.speed) @ allocation(part.plant.vehicle).T
        total += np.mean(wrench**2, axis=0) / len(parts)
    weight = part.plant.vehicle.weight
    return np.asarray(np.maximum(np.sqrt(total), 0.01 * max(float(np.sqrt(total.max())), 0.01 * weight)))
