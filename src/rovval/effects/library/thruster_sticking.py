"""One thruster does not start until its drive has torn it loose."""

from __future__ import annotations

from collections.abc import Mapping

from rovval.effects.arithmetic import Number
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

EFFECT = Effect(
    name="thruster_sticking",
    title="Thruster sticks at low speed",
    place="input",
    equation="n_i <- n_i |n_i|^4 / (|n_i|^4 + breakaway^4) on the acting speed of thruster i: next to nothing below the speed at which it breaks away, all "
    "of it well above.",
    symbols={"n_i": "shaft speed of thruster i; rev/s", "breakaway": "speed that it has to be asked for before it turns; rev/s"},
    parameters=(
        Parameter("breakaway", "rev/s", 0.0, 60.0, 0.0, 2.5, "as the width of `thruster_deadband`", "speed", role="threshold"),
    ),
    per="thruster",
    signature="small commands to that thruster do nothing, large ones all they should",
    confused_with=("thruster_deadband", "thruster_degraded", "reverse_asymmetry"),
    separates="small steps of that thruster apart from the others, beside large ones",
    literature=("Bessa 2006: dead zone of an underwater thruster",),
)
ROWS = ("fourth",)


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """Fourth power of the speed of breaking away, rev4/s4, per thruster."""
    return {"fourth": p["breakaway"] ** 4}


def acting(fourth: Number, n: Number) -> Number:
    """Speed that acts."""
    square = n * n
    return n - n * fourth / (square * square + fourth + 1e-12)
