"""The gyros have a constant bias."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rovval.effects.effect import Effect, Parameter, Tolerance
from rovval.effects.lanes import Array
from rovval.effects.log import Log

SOURCE = "0.1 to 1 degree/s (chosen)"
DRIFT = Tolerance(0.002, "rad/s: 0.1 degree a second, MEMS in-run bias with temperature (Groves 2013)", calibrated=False)

EFFECT = Effect(
    name="gyro_bias",
    title="Gyro bias",
    place="sensor",
    equation="(p, q, r)_logged = (p, q, r) + bias.",
    symbols={"p, q, r": "rates of roll, pitch and yaw, body axes; rad/s", "bias": "what each gyro adds; rad/s"},
    parameters=tuple(Parameter(axis, "rad/s", -0.1, 0.1, 0.0, 0.005, SOURCE, tolerance=DRIFT) for axis in ("p", "q", "r")),
    signature="a rate that does not go away when lying still, and an attitude that does not follow it",
    confused_with=("propeller_torque", "cg_offset"),
    separates="attitude rate against p q r: no dynamics needed",
    literature=("Groves 2013: gyro errors, in-run bias instability", "Titterton and Weston 2004: gyro errors"),
    separable=True,
    wanders=True,  # in-run instability in a gyro's data sheet
    stage="bias",
)


def observe(log: Log, p: Mapping[str, Array]) -> Log:
    """Add the bias."""
    return replace(log, nu=np.concatenate([log.nu[..., :3], log.nu[..., 3:] + _bias(p)[:, None]], axis=-1))


def unobserve(nu: Array, eta: Array, p: Mapping[str, Array]) -> tuple[Array, Array]:
    """True first state."""
    return np.concatenate([nu[:, :3], nu[:, 3:] - _bias(p)], axis=-1), eta


def _bias(p: Mapping[str, Array]) -> Array:
    return np.stack([p["p"], p["q"], p["r"]], axis=-1)
