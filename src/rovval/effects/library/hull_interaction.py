"""A jet that meets the hull loses thrust; one that runs along it is drawn to it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes, jet_on_hull

EFFECT = Effect(
    name="hull_interaction",
    title="Thruster and hull interaction",
    place="input",
    equation="T <- (1 - loss c) T for the sense of rotation whose jet points at the hull's middle, c the cosine of the angle it meets it at over "
    "that of the jet that meets it most squarely, which so loses loss (0 under a cosine of 0.1: it passes by); "
    "side force side |T at rest| towards the hull, across the thruster (Coanda; diagnosis.md A9).",
    parameters=(
        Parameter("loss", "1", -0.3, 1.0, 0.0, 0.15, "5 to 30 % (diagnosis.md A9)"),
        Parameter("side", "1", -0.5, 0.5, 0.0, 0.05, "chosen: a tenth of the thrust"),
    ),
    signature="gain depends on the sign of a thruster's speed, installed thrust differs from a bench's",
    confused_with=("reverse_asymmetry", "thruster_degraded", "thruster_misaligned"),
    separates="steps of both signs of every thruster",
)


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """Scale the gain of the sense that blows on the hull; hand the side force to the plant."""
    cosine = jet_on_hull(lanes.vehicle)
    loss = p["loss"][:, None]
    ahead, astern = (1.0 - loss * cosine[:, 0]) * lanes.k_pos, (1.0 - loss * cosine[:, 1]) * lanes.k_neg
    return replace(lanes, k_pos=ahead, k_neg=astern, side=lanes.side + np.asarray(p["side"]))
