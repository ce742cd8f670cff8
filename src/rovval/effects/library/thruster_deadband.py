"""Thrusters give nothing below some speed."""

from __future__ import annotations

from collections.abc import Mapping

from rovval.effects.arithmetic import Number, positive, sqrt
from rovval.effects.effect import Effect, Parameter, Tolerance
from rovval.effects.lanes import Array, Lanes
from rovval.vehicle.model import Vehicle

CURVE = 4.0  # of the typical dead band per unit of calibration tolerance: 5 % goes with a curve that is off by as much at small commands (chosen)


def _tolerance(parameter: Parameter, vehicle: Vehicle, target: str) -> float:
    """In the parameter's unit."""
    return CURVE * parameter.typical


CURVED = Tolerance(_tolerance, "a thrust curve that is off by a fifth of a typical dead band at small commands where the calibration tolerance is 5 % (chosen)")

EFFECT = Effect(
    name="thruster_deadband",
    title="Dead band of the thrusters",
    place="input",
    equation="n <- sgn(n) min(sqrt((1 + max(catch, 0))^2 m^2 + 2 max(-catch, 0) width m), |n|), m = max(|n| - width, 0), on the acting speed of every "
    "thruster. What is missing at the edge of the band stays missing in speed (catch 0), is made up beyond it (above), or is missing in thrust: "
    "n^2 - width^2 at catch -1.",
    symbols={
        "n": "shaft speed; rev/s",
        "width": "half width of the band; rev/s",
        "catch": "how what is missing at the edge of the band is made up: above 0 slope of the speed beyond it, less one; below 0 share of it in thrust; 1",
    },
    parameters=(
        Parameter(
            "width", "rev/s", 0.0, 60.0, 0.0, 2.5, "0 to 12 % of full command (chosen); T200: 300 rpm (Blue Robotics T200); searched to full speed", "speed",
            starts=(1.0, 4.0, 16.0), tolerance=CURVED,
        ),
        Parameter(
            "catch", "1", -4.0, 30.0, 0.0, 1.0, "0: a dead band of the drive, all along; above: of low flow, soon caught up with; -1: of thrust (Bessa 2006)",
            starts=(-1.0, 0.0),
        ),
    ),
    signature="small commands do nothing: hunting about a hover, weak answers to small steps",
    confused_with=("rpm_scale", "linear_drag", "reverse_asymmetry"),
    separates="steps of small amplitude beside large ones",
    literature=("Bessa 2006: dead zone of an underwater thruster", "Blue Robotics T200: dead band of the speed controller"),
    refines=("catch",),
)
ROWS = ("width", "catch")
SHARED = True


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """The width, and how it is made up for."""
    return {name: p[name] for name in ROWS}


def acting(width: Number, catch: Number, n: Number) -> Number:
    """Speed that acts: what is beyond the band, and no more than there is."""
    steep, more = (1.0 + positive(catch)) * (1.0 + positive(catch)), 2.0 * positive(-catch) * width
    past, back = positive(n - width), positive(-n - width)
    ahead, astern = sqrt(past * (steep * past + more)), sqrt(back * (steep * back + more))
    return ahead - positive(ahead - positive(n)) - astern + positive(astern - positive(-n))
