"""Sensitivities of the windows to body forces that the model lacks: any, and generic ones that depend on motion, place and thrusters."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from rovval.core.channels import AXES, VELOCITIES
from rovval.core.data import Array
from rovval.core.large_arrays import columns_first
from rovval.diagnose.criteria import LEAST_AXIS_FORCE, SIGN_SMOOTHING
from rovval.diagnose.residuals.sensitivities import LANES, simulate_windows
from rovval.diagnose.windows.windows import Windows, channel_difference, predicted_channels
from rovval.vehicle.model import allocation

STEP = 0.05  # of a force, for its finite difference


def generic_force_responses(runs: Sequence[Windows], beta: Array, features: Sequence[str] = ()) -> tuple[tuple[tuple[str, str], ...], list[Array]]:
    """Sensitivities to a generic force on each axis for each feature that all runs have (of ``features``, where given), about ``beta`` (k,).

    Returns (axis, feature) of the f forces, and sensitivities (m, n, c, f) of each run's windows to forces of the rms of the thrusters on the axis.
    """
    banks, wrench = [force_features(windows) for windows in runs], typical_wrench(runs)
    names = tuple((axis, f) for axis in AXES for f in banks[0] if all(f in bank for bank in banks) and (not features or f in features))
    forces = [[(axis, bank[f] * wrench[AXES.index(axis)]) for axis, f in names] for bank in banks]
    return names, [force_sensitivities(windows, beta, own) for windows, own in zip(runs, forces, strict=True)]


def damps(axis: str, feature: str) -> bool:
    """Whether a generic force with this feature goes with the velocity on its own axis alone, as a damping does."""
    own = VELOCITIES[AXES.index(axis)]
    return feature in (own, f"{own}|{own}|", f"|{own}|", f"sign of {own}")


def force_features(windows: Windows) -> dict[str, Array]:
    """What a generic force may depend on: series (run,) on the run's grid by name, each of unit rms, those left out that do not vary."""
    run = windows.run
    got = {c: _before(np.nan_to_num(run.get(c))) for c in ("u", "v", "w", "p", "q", "r", "z", "phi", "theta", "psi") if run.measured(c)}
    found: dict[str, Array] = {"constant": np.ones(len(run))}
    for c in ("u", "v", "w", "p", "q", "r"):
        if c in got:
            found[c], found[f"{c}|{c}|"] = got[c], got[c] * np.abs(got[c])
            found[f"|{c}|"] = np.abs(got[c])
    for c in ("u", "v", "w"):
        if c in got and (rms := float(np.sqrt(np.mean(got[c] ** 2)))) > 0.0:
            found[f"sign of {c}"] = np.tanh(got[c] / (SIGN_SMOOTHING * rms))
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
    thrust = windows.plant.thrust(windows.actuation.inputs.speed)
    for i, name in enumerate(windows.plant.vehicle.thrusters):
        found[f"thrust of {name}"], found[f"|thrust of {name}|"] = thrust[:, i], np.abs(thrust[:, i])
    scaled = {n: f / np.sqrt(np.mean(f**2)) for n, f in found.items() if np.mean(f**2) > 1e-12}
    return {n: f for n, f in scaled.items() if n == "constant" or np.std(f) > 1e-3}


def _before(series: Array) -> Array:
    """At each sample the one before: a force that goes by it is predetermined, and cannot go by what it makes itself (Ljung 1999, 13.4)."""
    return np.concatenate([series[:1], series[:-1]])


def force_sensitivities(windows: Windows, beta: Array, forces: Sequence[tuple[str, Array]]) -> Array:
    """Sensitivity (m, n, c, f) to f additional forces about ``beta`` (k,), each given as its axis and a series (run,) on the run's grid, N or N m."""

    def series(axis: str, sequence: Array) -> Array:
        wrench = np.zeros((len(windows.run), 6))
        wrench[:, AXES.index(axis)] = sequence
        return wrench

    return wrench_sensitivities(windows, beta, len(forces), lambda i: series(*forces[i]))


def wrench_sensitivities(windows: Windows, beta: Array, count: int, wrench: Callable[[int], Array]) -> Array:
    """Sensitivity (m, n, c, f) to ``count`` additional wrenches about ``beta`` (k,); ``wrench`` gives the series (run, 6) of each, N and N m, on the run's
    grid."""
    m, which = windows.count, np.arange(windows.count)
    base, _ = simulate_windows(windows, np.tile(beta, (m, 1)), windows.nu0, windows.eta0, which)
    S = columns_first(*base.shape, columns=count)
    each = max(1, LANES // m)
    for begin in range(0, count, each):
        bank = np.stack([wrench(i) for i in range(begin, min(begin + each, count))])
        some, lanes = len(bank), len(bank) * m
        motion = windows.plant.simulate(
            replace(windows.actuation.inputs, extra=bank), np.tile(windows.start, some), windows.steps, np.tile(windows.nu0, (some, 1)),
            np.tile(windows.eta0, (some, 1)), np.tile(beta, (lanes, 1)), np.repeat(np.arange(some), m), np.full(lanes, STEP),
        )  # fmt: skip
        out = predicted_channels(windows, np.tile(which, some), motion.nu, motion.eta).reshape(some, *base.shape)
        S[..., begin : begin + each] = np.moveaxis(channel_difference(windows, out, base[None]) / STEP, 0, -1)
    return S


def typical_wrench(runs: Sequence[Windows]) -> Array:
    """Rms force of the thrusters on each axis (6,), N and N m; at least `LEAST_AXIS_FORCE` of the largest."""
    total = np.zeros(6)
    for windows in runs:
        wrench = windows.plant.thrust(windows.actuation.inputs.speed) @ allocation(windows.plant.vehicle).T
        total += np.mean(wrench**2, axis=0) / len(runs)
    weight = windows.plant.vehicle.weight
    return np.asarray(np.maximum(np.sqrt(total), LEAST_AXIS_FORCE * max(float(np.sqrt(total.max())), LEAST_AXIS_FORCE * weight)))
