"""The velocity log is turned in its mount."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rovval.core.frames import rotation_from_euler
from rovval.effects.effect import Effect, Parameter, Tolerance
from rovval.effects.lanes import Array
from rovval.effects.log import Log

SOURCE = "0.5 to 10 degrees (chosen); 45 has been seen"
MOUNT = Tolerance(0.01, "rad: half a degree of mounting (chosen)", calibrated=False)

EFFECT = Effect(
    name="dvl_misalignment",
    title="Velocity log turned in its mount",
    place="sensor",
    equation="v_logged = R_zyx(roll, pitch, yaw)^T v.",
    symbols={
        "v": "velocity over ground u v w, body axes; m/s",
        "v_logged": "the same in the sensor's axes; m/s",
        "R_zyx": "rotation from the sensor's axes to body axes, by yaw, pitch, roll; rad",
    },
    parameters=(
        Parameter("yaw", "rad", -0.8, 0.8, 0.0, 0.05, SOURCE, tolerance=MOUNT),
        Parameter("pitch", "rad", -0.5, 0.5, 0.0, 0.03, SOURCE, tolerance=MOUNT),
        Parameter("roll", "rad", -0.5, 0.5, 0.0, 0.03, SOURCE, tolerance=MOUNT),
    ),
    signature="sway follows surge at once, without any dynamics",
    confused_with=("compass_deviation", "cross_drag", "current_constant", "thruster_misaligned"),
    separates="velocity against position and depth rate: no dynamics needed",
    literature=(
        "thesis, equation 3.7: the rotation",
        "Joyce 1989: scale and misalignment of an acoustic Doppler instrument",
        "Kinsey and Whitcomb 2007: alignment of a velocity log in the field",
    ),
    separable=True,
    stage="mounting",
)


def observe(log: Log, p: Mapping[str, Array]) -> Log:
    """Velocities in the sensor's axes."""
    seen = log.nu[..., :3] @ _mount(p)
    return replace(log, nu=np.concatenate([seen, log.nu[..., 3:]], axis=-1))


def unobserve(nu: Array, eta: Array, p: Mapping[str, Array]) -> tuple[Array, Array]:
    """True first state."""
    return np.concatenate([np.einsum("bij,bj->bi", _mount(p), nu[:, :3]), nu[:, 3:]], axis=-1), eta


def _mount(p: Mapping[str, Array]) -> Array:
    return rotation_from_euler(np.stack([p["roll"], p["pitch"], p["yaw"]], axis=-1))
