"""The gyros read too much or too little by a factor."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rovval.effects.effect import Effect, Parameter, Tolerance
from rovval.effects.lanes import Array
from rovval.effects.log import Log

AXES = ("p", "q", "r")
CALIBRATED = Tolerance(0.005, "half a per cent, consumer gyros after their own calibration (chosen; Groves 2013: 0.1 to 5 % uncalibrated)", calibrated=False)

EFFECT = Effect(
    name="gyro_scale",
    title="Scale of the gyros",
    place="sensor",
    equation="p logged = (1 + scale of p) p; so q and r.",
    symbols={"p, q, r": "rates of roll, pitch and yaw, body axes; rad/s"},
    parameters=tuple(
        Parameter(axis, "1", -0.7, 1.2, 0.0, 0.03, "MEMS 1 to 5 % (Groves 2013), and factors of an export (chosen)", tolerance=CALIBRATED, error="factor")
        for axis in AXES
    ),
    signature="a turn by the integrated rate is longer or shorter than by the heading",
    confused_with=("gyro_bias", "time_offset", "compass_deviation"),
    separates="several whole turns to one side: rate against heading, no dynamics needed",
    literature=("Groves 2013: scale factor errors of gyros", "Titterton and Weston 2004: gyro errors"),
    separable=True,
    stage="scale",
)


def observe(log: Log, p: Mapping[str, Array]) -> Log:
    """Scale the rates."""
    return replace(log, nu=np.concatenate([log.nu[..., :3], log.nu[..., 3:] * _factors(p)[:, None]], axis=-1))


def unobserve(nu: Array, eta: Array, p: Mapping[str, Array]) -> tuple[Array, Array]:
    """True first state."""
    return np.concatenate([nu[:, :3], nu[:, 3:] / _factors(p)], axis=-1), eta


def _factors(p: Mapping[str, Array]) -> Array:
    """Factor (b, 3) of each axis."""
    return np.stack([1.0 + p[axis] for axis in AXES], axis=-1)
