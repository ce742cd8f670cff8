"""Buoyancy that drifts."""

from __future__ import annotations

import numpy as np
import plant_cases as cases
import pytest

from rovval.plant import Inputs, Plant, parse_settings


def test_it_is_by_now_what_came_on_since_the_run_began():
    """Over a tenth of a second, half a minute in, a drift is a buoyancy error of its size then."""
    plant, zero = Plant(cases.merlin()), np.zeros((3, 6))
    asked: tuple[list[str], ...] = ["buoyancy_drift:rate=0.5"], ["buoyancy_error:force=15.025"], []
    beta = np.array([parse_settings(plant, settings) for settings in asked])
    out = plant.simulate(Inputs(0.1, np.zeros((302, 7)), False), np.full(3, 300), 1, zero, zero, beta)
    drift, error = (out.nu[i, 1] - out.nu[2, 1] for i in (0, 1))
    assert drift[2] == pytest.approx(error[2], rel=1e-3) and drift[2] < 0.0
    np.testing.assert_allclose(drift, error, atol=1e-3 * abs(error[2]))


def test_what_fills_settles_from_its_onset_on():
    """Nothing before the onset; half of all that will come in after one over `settling`."""
    plant, zero = Plant(cases.merlin()), np.zeros((3, 6))
    asked: tuple[list[str], ...] = ["buoyancy_drift:rate=2.0,onset=10.0,settling=0.05"], ["buoyancy_error:force=20.0"], []
    beta = np.array([parse_settings(plant, settings) for settings in asked])
    for start, expected in ((50, 0.0), (300, 1.0)):  # samples of 0.1 s: at 5 s, and at 30 s, which is one over `settling` after the onset
        out = plant.simulate(Inputs(0.1, np.zeros((302, 7)), False), np.full(3, start), 1, zero, zero, beta)
        drift, error = (out.nu[i, 1] - out.nu[2, 1] for i in (0, 1))
        np.testing.assert_allclose(drift, expected * error, atol=5e-3 * np.abs(error).max())


def test_what_fills_at_the_stern_raises_the_bow():
    plant, zero = Plant(cases.merlin()), np.zeros((2, 6))
    asked: tuple[list[str], ...] = ["buoyancy_drift:rate=-2.0,x=-0.5"], ["buoyancy_drift:rate=-2.0"]
    beta = np.array([parse_settings(plant, settings) for settings in asked])
    out = plant.simulate(Inputs(0.1, np.zeros((302, 7)), False), np.full(2, 300), 1, zero, zero, beta)
    assert out.nu[0, 1, 4] > 10.0 * abs(out.nu[1, 1, 4])
