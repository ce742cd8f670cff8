"""The compass is off by an amount that depends on the heading."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from rovval.effects import Effect, Parameter
from rovval.effects._lanes import Array
from rovval.frames import wrap

if TYPE_CHECKING:
    from rovval.plant.sensors import Log

SOURCE = "1 to 20 degrees (diagnosis.md S7)"

EFFECT = Effect(
    name="compass_deviation",
    title="Compass deviation",
    place="sensor",
    equation="psi_logged = psi + offset + sine sin(psi) + cosine cos(psi) (coefficients A, B, C of a deviation card; diagnosis.md S7).",
    parameters=(
        Parameter("offset", "rad", -0.8, 0.8, 0.0, 0.05, SOURCE),
        Parameter("sine", "rad", -0.4, 0.4, 0.0, 0.05, SOURCE),
        Parameter("cosine", "rad", -0.4, 0.4, 0.0, 0.05, SOURCE),
    ),
    signature="heading error that repeats with the heading; position drifts aside",
    confused_with=("current_constant", "dvl_misalignment"),
    separates="gyro integrated over a full turn against the compass: no dynamics needed",
    needs=("psi",),
)


def observe(log: Log, p: Mapping[str, Array]) -> Log:
    """Heading as the compass shows it."""
    psi = log.eta[..., 5]
    shown = wrap(psi + _deviation(psi, p))
    return replace(log, eta=np.concatenate([log.eta[..., :5], shown[..., None]], axis=-1))


def unobserve(nu: Array, eta: Array, p: Mapping[str, Array]) -> tuple[Array, Array]:
    """True heading, by Newton's method; the bounds keep the deviation's slope below 0.57, so it converges."""
    shown = eta[:, 5:6]
    psi = shown - _deviation(shown, p)
    for _ in range(30):
        slope = 1.0 + p["sine"][:, None] * np.cos(psi) - p["cosine"][:, None] * np.sin(psi)
        psi = psi - (psi + _deviation(psi, p) - shown) / slope
    return nu, np.concatenate([eta[:, :5], psi], axis=-1)


def _deviation(psi: Array, p: Mapping[str, Array]) -> Array:
    return p["offset"][:, None] + p["sine"][:, None] * np.sin(psi) + p["cosine"][:, None] * np.cos(psi)
