"""Buoyancy falls to nothing as the hull rises through the surface."""

from __future__ import annotations

from collections.abc import Mapping

from rovval.effects.arithmetic import Number, clip
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

EFFECT = Effect(
    name="free_surface",
    title="Surface of the water",
    place="wrench",
    equation="F = share B (1 - clip(1/2 + (z - level) / height, 0, 1)) down, at the centre of buoyancy. A box that is out of the water to some part of its "
    "height has lost that part of its buoyancy; drag, added mass and thrust stay those of a submerged vehicle.",
    symbols={
        "F": "buoyancy that is lost, down in the north-east-down frame; N",
        "B": "buoyancy of the submerged vehicle; N",
        "z": "depth of the origin, taken as the middle of the hull; m",
        "level": "depth at which the log has the surface, where its depth counts from elsewhere; m",
        "height": "height of the hull, third number of its size in the vehicle's file; m",
    },
    parameters=(
        Parameter("share", "1", 0.0, 1.0, 0.0, 1.0, "thesis, section 2.4.2: buoyancy \"decreases to zero as the vehicle move towards the water surface\""),
        Parameter("level", "m", -1000.0, 12000.0, 0.0, 20.0, "logs whose depth counts from elsewhere (chosen)", role="datum"),
    ),
    signature="a light vehicle floats instead of flying out of the water; nothing at all below half of the hull's height",
    confused_with=("buoyancy_error", "waves"),
    separates="it acts at depths of less than half of the hull's height only",
    literature=("thesis, section 2.4.2", "Fossen 2021, section 4.1: restoring forces of submerged vehicles"),
    competes=False,
)
ROWS = ("lost", "level", "inverse", "bx", "by", "bz")


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """Buoyancy that there is to lose, N, depth of the surface, inverse height of the hull, and centre of buoyancy."""
    height = lanes.vehicle.body.size[2]
    centre = {name: lanes.centre_of_buoyancy[:, i] for i, name in enumerate(("bx", "by", "bz"))}
    return {"lost": p["share"] * lanes.buoyancy, "level": p["level"], "inverse": 0.0 * p["share"] + 1.0 / height, **centre}


def wrench(
    lost: Number, level: Number, inverse: Number, bx: Number, by: Number, bz: Number, z: Number, r31: Number, r32: Number, r33: Number
) -> tuple[Number, ...]:
    """The weight that is no longer borne, at the centre of buoyancy."""
    out = lost * (1.0 - clip(0.5 + (z - level) * inverse, 0.0, 1.0))
    X, Y, Z = out * r31, out * r32, out * r33
    return X, Y, Z, by * Z - bz * Y, bz * X - bx * Z, bx * Y - by * X
