"""Water that gets denser with depth: buoyancy grows as the vehicle dives, through a layer beyond which it hardly changes."""

from __future__ import annotations

from collections.abc import Mapping

from rovval.effects.arithmetic import Number, sqrt
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

EFFECT = Effect(
    name="density_gradient",
    title="Density changes with depth",
    place="wrench",
    equation="B(z) = B + gradient h g V at the centre of buoyancy, h = x / sqrt(1 + (x / layer)^2), x = z - depth: a layer between water of one density "
    "above and of another below. Drag and thrust, which change by the same fraction (per mille), are left as they are. Compressibility of the vehicle is the "
    "same with the other sign.",
    symbols={
        "B": "buoyancy, upwards in the north-east-down frame; N",
        "z": "the vehicle's depth, down; m",
        "depth": "depth at which the change is zero; m",
        "layer": "height above and below it within which most of the change is; m",
        "g": "gravity; m/s2",
        "V": "volume of the vehicle; m3",
    },
    parameters=(
        Parameter("gradient", "kg/m4", -20.0, 20.0, 0.0, 1.0, "some kg/m3 over some metres (chosen); a halocline: 30 over two"),
        Parameter("depth", "m", -10.0, 6000.0, 0.0, 1.0, "where the change is zero: a vehicle is trimmed where it works (chosen)", role="datum"),
        Parameter("layer", "m", 0.2, 1000.0, 3.0, 3.0, "a halocline: two metres; a thermocline: some tens", role="extent"),
    ),
    signature="a vertical force that grows with depth, at every heading and speed",
    confused_with=("buoyancy_error", "current_shear", "tether_tension"),
    separates="a slow dive up and down at two headings",
    literature=("Fofonoff and Millard 1983: density of sea water by salinity, temperature and pressure", "Gill 1982: stratification"),
    needs=("z",),
)
ROWS = ("slope", "depth", "steep", "bx", "by", "bz")


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """Buoyancy per metre, N/m, and where it acts."""
    b = lanes.centre_of_buoyancy
    slope = p["gradient"] * lanes.vehicle.water.gravity * lanes.vehicle.body.volume
    return {"slope": slope, "depth": p["depth"], "steep": 1.0 / p["layer"], "bx": b[:, 0], "by": b[:, 1], "bz": b[:, 2]}


def wrench(
    slope: Number, depth: Number, steep: Number, bx: Number, by: Number, bz: Number, z: Number, r31: Number, r32: Number, r33: Number
) -> tuple[Number, ...]:
    """Additional buoyancy in the body frame, and its moment."""
    below = z - depth
    up = -slope * below / sqrt(1.0 + steep * steep * below * below)
    fx, fy, fz = up * r31, up * r32, up * r33
    return fx, fy, fz, by * fz - bz * fy, bz * fx - bx * fz, bx * fy - by * fx
