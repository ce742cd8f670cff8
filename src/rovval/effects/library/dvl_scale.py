"""The velocity log reads too much or too little: speed of sound, or the factor of one axis."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array
from rovval.effects.log import Log

AXES = ("surge", "sway", "heave")

EFFECT = Effect(
    name="dvl_scale",
    title="Scale of the velocity log",
    place="sensor",
    equation="u v w logged = (1 + scale) u v w, scale = error of the speed of sound (diagnosis.md S4); of one axis, (1 + scale) (1 + surge) u and so on.",
    parameters=(
        Parameter("scale", "1", -0.7, 1.2, 0.0, 0.02, "+-1 to 5 % (diagnosis.md S4); the bounds hold a wrong unit, too: knots, 0.94"),
        *(Parameter(axis, "1", -0.7, 1.2, 0.0, 0.02, "as scale: a factor of an export or of a driver on this axis") for axis in AXES),
    ),
    signature="depth rate against w, distance run against position",
    confused_with=("rpm_scale", "quadratic_drag"),
    separates="integral of w against depth: no dynamics needed",
    refines=AXES,
    apart=True,
)


def observe(log: Log, p: Mapping[str, Array]) -> Log:
    """Scale the velocities."""
    return replace(log, nu=np.concatenate([log.nu[..., :3] * _factors(p)[:, None], log.nu[..., 3:]], axis=-1))


def unobserve(nu: Array, eta: Array, p: Mapping[str, Array]) -> tuple[Array, Array]:
    """True first state."""
    return np.concatenate([nu[:, :3] / _factors(p), nu[:, 3:]], axis=-1), eta


def _factors(p: Mapping[str, Array]) -> Array:
    """Factor (b, 3) of each axis."""
    return np.stack([(1.0 + p["scale"]) * (1.0 + p[axis]) for axis in AXES], axis=-1)
