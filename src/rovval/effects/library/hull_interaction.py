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
    equation="T <- (1 - loss c) T for the sense of rotation whose jet points at the hull's middle; a side force side |T at rest| towards the hull, across "
    "the thruster (Coanda).",
    symbols={
        "T": "thrust of a thruster, along its axis; N",
        "c": "cosine of the angle at which its jet meets the hull over that of the vehicle's jet that meets it most squarely; 0 under a cosine of 0.1: "
        "the jet passes by",
        "loss": "share lost by the jet that meets the hull most squarely",
        "side": "side force over thrust",
    },
    parameters=(
        Parameter("loss", "1", -0.3, 1.0, 0.0, 0.15, "5 to 30 % (chosen)", vanishes_at="high"),
        Parameter("side", "1", -0.5, 0.5, 0.0, 0.05, "chosen: a tenth of the thrust"),
    ),
    signature="gain depends on the sign of a thruster's speed, installed thrust differs from a bench's",
    confused_with=("reverse_asymmetry", "thruster_degraded", "thruster_misaligned"),
    separates="steps of both signs of every thruster",
    literature=("Lehn 1980: thruster and hull, the Coanda effect", "Nienhuis 1992: effectivity of installed thrusters"),
)
FULL_KERNEL = True


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """Scale the gain of the sense that blows on the hull; hand the side force to the plant."""
    cosine = jet_on_hull(lanes.vehicle)
    loss = p["loss"][:, None]
    ahead, astern = (1.0 - loss * cosine[:, 0]) * lanes.k_pos, (1.0 - loss * cosine[:, 1]) * lanes.k_neg
    return replace(lanes, k_pos=ahead, k_neg=astern, side=lanes.side + np.asarray(p["side"]))
