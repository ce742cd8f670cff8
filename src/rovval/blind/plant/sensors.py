"""The healthy instruments: true motion to the log's channels, in the log's units, with noise, drop-outs and outliers.

Sizes are chosen after data sheets of the class of instrument (DVL 10 mm/s, fibre-optic or good MEMS gyro, pressure depth,
transponder-aided position).
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from scipy.signal import lfilter

from rovval.blind.plant.spec import STEP_S, Array

LATITUDE, LONGITUDE = 58.97, 5.73  # deg, off Stavanger
METRES_PER_DEGREE = 111_320.0  # flat earth
DVL = ("LinVelX", "LinVelY", "LinVelZ")


def wander(rng: np.random.Generator, many: int, size: float, tau: float) -> Array:
    """Ornstein-Uhlenbeck noise of standard deviation ``size`` and correlation time ``tau`` (s), (many,)."""
    keep = float(np.exp(-STEP_S / tau))
    push = size * np.sqrt(1.0 - keep * keep) * rng.standard_normal(many)
    push[0] = size * rng.standard_normal()
    return np.asarray(lfilter([1.0], [1.0, -keep], push))


def measure(true: Mapping[str, Array], units: tuple[str, ...], rng: np.random.Generator) -> dict[str, Array]:
    """The CSV's channels but the time, before any planted sensor effect and without gaps."""
    many = len(true["x"])

    def white(size: float) -> Array:
        return size * rng.standard_normal(many)

    north = true["x"] + wander(rng, many, 0.10, 120.0) + white(0.02)
    east = true["y"] + wander(rng, many, 0.10, 120.0) + white(0.02)
    log = {
        "Latitude": LATITUDE + north / METRES_PER_DEGREE,
        "Longitude": LONGITUDE + east / (METRES_PER_DEGREE * np.cos(np.radians(LATITUDE))),
        "Depth": true["z"] + wander(rng, many, 0.008, 20.0) + white(0.01),
        "Roll": np.degrees(true["phi"]) + wander(rng, many, 0.2, 40.0) + white(0.05),
        "Pitch": np.degrees(true["theta"]) + wander(rng, many, 0.2, 40.0) + white(0.05),
        "Heading": np.degrees(true["psi"]) + wander(rng, many, 0.4, 80.0) + white(0.05),
    }
    for name, key in zip(DVL, "uvw", strict=True):
        log[name] = true[key] + white(0.01)
    for name, key in zip(("AngVelX", "AngVelY", "AngVelZ"), "pqr", strict=True):
        log[name] = np.degrees(true[key]) + white(0.1)
    for name, key in zip(("LinAccX", "LinAccY", "LinAccZ"), "uvw", strict=True):
        log[name] = np.gradient(true[key], STEP_S) + white(0.02)
    grain = max(1.0, 0.003 * float(np.max(np.abs([true[f"n:{name}"] for name in units]))))
    for name in units:
        log[f"{name}_SP"] = true[f"n_cmd:{name}"].copy()
        log[f"{name}_PV"] = true[f"n:{name}"] + white(grain)
    log["Altitude"] = true["altitude"] + white(0.02)
    log["Voltage"] = true["voltage"] * (1.0 + white(0.002))
    log["TetherLength"] = true["tether_length"] + white(0.02)
    return log


def spoil(log: dict[str, Array], rng: np.random.Generator) -> None:
    """Drop-outs of the DVL and (rarely) of position, outliers of the DVL; empty cells are NaN. In place."""
    many = len(log["Depth"])
    for _ in range(int(rng.poisson(many / 1000.0)) + 1):
        first, size = int(rng.integers(0, many)), int(rng.integers(4, 25))
        for name in (*DVL, "Altitude"):
            log[name][first : first + size] = np.nan
    if rng.random() < 0.3:
        first = int(rng.integers(0, many))
        for name in ("Latitude", "Longitude"):
            log[name][first : first + int(rng.integers(5, 40))] = np.nan
    for _ in range(int(rng.poisson(many / 1500.0))):
        log[DVL[int(rng.integers(0, 3))]][int(rng.integers(0, many))] += float(rng.choice([-1.0, 1.0]) * rng.uniform(0.3, 0.9))


def finish(log: dict[str, Array]) -> None:
    """Bring the heading into 0 to 360 degrees, in place, after every effect on it."""
    log["Heading"] = np.mod(log["Heading"], 360.0)
