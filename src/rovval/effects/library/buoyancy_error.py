"""Net buoyancy differs from the vehicle file's: ballast, foam, water, trim."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from rovval.effects.effect import Effect, Parameter, Tolerance
from rovval.effects.lanes import Array, Lanes, reference_drag_force
from rovval.vehicle.model import Vehicle

TRIM = 0.02  # of the weight per unit of calibration tolerance: 5 % goes with a vehicle trimmed to a thousandth of its weight (chosen),
TRIM_FORCE = 0.075  # or of the drag at 1 m/s ahead, whichever is more: a light vehicle is trimmed to what its drives hardly notice (chosen)


def _tolerance(parameter: Parameter, vehicle: Vehicle, target: str) -> float:
    """N."""
    return max(TRIM * vehicle.weight, TRIM_FORCE * reference_drag_force(vehicle))


EFFECT = Effect(
    name="buoyancy_error",
    title="Net buoyancy differs",
    place="vehicle",
    equation="B <- B + force, at the centre of buoyancy. Positive: lighter than the file says.",
    symbols={"B": "buoyancy of the submerged vehicle, upwards in the north-east-down frame; N", "force": "what is added to it; N"},
    parameters=(
        Parameter(
            "force", "N", -60.0, 60.0, 0.0, 3.0, "+-3 to 20 N (chosen); labelled BlueROV2 runs: -4.8 to -5.6 N without ballast", "weight",
            tolerance=Tolerance(_tolerance, "how well a vehicle is trimmed: by its weight, or by what its drives hardly notice (chosen)"),
        ),
    ),
    signature="a constant vertical force, also with thrusters off",
    confused_with=("density_gradient", "tether_tension", "payload_change", "reverse_asymmetry", "current_constant"),
    separates="coast in heave with thrusters off, both ways",
    literature=("thesis, equation 3.14", "Fossen 2021, section 4.1: restoring forces of submerged vehicles"),
    family="trim",
    in_file=True,
)


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """Add to the buoyancy."""
    return replace(lanes, buoyancy=lanes.buoyancy + p["force"])
