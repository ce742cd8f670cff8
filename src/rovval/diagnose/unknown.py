"""What any systematic cause could explain: a ceiling of generic forces that depend on speed, attitude, heading, depth and thrusters.

It is never the explanation. It says how much of the gap is systematic at all, so that a library effect that is only the least bad is
not named, and it says on which axis and with what the unexplained force varies.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from rovval.channels import AXES
from rovval.data import Array
from rovval.diagnose.contest import Prior, Ring, fit, heldout
from rovval.diagnose.linearise import Linear, linearise, simulate_windows, state_spread
from rovval.diagnose.problem import Problem
from rovval.diagnose.products import Products, joined, products
from rovval.diagnose.stretches import Stretches, difference, predicted
from rovval.vehicle.model import allocation

SHARES = (0.01, 0.1, 1.0)  # prior sizes tried for a generic force, as a share of the thrusters' own rms on that axis


@dataclass(frozen=True, slots=True)
class Ceiling:
    """Held-out loss per window (m,) under generic forces; the axes it acts on and the features that carry it, best first."""

    loss: Array
    axes: tuple[tuple[str, float], ...]
    features: tuple[tuple[str, float], ...]


def ceiling(problem: Problem, beta: Array) -> Ceiling:
    """The best that a generic force (features x axes) achieves about ``beta``, on held-out windows."""
    data, names = _products(problem, beta)
    ring, free = Ring.of(data, problem.folds), range(len(names))
    best = min(SHARES, key=lambda s: fit(ring, _even(free, s), problem.inflation).loss)
    loss = heldout(data, problem.folds, _even(free, best), problem.inflation)
    by_axis = [(axis, _gain(ring, problem, [i for i, (a, _) in enumerate(names) if a == axis], best)) for axis in AXES]
    by_axis.sort(key=lambda item: -item[1])
    leading = by_axis[0][0]
    features = sorted({f for a, f in names if a == leading})
    by_feature = [(f, _gain(ring, problem, [i for i, (a, n) in enumerate(names) if a == leading and n == f], SHARES[-1])) for f in features]
    by_feature.sort(key=lambda item: -item[1])
    return Ceiling(loss, tuple(by_axis), tuple(by_feature))


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


def _products(problem: Problem, beta: Array) -> tuple[Products, list[tuple[str, str]]]:
    banks = [features_of(part) for part in problem.parts]
    shared = [name for name in banks[0] if all(name in bank for bank in banks)]
    names = [(axis, feature) for axis in AXES for feature in shared]
    sizes = _typical_wrench(problem.parts)
    parts = []
    for part, bank in zip(problem.parts, banks, strict=True):
        linear = linearise(part, beta, ())
        S = _forced(part, beta, [(a, bank[f] * sizes[AXES.index(a)]) for a, f in names])
        with_forces = Linear(linear.r, S, linear.J, tuple(range(len(names))), linear.valid)
        parts.append(products(with_forces, part.ok, problem.variance, state_spread(part)))
    return joined(parts), names


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


def _gain(ring: Ring, problem: Problem, free: Sequence[int], sd: float) -> float:
    """Held-out share of the loss that forces of these columns take away alone."""
    return 1.0 - fit(ring, _even(free, sd), problem.inflation).loss / float(ring.c.sum())


def _even(free: Sequence[int], sd: float) -> Prior:
    """The same prior on every column."""
    each: dict[int, float] = dict.fromkeys(free, sd)
    return Prior(each)
