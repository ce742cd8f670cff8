"""The velocity log sits away from the point that the velocities are meant for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rovval.core.frames import skew
from rovval.effects.effect import Effect, Parameter, Tolerance
from rovval.effects.lanes import Array
from rovval.effects.log import Log

SOURCE = "up to 1 m (chosen)"
TAPE = Tolerance(0.05, "m: measured with a tape (chosen)", calibrated=False)

EFFECT = Effect(
    name="dvl_lever_arm",
    title="Lever arm of the velocity log",
    place="sensor",
    equation="v_logged = v + omega x r.",
    symbols={
        "v": "velocity over ground of the body's origin, u v w, body axes; m/s",
        "omega": "angular velocity p q r, body axes; rad/s",
        "r": "place of the sensor (x, y, z) from where it is meant to be, body axes; m",
    },
    parameters=(
        Parameter("x", "m", -3.0, 3.0, 0.0, 0.3, SOURCE, tolerance=TAPE),
        Parameter("y", "m", -3.0, 3.0, 0.0, 0.3, SOURCE, tolerance=TAPE),
        Parameter("z", "m", -3.0, 3.0, 0.0, 0.3, SOURCE, tolerance=TAPE),
    ),
    signature="sway and surge that come and go with the turn rate",
    confused_with=("cross_drag", "added_mass", "cg_offset"),
    separates="velocity against position in a turn on the spot: no dynamics needed",
    literature=("Groves 2013: velocity of a point of a rigid body, lever arms", "Kinsey and Whitcomb 2007: a velocity log beside other sensors"),
    separable=True,
    stage="position",
)


def observe(log: Log, p: Mapping[str, Array]) -> Log:
    """Velocity at the sensor."""
    seen = log.nu[..., :3] + log.nu[..., 3:] @ skew(_arm(p))
    return replace(log, nu=np.concatenate([seen, log.nu[..., 3:]], axis=-1))


def unobserve(nu: Array, eta: Array, p: Mapping[str, Array]) -> tuple[Array, Array]:
    """True first state."""
    return np.concatenate([nu[:, :3] - np.cross(nu[:, 3:], _arm(p)), nu[:, 3:]], axis=-1), eta


def _arm(p: Mapping[str, Array]) -> Array:
    return np.stack([p["x"], p["y"], p["z"]], axis=-1)
