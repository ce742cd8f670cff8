"""Loop gain of an autopilot that holds roll and pitch with the thrusters, and what it does to the variance of a replay.

In the water a small disturbance tilts the vehicle until righting moment and autopilot balance it. The simulator gets the autopilot's moment without
the disturbance, and tilts until the righting moment alone balances that: further, by the loop gain (closed-loop identification: Ljung 1999, 13.4).
Residuals of roll and pitch are larger by as much, without any fault of the model.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.criteria import MATERIAL
from rovval.diagnose.windows.windows import Windows
from rovval.vehicle.model import allocation

TILTS = {"roll": ("phi", "p", 3), "pitch": ("theta", "q", 4)}  # angle, its rate and the axis of the moment


def loop_gains(runs: Sequence[Windows]) -> dict[str, float]:
    """Loop gain of roll and pitch, without unit: the mean over runs."""
    return {axis: float(np.mean([loop_gain(windows, *where) for windows in runs])) for axis, where in TILTS.items()}


def variance_factors(runs: Sequence[Windows], gain: Mapping[str, float]) -> Array:
    """Factor (c,) on the variance of each residual channel: (1 + loop gain)^2 for roll and pitch, else 1."""
    channels = runs[0].channels
    by_channel = {c: (1.0 + gain[axis]) ** 2 for axis, (angle, rate, _) in TILTS.items() for c in (angle, rate)}
    return np.array([by_channel.get(c, 1.0) for c in channels])


def loop_gain(windows: Windows, angle: str, rate: str, axis: int) -> float:
    """Loop gain of one run: the thrusters' moment against an angle over the righting moment; 0 where they do not follow the angle.

    ``angle`` and ``rate`` are channels such as phi and p, ``axis`` the index of the moment among the six axes.
    Least squares of the thrusters' moment (from the recorded speeds) on angle and rate: M = m0 - k angle - d rate.
    """
    run, vehicle = windows.run, windows.plant.vehicle
    if not (run.measured(angle) and run.measured(rate)):
        return 0.0
    moment = windows.plant.thrust(windows.actuation.inputs.speed) @ allocation(vehicle)[axis]
    use = run.ok(angle) & run.ok(rate) & windows.actuation.known
    X = np.column_stack([np.ones(use.sum()), run.get(angle)[use], run.get(rate)[use]])
    if len(X) <= X.shape[1] or moment[use].std() == 0.0:
        return 0.0
    found, *_ = np.linalg.lstsq(X, moment[use], rcond=None)
    explained = 1.0 - float(np.var(moment[use] - X @ found) / np.var(moment[use]))
    height = abs(vehicle.body.centre_of_gravity[2] - vehicle.body.centre_of_buoyancy[2])
    righting = vehicle.weight * height
    return max(-float(found[1]), 0.0) / righting if explained > MATERIAL and righting > 0 else 0.0
