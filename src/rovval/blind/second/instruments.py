"""What the instruments make of the motion: white noise and random walk, quantisation, latency, drop-outs in bursts.

Sizes are chosen after data sheets: a 600 kHz DVL (0.2 % +- 1 mm/s a ping and 8 mm/s of white noise), a fibre-optic gyro's random walk, an AHRS, a
quartz pressure gauge in centimetres, an ultra-short base line smoothed by the navigation.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from scipy.signal import lfilter

from rovval.blind.plant.spec import STEP_S, Array

NORTH, EAST = 63.44, 10.40  # deg, the Trondheim fjord
DEGREE_M = 60.0 * 1852.0  # metres of a degree of latitude, by the nautical mile
VELOCITIES, RATES = ("LinVelX", "LinVelY", "LinVelZ"), ("AngVelX", "AngVelY", "AngVelZ")
LATE_S = 0.02  # latency of DVL and gyros
Log = dict[str, Array]


def walk(rng: np.random.Generator, many: int, a_minute: float, forgets_s: float = 600.0) -> Array:
    """A random walk from zero of standard deviation ``a_minute`` after a minute, that forgets over ``forgets_s``."""
    steps = a_minute * np.sqrt(STEP_S / 60.0) * rng.standard_normal(many)
    return np.asarray(lfilter([1.0], [1.0, -np.exp(-STEP_S / forgets_s)], steps))


def late(x: Array, by_s: float) -> Array:
    """The channel as it was ``by_s`` seconds before."""
    t = STEP_S * np.arange(len(x))
    return np.asarray(np.interp(t - by_s, t, x))


def measure(true: Mapping[str, Array], units: tuple[str, ...], rng: np.random.Generator) -> Log:
    """Channels of the log in its units, without gaps and before quantisation; heading unwrapped."""
    many = len(true["x"])

    def white(size: float) -> Array:
        return size * rng.standard_normal(many)

    log: Log = {
        "Latitude": NORTH + (true["x"] + walk(rng, many, 0.15, 90.0) + white(0.03)) / DEGREE_M,
        "Longitude": EAST + (true["y"] + walk(rng, many, 0.15, 90.0) + white(0.03)) / (DEGREE_M * np.cos(np.radians(NORTH))),
        "Depth": true["z"] + walk(rng, many, 0.006) + white(0.006),
        "Roll": np.degrees(true["roll"]) + walk(rng, many, 0.1) + white(0.06),
        "Pitch": np.degrees(true["pitch"]) + walk(rng, many, 0.1) + white(0.06),
        "Heading": np.degrees(true["yaw"]) + walk(rng, many, 0.15) + white(0.08),
    }
    bias = rng.normal(0.0, 0.02, 3)
    for name, key in zip(VELOCITIES, "uvw", strict=True):
        speed = late(true[key], LATE_S)
        log[name] = speed * (1.0 + white(0.002)) + white(0.008)
    for i, (name, key) in enumerate(zip(RATES, "pqr", strict=True)):
        log[name] = np.degrees(late(true[key], LATE_S)) + bias[i] + walk(rng, many, 0.01) + white(0.12)
    for name, key in zip(("LinAccX", "LinAccY", "LinAccZ"), "uvw", strict=True):
        log[name] = np.gradient(true[key], STEP_S) + white(0.03)
    for unit in units:
        log[f"{unit}_SP"] = true[f"n_cmd:{unit}"].copy()
        log[f"{unit}_PV"] = true[f"n:{unit}"] * (1.0 + white(0.003))
    log["Altitude"] = true["altitude"] * (1.0 + white(0.005)) + white(0.02)
    log["Voltage"] = true["voltage"] + white(0.003 * float(true["voltage"][0]))
    log["TetherLength"] = true["paid_out"] + white(0.05)
    return log


def spoil(log: Log, rng: np.random.Generator) -> None:
    """Quantise, and take out what drops out: bursts of the DVL by a two-state chain, a fix of the position now and then. In place."""
    many = len(log["Depth"])
    for name, grain in (("Depth", 0.01), *((n, 0.001) for n in VELOCITIES), *((n, 0.01) for n in RATES), ("Altitude", 0.01), ("TetherLength", 0.1)):
        log[name] = np.round(log[name] / grain) * grain
    for name in [n for n in log if n.endswith("_PV")]:
        log[name] = np.round(log[name])
    falls, comes_back = rng.random(many) < 1.0 / 700.0, rng.random(many) < 1.0 / 9.0
    lost = np.zeros(many, dtype=bool)
    for i in range(1, many):
        lost[i] = falls[i] or (lost[i - 1] and not comes_back[i])
    for name in (*VELOCITIES, "Altitude"):
        log[name][lost] = np.nan
    for _ in range(int(rng.poisson(many / 4000.0))):
        first = int(rng.integers(many))
        for name in ("Latitude", "Longitude"):
            log[name][first : first + int(rng.integers(5, 60))] = np.nan
    spikes = rng.integers(0, many, int(rng.poisson(many / 2000.0)))
    for i in spikes:
        log[VELOCITIES[int(rng.integers(3))]][i] += float(rng.standard_t(2.0)) * 0.2
    log["Heading"] = np.mod(log["Heading"], 360.0)
