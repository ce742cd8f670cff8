"""Close to the bottom the vehicle's own jets and wake push it off (or hold it down)."""

from __future__ import annotations

from collections.abc import Mapping

from rovval.effects.arithmetic import Number, exp
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

EFFECT = Effect(
    name="ground_effect",
    title="Ground effect near the bottom",
    place="wrench",
    equation="F = -gain exp(-altitude / height) down, at the origin.",
    symbols={
        "F": "force, down in the north-east-down frame; N",
        "gain": "force at the bottom, upwards; N",
        "altitude": "measured height above the bottom; m",
        "height": "height over which it falls off; m",
    },
    parameters=(
        Parameter("gain", "N", -60.0, 60.0, 0.0, 6.0, "chosen: up to half of the weight of the water that the jets move", "weight"),
        Parameter(
            "height", "m", 0.05, 5.0, 0.5, 0.3, "two to three propeller diameters (Bhattacharyya 2016) to 1 m (chosen)", role="extent", starts=(0.2, 0.5, 1.5),
        ),
    ),
    signature="a vertical force that is there below a metre or two of altitude only",
    confused_with=("buoyancy_error", "current_shear", "density_gradient"),
    separates="steps of altitude over the same spot",
    literature=("Bhattacharyya 2016: a small underwater vehicle in hydrodynamic ground effect",),
    needs=("altitude",),
    within={"altitude": 3.0},  # m, chosen: three times the largest reach above, where a twentieth is left
)
ROWS = ("gain", "inverse")


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """Force at the bottom, N, and inverse height, 1/m."""
    return {"gain": p["gain"], "inverse": 1.0 / p["height"]}


def wrench(gain: Number, inverse: Number, altitude: Number, r31: Number, r32: Number, r33: Number) -> tuple[Number, ...]:
    """Upward force in the body frame."""
    up = -gain * exp(-altitude * inverse)
    return up * r31, up * r32, up * r33, 0.0, 0.0, 0.0
