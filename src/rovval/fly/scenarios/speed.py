"""How fast the thrusters turn in a scenario: on any vehicle as fast as 70 rpm is on the thesis's Merlin."""

from __future__ import annotations

from rovval import vehicle as vehicles
from rovval.effects.lanes import reference_speed
from rovval.vehicle.model import Vehicle

MERLIN_RPM = 70.0  # thesis 4.3, table 4.4
COUNTS = 1e-3  # m/s and rad/s: the smallest motion that counts is the noise of the thesis's own ROS simulator (6.2)


def scenario_rpm(vehicle: Vehicle, wanted: float | None = None) -> float:
    """The fastest thruster's speed, rpm: ``wanted``, or that share of the speed which holds 1 m/s ahead that 70 rpm is of Merlin's 218 rpm."""
    if wanted is not None:
        return wanted
    return MERLIN_RPM * reference_speed(vehicle) / reference_speed(vehicles.load("merlin"))
