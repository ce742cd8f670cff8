"""A SINDy-style floor: sparse regression of the residual acceleration on a generic library of terms, its largest term put into words.

Sequentially thresholded least squares (Brunton, Proctor, Kutz 2016), the optimizer of pysindy, written out here so that the floor is the
same with and without pysindy installed; a test holds it against what pysindy gives.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from rovval.blind.plant.spec import AXES, Array

THRESHOLD = 0.1  # of the residual's standard deviation: smaller terms are cut
RIDGE = 0.05  # alpha, pysindy's default
ROUNDS = 20  # pysindy's default
VELOCITIES = dict(zip("uvwpqr", AXES, strict=True))


def stlsq(features: Array, target: Array, threshold: float = THRESHOLD, ridge: float = RIDGE) -> Array:
    """Coefficients (k,) of ``features`` (n, k) for ``target`` (n,); those below ``threshold`` are zero."""
    kept = np.ones(features.shape[1], dtype=bool)
    coefficients = np.zeros(features.shape[1])
    for _ in range(ROUNDS):
        if not kept.any():
            return np.zeros(features.shape[1])
        x = features[:, kept]
        coefficients = np.zeros(features.shape[1])
        coefficients[kept] = np.linalg.solve(x.T @ x + ridge * np.eye(x.shape[1]), x.T @ target)
        small = np.abs(coefficients) < threshold
        if not (small & kept).any():
            break
        kept &= ~small
        coefficients[small] = 0.0
    return coefficients


def name(residual: Mapping[str, Array], features: Mapping[str, Array], thrusters: Sequence[str]) -> str:
    """Effect that the largest term stands for, "" where none is left. Axis by axis, everything in standard deviations."""
    scaled = {n: f / max(float(np.sqrt(np.mean(f**2))), 1e-12) for n, f in features.items()}
    bank = np.stack(list(scaled.values()), axis=1)
    best, found = 0.0, ""
    for axis, target in residual.items():
        weights = stlsq(bank, target / max(float(target.std()), 1e-12))
        k = int(np.argmax(np.abs(weights)))
        if abs(weights[k]) > best:
            best, found = float(abs(weights[k])), effect(axis, list(scaled)[k], thrusters)
    return found


def effect(axis: str, term: str, thrusters: Sequence[str]) -> str:
    """The effect of the library whose textbook form a term on an axis is."""
    velocity = term.partition("|")[0]
    fixed = {
        "depth": "density_gradient",
        "time": "voltage_sag",
        "cos heading": "current_constant",
        "sin heading": "current_constant",
    }
    if term == "constant":
        return {"heave": "buoyancy_error", "roll": "cg_offset", "pitch": "cg_offset"}.get(axis, "current_constant")
    if velocity in VELOCITIES:
        drag = "quadratic_drag" if "|" in term else "linear_drag"
        return f"{drag}[{axis}]" if VELOCITIES[velocity] == axis else "cross_drag"
    if term.removeprefix("|").removesuffix("|") in thrusters:
        return "reverse_asymmetry" if term.startswith("|") else f"thruster_degraded[{term}]"
    if term.startswith("u times "):
        return "inflow_loss"
    return fixed[term]


def terms(motion: Mapping[str, Array], thrust: Mapping[str, Array]) -> dict[str, Array]:
    """The library: constant, velocities and their squares, heading, depth, time, each thrust, its size, and its product with u."""
    found: dict[str, Array] = {"constant": np.ones_like(motion["u"])}
    for n in VELOCITIES:
        found[n], found[f"{n}|{n}|"] = motion[n], motion[n] * np.abs(motion[n])
    found["cos heading"], found["sin heading"] = np.cos(motion["psi"]), np.sin(motion["psi"])
    found["depth"], found["time"] = motion["z"] - motion["z"].mean(), motion["t"] - motion["t"].mean()
    for n, force in thrust.items():
        found[n], found[f"|{n}|"], found[f"u times {n}"] = force, np.abs(force), motion["u"] * np.abs(force)
    return found
