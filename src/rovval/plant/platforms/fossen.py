"""The thesis's own equations, as its Simulink model has them."""

from __future__ import annotations

from rovval.plant.platforms import Platform
from rovval.vehicle.model import Vehicle


def vehicle(nominal: Vehicle) -> Vehicle:
    """The vehicle as its file has it."""
    return nominal


PLATFORM = Platform(
    title="equation 3.10 of the thesis, its Simulink model",
    equations="(M_RB + M_A) nu_dot + C_RB(nu) nu + C_A(nu_r) nu_r + (D_l + D_q |nu_r|) nu_r + g(eta) = tau; tau = sum of k n |n| along each thruster, "
    "or of rho D^4 n |n| theta K_T(J_a); added mass in the mass matrix, classical Runge-Kutta steps of 0.1 s or less",
    source="thesis 3.2 (equations 3.10 to 3.15); Fossen 2021, 3.50, 3.57, 6.4 and 8.4 for the terms that the thesis only names",
    leaves_out=(
        "whatever the library of effects adds (`rovval list effect`): thruster dynamics, inflow, tether, current, waves, walls and seabed",
        "the sea surface: the vehicle is always wholly under water",
    ),
    vehicle=vehicle,
)
