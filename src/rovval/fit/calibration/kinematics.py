"""What kinematics alone say of a vehicle's sensors: velocities integrated through the attitude must give the position that was measured, whatever the
forces are.

How the frame of a velocity sensor is turned against that of the attitude, and its lever arm, show in the parity residuals of a log (`residuals.parity`), which
no equation of motion has a part in. In the simulated windows they show too, but there they make up for what the equations of motion are off by, if nothing
holds them. Parity residuals are linear in them, so that a run's likelihood is quadratic. What else may be off of sensors, each run's own within its tolerance,
is at its most probable beside them.

What pose and velocity are off by together shows in the motion alone: those of a motion capture are of one point and in one frame, neither of which need be the
vehicle's. So the pose may be turned, and be that of another point, as the velocity is. Rates of turn are left out: they may be turned with the attitude.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rovval import effects
from rovval.core.data import Array, Run
from rovval.core.errors import BadInput
from rovval.diagnose.problem.prior import tolerance_prior
from rovval.diagnose.residuals.parity import parity_residuals
from rovval.diagnose.residuals.ridge import eliminated
from rovval.diagnose.windows.multiple_shooting import cut
from rovval.fit.calibration.estimate import Quadratic
from rovval.fit.calibration.random_effects import SLOP
from rovval.fit.calibration.unknowns import LEVER, SENSORS, TILT, Unknown
from rovval.plant import parse_settings
from rovval.simulation import carried_effects
from rovval.vehicle.model import Vehicle

# What the pose may be off by as the velocity is, and by how much; of roll and pitch unknowns of its own say it.
TOGETHER = {"velocity.yaw": TILT, "velocity.lever.x": LEVER, "velocity.lever.y": LEVER, "velocity.lever.z": LEVER}


@dataclass(frozen=True, slots=True)
class Kinematics:
    """The log likelihood of a run in unknowns of the sensors, by their ``keys`` (s,), about the values that the vehicle's file has: its ``curvature`` (s, s)
    and its ``slope`` (s,) there."""

    keys: tuple[str, ...]
    curvature: Array
    slope: Array

    def of(self, chosen: Sequence[Unknown]) -> Quadratic:
        """The same in the unknowns ``chosen`` (k,), those that are none of the sensors' with nothing said of them."""
        place = np.array([[float(one.key == key) for key in self.keys] for one in chosen]).reshape(len(chosen), len(self.keys))
        return Quadratic(place @ self.curvature @ place.T, place @ self.slope)


def kinematics(run: Run, vehicle: Vehicle, window_s: float) -> Kinematics:
    """What a run says of the sensors without a simulation; nothing where it holds no pose beside velocities, or too few windows."""
    try:
        [windows], _ = cut([run], vehicle, "fossen", window_s)
    except BadInput:
        return Kinematics((), np.zeros((0, 0)), np.zeros(0))
    plant = windows.plant
    own = {plant.index[f"{effect}.{parameter}"]: key for key, (effect, parameter) in SENSORS.items()}
    sd = {s: x for s, x in tolerance_prior(plant, SLOP).sd.items() if effects.load(plant.slots[s].effect).place == "sensor" and s not in own}
    columns = (*own, *sd)
    beta = parse_settings(plant, carried_effects(vehicle))
    data = parity_residuals(windows, columns).only("xyz").normal_equations(beta, columns, 1.0, summed=True)
    pose = [i for i, key in enumerate(own.values()) if key in TOGETHER]
    moved = np.hstack([np.eye(len(columns)), -np.eye(len(columns))[:, pose]])  # what the pose is off by undoes as much of the velocity
    others = np.arange(len(own), len(columns) + len(pose))
    ridge = np.diag([x**-2 for x in (*sd.values(), *TOGETHER.values())])
    curvature, slope = eliminated(moved.T @ data.A[0] @ moved, moved.T @ data.b[0], others, ridge, np.zeros(len(others)))
    return Kinematics(tuple(own.values()), curvature[: len(own), : len(own)], slope[: len(own)])
