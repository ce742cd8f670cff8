"""Closed loops: how much of the motion the thrusters answer, and what that does to a replay.

In the water a small disturbance tilts the vehicle until righting moment and autopilot balance it. The simulator gets the autopilot's moment without
the disturbance, and tilts until the righting moment alone balances that: further, by the loop gain (closed-loop identification: Ljung 1999, 13.4).
Residuals of roll and pitch are larger by as much, without any fault of the model.

Where thrusters answer a velocity within a sample, what pushes the vehicle is in the velocity that they answer, and part of their damping is read as the
hull's, or as a force that goes with the motion. In the median of 16 logs of a BlueROV2 under plant b's pilots a half of the thrusters' moment in roll is
such an answer by the estimate itself, of which less is used (the lower end of its interval), and four tenths in pitch; of 12 logs of a Merlin, under the
pilots of both plants, next to nothing is.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from scipy.special import ndtri

from rovval.core.channels import AXES, VELOCITIES
from rovval.core.data import Array, Flags
from rovval.diagnose.criteria import INTERVAL_PROBABILITY, MATERIAL
from rovval.diagnose.windows.windows import Windows
from rovval.vehicle.model import allocation, as_matrix

TILTS = {"roll": ("phi", "p", 3), "pitch": ("theta", "q", 4)}  # angle, its rate and the axis of the moment


def loop_gains(runs: Sequence[Windows]) -> dict[str, float]:
    """Loop gain of roll, pitch and yaw, without unit: the mean over runs. Of yaw, which nothing rights, it is that of the answer to the rate over the drag."""
    tilts = {axis: float(np.mean([loop_gain(windows, *where) for windows in runs])) for axis, where in TILTS.items()}
    return tilts | {"yaw": float(np.mean([_yaw_gain(windows) for windows in runs]))}


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


def fast_damping(windows: Windows) -> dict[str, float]:
    """Force or moment (N s/m, N m s/rad) of one run that the thrusters put against a velocity within a sample of it, by axis: the lower end of its interval,
    0 where the log does not show that they do.

    Least squares of the thrusters' force on the samples before: F_k = f0 + a F_(k-1) - d v_(k-1) + e v_(k-2), of which d is the answer to the newest velocity:
    what a pilot or an autopilot wants of the motion is in the others (direct identification of a controller; Ljung 1999, 13.4).
    """
    run, plant = windows.run, windows.plant
    forces = plant.thrust(windows.actuation.inputs.speed) @ allocation(plant.vehicle).T
    return {
        axis: _answer(force, run.get(c), run.ok(c) & windows.actuation.known) if run.measured(c) else 0.0
        for axis, c, force in zip(AXES, VELOCITIES, forces.T, strict=True)
    }


def answered_forces(runs: Sequence[Windows]) -> dict[str, float]:
    """Rms (N, N m) of the force by which the thrusters answer the velocity on each axis within a sample (`fast_damping`), the mean over runs."""
    found = dict.fromkeys(AXES, 0.0)
    for windows in runs:
        for (axis, damping), c in zip(fast_damping(windows).items(), VELOCITIES, strict=True):
            if damping > 0.0:
                found[axis] += damping * float(np.sqrt(np.mean(windows.run.get(c)[windows.run.ok(c)] ** 2))) / len(runs)
    return found


def _answer(force: Array, velocity: Array, known: Flags) -> float:
    """The lower end of the interval of the answer d of one axis, of series (run,)."""
    use = known[2:] & known[1:-1] & known[:-2]
    X = np.column_stack([np.ones(use.sum()), force[1:-1][use], velocity[1:-1][use], velocity[:-2][use]])
    if len(X) <= X.shape[1] or force[2:][use].std() == 0.0:
        return 0.0
    found, *_ = np.linalg.lstsq(X, force[2:][use], rcond=None)
    left = force[2:][use] - X @ found
    sd = float(np.sqrt(left @ left / (len(X) - X.shape[1]) * np.linalg.pinv(X.T @ X)[2, 2]))
    return max(-float(found[2]) - float(ndtri(0.5 + 0.5 * INTERVAL_PROBABILITY)) * sd, 0.0)


def _yaw_gain(windows: Windows) -> float:
    """Damping of yaw by the thrusters over that by the hull at the run's usual rate."""
    run, body = windows.run, windows.plant.vehicle.body
    if not run.measured("r"):
        return 0.0
    linear, quadratic = (float(as_matrix(drag)[5, 5]) for drag in (body.linear_drag, body.quadratic_drag))
    drag = linear + quadratic * float(np.sqrt(np.mean(run.get("r")[run.ok("r")] ** 2)))
    return fast_damping(windows)["yaw"] / drag if drag > 0.0 else 0.0
