"""The velocity log reads too much or too little: speed of sound, the angle of its beams, or the factor of one axis."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rovval.effects.effect import Effect, Parameter, Tolerance
from rovval.effects.lanes import Array
from rovval.effects.log import Log

AXES = ("surge", "sway", "heave")
BEAMS = np.radians(30.0)  # of the beams from the vertical (chosen; velocity logs have 20 to 30 degrees)
SOUND = Tolerance(0.005, "speed of sound known to within half a per cent (chosen)", calibrated=False)

EFFECT = Effect(
    name="dvl_scale",
    title="Scale of the velocity log",
    place="sensor",
    equation="u v w logged = (1 + scale) u v w; of one axis, (1 + scale) (1 + surge) u and so on. Where beams stand at b + angle from the vertical, "
    "b = 30 degrees, u and v are sin(b + angle) / sin b and w is cos(b + angle) / cos b times as much.",
    symbols={
        "u v w": "velocity over ground, body axes; m/s",
        "scale": "error of the speed of sound over the speed of sound; 1",
        "b, angle": "how far the beams are taken to lean, and by how much more they do; rad",
    },
    parameters=(
        Parameter(
            "scale", "1", -0.7, 1.2, 0.0, 0.02, "+-1 to 5 % (chosen); the bounds hold a wrong unit, too: knots, 0.94", tolerance=SOUND, error="factor",
        ),
        *(
            Parameter(axis, "1", -0.7, 1.2, 0.0, 0.02, "as scale: a factor of an export or of a driver on this axis", tolerance=SOUND, error="factor")
            for axis in AXES
        ),
        Parameter("angle", "rad", -0.3, 0.3, 0.0, 0.01, "half a degree of mounting or of refraction at the face (chosen)"),
    ),
    signature="depth rate against w, distance run against position",
    confused_with=("rpm_scale", "quadratic_drag"),
    separates="integral of w against depth: no dynamics needed",
    literature=("Joyce 1989: scale and misalignment of an acoustic Doppler instrument", "Kinsey and Whitcomb 2007: calibration of a velocity log in the field"),
    refines=(*AXES, "angle"),
    separable=True,
    stage="scale",
)


def observe(log: Log, p: Mapping[str, Array]) -> Log:
    """Scale the velocities."""
    return replace(log, nu=np.concatenate([log.nu[..., :3] * _factors(p)[:, None], log.nu[..., 3:]], axis=-1))


def unobserve(nu: Array, eta: Array, p: Mapping[str, Array]) -> tuple[Array, Array]:
    """True first state."""
    return np.concatenate([nu[:, :3] / _factors(p), nu[:, 3:]], axis=-1), eta


def _factors(p: Mapping[str, Array]) -> Array:
    """Factor (b, 3) of each axis."""
    level, upright = np.sin(BEAMS + p["angle"]) / np.sin(BEAMS), np.cos(BEAMS + p["angle"]) / np.cos(BEAMS)
    return np.stack([(1.0 + p["scale"]) * (1.0 + p[axis]) * beams for axis, beams in zip(AXES, (level, level, upright), strict=True)], axis=-1)
