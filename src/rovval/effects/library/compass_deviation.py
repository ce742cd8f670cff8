"""The compass is off by an amount that depends on the heading."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rovval.core.frames import wrap
from rovval.effects.effect import Effect, Parameter, Tolerance
from rovval.effects.lanes import Array
from rovval.effects.log import Log

SOURCE = "1 to 20 degrees (chosen)"
HALVINGS = 52  # of at most 3.8 rad: to rounding
SOFT = "soft iron: a few degrees (chosen: a quarter of the first harmonic)"
SWUNG = Tolerance(0.03, "rad: 2 degrees after a field calibration (chosen)", calibrated=False)

EFFECT = Effect(
    name="compass_deviation",
    title="Compass deviation",
    place="sensor",
    equation="psi_logged = psi + offset + sine sin(psi) + cosine cos(psi) + sine_2 sin(2 psi) + cosine_2 cos(2 psi) (coefficients A to E of a "
    "deviation card).",
    symbols={"psi": "heading, from north; rad", "offset, sine, cosine": "A, B, C: mounting and hard iron; rad", "sine_2, cosine_2": "D, E: soft iron; rad"},
    parameters=(
        Parameter("offset", "rad", -0.8, 0.8, 0.0, 0.05, SOURCE, tolerance=SWUNG),
        Parameter("sine", "rad", -0.4, 0.4, 0.0, 0.05, SOURCE, tolerance=SWUNG),
        Parameter("cosine", "rad", -0.4, 0.4, 0.0, 0.05, SOURCE, tolerance=SWUNG),
        Parameter("sine_2", "rad", -0.14, 0.14, 0.0, 0.02, SOFT, tolerance=SWUNG),
        Parameter("cosine_2", "rad", -0.14, 0.14, 0.0, 0.02, SOFT, tolerance=SWUNG),
    ),
    signature="heading error that repeats with the heading; position drifts aside",
    confused_with=("current_constant", "dvl_misalignment"),
    separates="gyro integrated over a full turn against the compass: no dynamics needed",
    literature=("NGA 2004: coefficients A to E of a deviation card", "Gebre-Egziabher 2006: hard and soft iron of strapdown magnetometers"),
    needs=("psi",),
    refines=("sine_2", "cosine_2"),
    stage="bias",
)


def observe(log: Log, p: Mapping[str, Array]) -> Log:
    """Heading as the compass shows it."""
    psi = log.eta[..., 5]
    shown = wrap(psi + _deviation(psi, p))
    return replace(log, eta=np.concatenate([log.eta[..., :5], shown[..., None]], axis=-1))


def unobserve(nu: Array, eta: Array, p: Mapping[str, Array]) -> tuple[Array, Array]:
    """True heading, halving the interval in which it lies; the bounds keep the deviation's slope below 0.97, so that there is one."""
    shown = eta[:, 5:6]
    most = sum((abs(p[part.name]) for part in EFFECT.parameters), np.zeros(len(shown)))[:, None]
    low, high = shown - most, shown + most
    for _ in range(HALVINGS):
        psi = 0.5 * (low + high)
        beyond = psi + _deviation(psi, p) > shown
        low, high = np.where(beyond, low, psi), np.where(beyond, psi, high)
    return nu, np.concatenate([eta[:, :5], 0.5 * (low + high)], axis=-1)


def _deviation(psi: Array, p: Mapping[str, Array]) -> Array:
    first = p["sine"][:, None] * np.sin(psi) + p["cosine"][:, None] * np.cos(psi)
    return p["offset"][:, None] + first + p["sine_2"][:, None] * np.sin(2.0 * psi) + p["cosine_2"][:, None] * np.cos(2.0 * psi)
