"""How visible a log's gap is: the nominal vehicle replayed over it in short windows, by this plant and no other.

Windows restart from the measured state and are driven by the measured speeds; the gap is the root mean square of what the
replay misses on each channel. Against the gap of the healthy twin log (same seed, nothing planted) it says how clearly an effect
stands above calibration slop and noise. A yardstick for severities; the diagnosis under test never sees it.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rovval.blind.cases.flight import integrate, tolerances
from rovval.blind.plant.dynamics import BASE, Plant
from rovval.blind.plant.nominal_vehicle import read_vehicle
from rovval.blind.plant.parameters import nominal_parameters
from rovval.blind.plant.rotation import euler, quaternion
from rovval.blind.plant.scales import scales
from rovval.blind.plant.spec import RATE_HZ, STEP_S, Array, Flight

MOTION = ("LinVelX", "LinVelY", "LinVelZ", "AngVelX", "AngVelY", "AngVelZ")
ANGLES = ("Roll", "Pitch", "Heading")


@dataclass(slots=True)
class RecordedSpeeds:
    """Shafts that turn as recorded: the speed rises in a straight line to the next row's."""

    rate: Array

    def derivative(self, command: Array, y: Array, out: Array, at: int, many: int) -> None:
        """Constant rates within a row."""
        out[at : at + many] = self.rate
        out[at + many : at + 2 * many] = 0.0


def _filled(x: Array) -> Array:
    """Gaps bridged in a straight line."""
    good = np.isfinite(x)
    return np.interp(np.arange(len(x)), np.flatnonzero(good), x[good])


def gap(vehicle: Path, flight: Flight, window_s: float = 10.0) -> dict[str, float]:
    """Root mean square error of the nominal replay by channel (CSV units; depth and heading from the window's start)."""
    nominal = read_vehicle(vehicle)
    scale = scales(nominal)
    log = {name: _filled(x) for name, x in flight.measured.items()}
    log["Heading"] = np.degrees(np.unwrap(np.radians(log["Heading"])))
    speeds = np.stack([log[f"{unit}_PV"] for unit in nominal.thrusters], axis=1)
    drive = RecordedSpeeds(np.zeros(len(nominal.thrusters)))
    plant = Plant(nominal_parameters(nominal), [], scale, drive, bottom=1e6)
    atol, size = tolerances(plant, scale), round(window_s * RATE_HZ)
    wrong: list[list[float]] = []
    for first in range(0, len(flight.time_s) - size, size):
        y = np.zeros(plant.size)
        y[2] = log["Depth"][first]
        y[3:7] = quaternion(*(np.radians(log[name][first]) for name in ANGLES))
        rates = np.array([log[name][first : first + 3].mean() for name in MOTION])
        rates[3:] = np.radians(rates[3:])
        y[7:13] = plant.mass @ rates
        y[BASE : BASE + plant.many] = speeds[first]
        step, heading = 0.02, log["Heading"][first]
        for i in range(first, first + size):
            k = plant.see(0.0, y)
            turned = np.degrees(euler(*y[3:7].tolist()))
            now = [*k.vel[:3], *np.degrees(k.vel[3:]), turned[0], turned[1]]
            seen = [log[name][i] for name in (*MOTION, "Roll", "Pitch")]
            yaw = (turned[2] - heading) - (log["Heading"][i] - heading)
            row = [a - b for a, b in zip(now, seen, strict=True)]
            wrong.append([*row, (yaw + 180.0) % 360.0 - 180.0, k.z - log["Depth"][i]])
            drive.rate = (speeds[i + 1] - speeds[i]) / STEP_S
            y, step = integrate(plant, 0.0, y, step, atol)
    rms = np.sqrt(np.mean(np.array(wrong) ** 2, axis=0))
    return dict(zip((*MOTION, *ANGLES, "Depth"), rms.tolist(), strict=True))


def visibility(effect: dict[str, float], healthy: dict[str, float]) -> tuple[float, str]:
    """Largest ratio of the two gaps, and the channel that has it."""
    ratios = {name: effect[name] / healthy[name] for name in healthy}
    best = max(ratios, key=lambda name: ratios[name])
    return ratios[best], best
