"""The attitude sensor sits askew: roll and pitch have a constant bias."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rovval.core.frames import turned
from rovval.effects.effect import Effect, Parameter, Tolerance
from rovval.effects.lanes import Array
from rovval.effects.log import Log

SOURCE = "1 to 5 degrees (chosen)"
STATIC = Tolerance(0.01, "rad: AHRS of the class give 0.2 to 0.5 degrees static (Xsens MTi)", calibrated=False)

EFFECT = Effect(
    name="attitude_bias",
    title="Attitude bias",
    place="sensor",
    equation="R_logged = R exp(S((phi, theta, 0))): near level, roll and pitch are logged with phi and theta added.",
    symbols={
        "R": "rotation from body axes to the north-east-down frame",
        "phi, theta": "tilt of the sensor in the vehicle; rad",
        "S": "cross product as a matrix",
    },
    parameters=(
        Parameter("phi", "rad", -0.3, 0.3, 0.0, 0.03, SOURCE, tolerance=STATIC),
        Parameter("theta", "rad", -0.3, 0.3, 0.0, 0.03, SOURCE, tolerance=STATIC),
    ),
    signature="a standing angle without the moment that would hold it; depth changes while running level",
    confused_with=("cg_offset", "dvl_misalignment", "buoyancy_error"),
    separates="depth rate against u sin(theta): no dynamics needed",
    literature=("Titterton and Weston 2004: alignment errors", "Kinsey and Whitcomb 2007: alignment of attitude and velocity sensors in the field"),
    needs=("phi", "theta"),
    separable=True,
    wanders=True,  # in-run instability in an AHRS's data sheet
    stage="bias",
)


def observe(log: Log, p: Mapping[str, Array]) -> Log:
    """Attitude of the sensor, which sits askew in the vehicle."""
    return replace(log, eta=_turned(log.eta, _tilt(p)[:, None]))


def unobserve(nu: Array, eta: Array, p: Mapping[str, Array]) -> tuple[Array, Array]:
    """True first state."""
    return nu, _turned(eta, -_tilt(p))


def _turned(eta: Array, by: Array) -> Array:
    return np.concatenate([eta[..., :3], turned(eta[..., 3:], by)], axis=-1)


def _tilt(p: Mapping[str, Array]) -> Array:
    return np.stack([p["phi"], p["theta"], np.zeros_like(p["phi"])], axis=-1)
