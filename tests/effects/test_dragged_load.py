"""A load that is dragged over the bottom."""

from __future__ import annotations

import numpy as np
import plant_cases as cases
import pytest

from rovval.effects.library.dragged_load import wrench
from rovval.plant import Inputs, Plant, parse_settings

LEVEL = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0)  # north-east rows of a vehicle that heads north and is level


def test_it_is_against_the_way_and_of_one_size_whatever_the_speed():
    way = np.array([0.2, 0.5, 1.5])
    X, Y, Z, K, M, N = wrench(8.0, 0.0, 0.4, way, 0.0 * way, *LEVEL)
    np.testing.assert_allclose(X, -8.0, rtol=0.02)
    assert np.all(Y == 0.0) and np.all(Z == 0.0) and np.all(K == 0.0) and np.all(N == 0.0)
    np.testing.assert_allclose(M, 0.4 * X)  # dragged below, it pitches the bow down
    assert wrench(8.0, 0.0, 0.0, 0.0, 0.0, *LEVEL) == (0.0,) * 6


def test_it_takes_force_times_way_out_of_a_vehicle_that_coasts():
    """Energy: in a plant without drag what is lost is friction times way, but for what the smooth beginning of the law leaves."""
    vehicle = cases.merlin()
    body = vehicle.body.model_copy(update={"linear_drag": (0.0,) * 6, "quadratic_drag": (0.0,) * 6})
    plant = Plant(vehicle.model_copy(update={"body": body}))
    start = np.zeros((1, 6))
    start[0, 0] = 1.0
    beta = parse_settings(plant, ["dragged_load:force=90"])[None]
    out = plant.simulate(Inputs(0.1, np.zeros((102, 7)), False), np.zeros(1, int), 100, start, np.zeros((1, 6)), beta)
    u, way = out.nu[0, :, 0], out.eta[0, -1, 0]
    inertia = vehicle.body.mass + np.asarray(vehicle.body.added_mass, float).ravel()[0]
    assert 0.5 < u[-1] < 0.95
    assert 0.5 * inertia * (u[0] ** 2 - u[-1] ** 2) == pytest.approx(90.0 * way, rel=0.01)
