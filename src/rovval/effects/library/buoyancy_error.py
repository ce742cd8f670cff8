"""Net buoyancy differs from the vehicle file's: ballast, foam, water, trim."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

EFFECT = Effect(
    name="buoyancy_error",
    title="Net buoyancy differs",
    place="vehicle",
    equation="B <- B + force at the centre of buoyancy (thesis 3.14; diagnosis.md B1). Positive: lighter than the file says.",
    parameters=(
        Parameter("force", "N", -60.0, 60.0, 0.0, 3.0, "+-3 to 20 N; labelled BlueROV2 runs: -4.8 to -5.6 N without ballast", "weight"),
    ),
    signature="a constant vertical force, also with thrusters off",
    confused_with=("density_gradient", "tether_tension", "payload_change", "reverse_asymmetry", "current_constant"),
    separates="coast in heave with thrusters off, both ways",
)


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """Add to the buoyancy."""
    return replace(lanes, buoyancy=lanes.buoyancy + p["force"])
