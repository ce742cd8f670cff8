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
    equation="n <- sgn(n) min(sqrt(max(|n| - width, 0) (|n| - width + 2 catch width)), |n|) on the acting speed of every thruster: the speed beyond the band "
    "at catch 0, the thrust beyond the band's at 1 (n^2 - width^2, Bessa 2006), and all of the speed again from some on at more.",
    symbols={"n": "shaft speed; rev/s", "width": "half width of the band; rev/s", "catch": "how soon the speed is caught up with; 1"},
    parameters=(
        Parameter(
            "width", "rev/s", 0.0, 60.0, 0.0, 2.5, "0 to 12 % of full command (chosen); T200: 300 rpm (Blue Robotics T200); searched to full speed", "speed",
            starts=(1.0, 4.0), tolerance=CURVED,
        ),
        Parameter(
            "catch", "1", 0.0, 30.0, 0.0, 1.0, "0: a dead band of the drive, all along; 1: of thrust; more: of low flow, caught up with at some widths",
            tolerance=CURVED,
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
    """The width, and how soon it is made up for."""
    return {"width": p["width"], "catch": p["catch"]}


def acting(width: Number, catch: Number, n: Number) -> Number:
    """Speed that acts: what is beyond the band, and no more than there is."""
    more = (2.0 * catch - 1.0) * width
    ahead, astern = sqrt(positive(n - width) * positive(n + more)), sqrt(positive(-n - width) * positive(more - n))
    return ahead - positive(ahead - positive(n)) - astern + positive(astern - positive(-n))
