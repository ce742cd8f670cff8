"""The hydrodynamic model of a robot's link that the thesis takes from its literature (freefloating_gazebo, thesis reference 17)."""

from __future__ import annotations

from rovval.plant.platforms import Platform
from rovval.vehicle.model import Vehicle

NOTHING = (0.0,) * 6


def vehicle(nominal: Vehicle) -> Vehicle:
    """Without added mass and linear drag: M_a and G_a "is considered as zero", and damping is quadratic (thesis 2.1 to 2.3)."""
    return nominal.model_copy(update={"body": nominal.body.model_copy(update={"added_mass": NOTHING, "linear_drag": NOTHING})})


PLATFORM = Platform(
    title="equations 2.1 to 2.3 of the thesis's literature review, freefloating_gazebo",
    equations="M_RB nu_dot + C_RB(nu) nu + D_q |nu_r| nu_r + g(eta) = tau; classical Runge-Kutta steps of 0.1 s or less",
    source="thesis 2.3.1 (equations 2.1 to 2.3), after Kermorgant 2014, A dynamic simulator for underwater vehicle-manipulators",
    leaves_out=(
        "added mass and its Coriolis terms (M_a = 0, G_a = 0)",
        "linear drag: with it the thesis's Merlin loses 5 to 30 % of its damping at 0.3 to 2 m/s, and nothing stops its last slow drift",
        "thruster dynamics: the speed is the command",
    ),
    assumed=("thrust per speed is that of the vehicle's file: the source has thrust limits and no law of its own",),
    vehicle=vehicle,
)
