"""Thrust of the vertical thrusters."""

from __future__ import annotations

import numpy as np
import pytest

from rovval import vehicle
from rovval.plant import Inputs, Plant, parse_settings


@pytest.mark.parametrize("name", ["bluerov2_heavy", "merlin"])
def test_it_is_each_vertical_thruster_by_one_factor_and_no_other(name: str):
    plant, zero = Plant(vehicle.load(name)), np.zeros((2, 6))
    upright = [t.name for t in plant.vehicle.thruster if t.vertical]
    assert 0 < len(upright) < len(plant.vehicle.thruster)
    asked: tuple[list[str], ...] = ["vertical_thrust:scale=-0.27"], [f"thruster_degraded[{t}]:loss=0.27" for t in upright]
    beta = np.array([parse_settings(plant, settings) for settings in asked])
    speeds = np.full((12, len(plant.vehicle.thruster)), 12.0)
    out = plant.simulate(Inputs(0.1, speeds, False), np.zeros(2, int), 10, zero, zero, beta)
    assert np.array_equal(out.nu[0], out.nu[1]) and np.abs(out.nu[0]).max() > 0.01
