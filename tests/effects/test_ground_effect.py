"""Ground effect by a measured altitude, or over a flat seabed of some depth."""

from __future__ import annotations

import numpy as np
import plant_cases as cases
import pytest

from rovval.core.data import Array
from rovval.core.errors import UsageProblem
from rovval.plant import Inputs, Motion, Plant, parse_settings

STEPS = 40


def sunk(setting: str, altitude: Array | None) -> Motion:
    """A Merlin that sinks from 20 m at 0.3 m/s with its thrusters off."""
    plant, nu, eta = Plant(cases.merlin()), np.zeros((1, 6)), np.zeros((1, 6))
    nu[0, 2], eta[0, 2] = 0.3, 20.0
    inputs = Inputs(0.1, np.zeros((STEPS + 1, 7)), False, altitude=altitude)
    return plant.simulate(inputs, np.array([0]), STEPS, nu, eta, parse_settings(plant, [setting])[None])


def test_a_seabed_is_as_good_as_the_altitude_above_it():
    """What is measured and what follows from the depth differ by how linear the depth is between samples."""
    free = sunk("ground_effect:gain=400,height=0.7,drag=3,seabed=21.5", None)
    measured = sunk("ground_effect:gain=400,height=0.7,drag=3", 21.5 - free.eta[0, :, 2])
    assert np.abs(measured.nu - free.nu).max() < 1e-5 < np.abs(free.nu - sunk("ground_effect:gain=1e-9,seabed=21.5", None).nu).max()


def test_the_nearer_of_the_two_counts():
    altitude = np.full(STEPS + 1, 1.0)
    alone = sunk("ground_effect:gain=400", altitude)
    assert np.array_equal(sunk("ground_effect:gain=400,seabed=40", altitude).nu, alone.nu)
    assert np.array_equal(sunk("ground_effect:gain=400,seabed=40", np.full(STEPS + 1, 30.0)).nu, sunk("ground_effect:gain=400,seabed=40", None).nu)


def test_near_the_bottom_drag_in_heave_brakes_and_a_gain_lifts():
    w = {setting: sunk(f"ground_effect:{setting},seabed=20.8", None).nu[0, 5, 2] for setting in ("gain=1e-9", "gain=300", "drag=5", "gain=-300")}
    assert w["gain=300"] < w["gain=1e-9"] < w["gain=-300"] and 0.0 < w["drag=5"] < w["gain=1e-9"]


def test_a_vehicle_that_passes_over_the_bottom_is_drawn_to_it_by_the_square_of_its_speed():
    """Z = suction exp(-h / height) (u^2 + v^2): the first tenth of a second, alike ahead and sideways, and nothing at rest."""
    plant, at = Plant(cases.merlin()), np.zeros((4, 6))
    nu = np.array([[0.0] * 6, [0.4, *[0.0] * 5], [0.8, *[0.0] * 5], [0.0, 0.4, *[0.0] * 4]])
    at[:, 2] = 20.0

    def fallen(setting: str) -> Array:
        beta = np.tile(parse_settings(plant, [f"ground_effect:{setting},height=0.5,seabed=20.5"]), (4, 1))
        return np.asarray(plant.simulate(Inputs(0.1, np.zeros((2, 7)), False), np.zeros(4, dtype=int), 1, nu, at, beta).nu[:, 1, 2])

    drawn = fallen("suction=300") - fallen("gain=1e-9")
    assert abs(drawn[0]) < 1e-6 and drawn[1] > 1e-4
    assert drawn[2] == pytest.approx(4.0 * drawn[1], rel=0.05) and drawn[3] == pytest.approx(drawn[1], rel=0.1)


def test_a_bottom_never_takes_drag_away():
    """A negative share would be a slip of the hull along the vertical, and imitates a trim that is off."""
    with pytest.raises(UsageProblem, match=r"ground_effect\.drag = -0\.5, allowed 0 to 30"):
        sunk("ground_effect:drag=-0.5,seabed=21.5", None)


def test_without_altitude_and_seabed_it_is_refused():
    with pytest.raises(UsageProblem, match=r"ground_effect needs altitude, or ground_effect\.seabed"):
        sunk("ground_effect:gain=100", None)
