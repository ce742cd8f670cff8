"""The depth sensor reads wrong: a factor, as of fresh water taken for salt, or by the pressure of the water that streams past its port."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rovval.effects.effect import Effect, Parameter, Tolerance
from rovval.effects.lanes import Array
from rovval.effects.log import Log

GRAVITY = 9.81  # m/s2
DENSITY = Tolerance(0.005, "density of the water known to half a per cent (chosen)", calibrated=False)

EFFECT = Effect(
    name="depth_error",
    title="Depth sensor",
    place="sensor",
    equation="z logged = (1 + scale) z + pressure u^2 / (2 g).",
    symbols={
        "z": "depth, north-east-down; m",
        "scale": "error of the density, or of a unit",
        "pressure": "pressure coefficient of the port, 1 where it faces the stream ahead; suction is negative",
        "u": "velocity ahead over ground, body axes; m/s",
        "g": "9.81 m/s2",
    },
    parameters=(
        Parameter(
            "scale", "1", -0.8, 2.5, 0.0, 0.03, "fresh water taken for salt: 2.7 %; the bounds hold a wrong unit, too: feet, 2.28", tolerance=DENSITY,
            error="factor",
        ),
        Parameter("pressure", "1", -10.0, 10.0, 0.0, 1.0, "of a cylinder's surface -3 to 1, of its ports in a frame's wake and jets more (chosen)"),
    ),
    signature="depth rate against w by a factor, or depth that shifts with the speed ahead while the vehicle stays level",
    confused_with=("dvl_scale", "attitude_bias", "dvl_misalignment"),
    separates="a dive along a line of known length; runs ahead and astern at constant depth of a line of buoys",
    literature=(
        "Fofonoff and Millard 1983: pressure to depth, UNESCO technical paper 44",
        "Gracey 1980: position error of static-pressure ports, NASA RP-1046",
    ),
    needs=("z", "w"),  # without a measured heave velocity a wrong depth is any force that lifts
    separable=True,
    stage="scale",
)


def observe(log: Log, p: Mapping[str, Array]) -> Log:
    """Depth as the sensor has it."""
    eta = log.eta.copy()
    eta[..., 2] = (1.0 + p["scale"])[:, None] * eta[..., 2] + _stream(log.nu[..., 0], p["pressure"][:, None])
    return replace(log, eta=eta)


def unobserve(nu: Array, eta: Array, p: Mapping[str, Array]) -> tuple[Array, Array]:
    """True first state."""
    true = eta.copy()
    true[..., 2] = (eta[..., 2] - _stream(nu[..., 0], p["pressure"])) / (1.0 + p["scale"])
    return nu, true


def _stream(u: Array, coefficient: Array) -> Array:
    """What the pressure of a stream of ``u`` (m/s) reads as in depth, m."""
    return np.asarray(coefficient * u * u / (2.0 * GRAVITY))
