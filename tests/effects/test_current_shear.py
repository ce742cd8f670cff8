"""A current with shear: a constant one where it does not change with depth, and a straight profile through what it has at a depth."""

from __future__ import annotations

import numpy as np
import plant_cases as cases
import pytest

from rovval.effects.lanes import nominal
from rovval.effects.library import current_shear
from rovval.plant import Inputs, Plant, parse_settings


def test_the_profile_is_straight_and_has_its_velocity_at_the_depth_it_is_told_for():
    settings = {"north": 0.02, "north_at_depth": 0.3, "down_at_depth": 0.01, "depth": 10.0}
    p = {q.name: np.array([settings.get(q.name, q.null)]) for q in current_shear.EFFECT.parameters}
    own = current_shear.rows(nominal(cases.merlin()), p)
    at = {z: [float(np.squeeze(v)) for v in current_shear.water(**own, z=np.array([z]), vd=np.array([0.5]))] for z in (-5.0, 10.0, 20.0)}
    assert [v[0] for v in at.values()] == pytest.approx([0.0, 0.3, 0.5])
    assert {v[2] for v in at.values()} == {0.01}
    assert [v[3] for v in at.values()] == pytest.approx([0.01] * 3)


def test_without_a_change_with_depth_it_is_a_constant_current_at_any_depth():
    plant = Plant(cases.merlin())
    same = ("current_shear:north_at_depth=0.3,east_at_depth=-0.2,down_at_depth=0.1,depth=7", "current_constant:north=0.3,east=-0.2,down=0.1")
    beta = np.stack([parse_settings(plant, [one]) for one in same])
    eta = np.tile([0.0, 0.0, 25.0, 0.1, -0.1, 0.7], (2, 1))
    out = plant.simulate(Inputs(0.1, np.full((301, 7), 5.0), True), np.zeros(2, int), 300, np.zeros((2, 6)), eta, beta)
    assert np.abs(out.nu[0, -1]).max() > 0.05
    np.testing.assert_allclose(out.nu[0], out.nu[1], atol=1e-12)
