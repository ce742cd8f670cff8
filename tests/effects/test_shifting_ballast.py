"""Ballast that shifts to the lower side."""

from __future__ import annotations

import numpy as np
import plant_cases as cases
import pytest

from rovval.effects.library.shifting_ballast import wrench
from rovval.plant import Inputs, Plant, parse_settings

DEGREES = np.radians([-30.0, -3.0, 0.0, 3.0, 30.0])
HOLD = 10.0  # N m


def down(pitch, roll=0.0):
    """Unit vector down, body axes."""
    return -np.sin(pitch), np.sin(roll) * np.cos(pitch), np.cos(roll) * np.cos(pitch)


def test_it_turns_the_low_end_further_down_and_nothing_upright():
    moment = np.array(wrench(HOLD, 0.0, 0.01**2, *down(DEGREES))[4] + 0.0 * DEGREES)
    assert moment[2] == 0.0 and np.all(moment[3:] > 0.0)  # bow up: up further
    np.testing.assert_allclose(moment, -moment[::-1], atol=1e-12)
    assert moment[3] == pytest.approx(HOLD, rel=0.03)  # it is at the end of its way
    roll = wrench(0.0, HOLD, 0.01**2, *down(0.0, DEGREES))[3]
    assert roll[4] > 0.0 > roll[0]


def test_a_liquid_in_a_wide_tank_is_a_higher_centre_of_gravity_while_the_tilt_is_small():
    """Free surface: the righting moment falls by weight times shift over tilt, as it does where the centre of gravity is higher by that over the weight."""
    plant, states = Plant(cases.merlin()), np.zeros((3, 6))
    states[:, 4] = np.radians(4.0)
    weight, slope, moment = plant.vehicle.weight, 0.9, 300.0
    asked: tuple[list[str], ...] = [f"shifting_ballast:ahead={moment},slope={slope}"], [f"cg_offset:z={-moment / slope / weight}"], []
    beta = np.array([parse_settings(plant, settings) for settings in asked])
    out = plant.simulate(Inputs(0.1, np.zeros((12, 7)), False), np.zeros(3, int), 3, np.zeros((3, 6)), states, beta)
    liquid, higher = (out.nu[i, 1:, 4] - out.nu[2, 1:, 4] for i in (0, 1))
    assert np.all(liquid > 0.0)
    np.testing.assert_allclose(liquid, higher, rtol=0.03)
