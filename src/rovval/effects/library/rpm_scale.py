"""The logged speed is a constant factor off the real one, for every thruster."""

from __future__ import annotations

from collections.abc import Mapping

from rovval.effects.arithmetic import Number
from rovval.effects.effect import Effect, Parameter, Tolerance
from rovval.effects.lanes import Array, Lanes

EFFECT = Effect(
    name="rpm_scale",
    title="Scale of the thruster speeds",
    place="input",
    equation="n <- (1 + scale) n for every thruster, so thrust by its square.",
    symbols={"n": "shaft speed; rev/s"},
    parameters=(
        Parameter(
            "scale", "1", -0.5, 1.0, 0.0, 0.05, "+-5 %; thrust of all thrusters +-30 % and more (chosen)",
            tolerance=Tolerance(0.5, "half of the calibration tolerance: thrust goes by its square"),
        ),
    ),
    signature="everything that thrust does is too strong or too weak by one factor",
    confused_with=("quadratic_drag", "linear_drag", "voltage_sag", "dvl_scale"),
    separates="coast-down with thrust off: drag is left alone",
    literature=("Fossen 2021, section 9.4: thrust by the square of the shaft speed", "Carlton 2018, chapter 6: propeller characteristics"),
    in_file=True,
)
ROWS = ("factor",)
SHARED = True


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """The factor."""
    return {"factor": 1.0 + p["scale"]}


def speed(factor: Number, n: Number) -> Number:
    """Real speed."""
    return factor * n
