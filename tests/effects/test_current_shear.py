"""A current with shear: a constant one where it does not change with depth, and a straight profile, or a layer, through what it has at a depth."""

from __future__ import annotations

import numpy as np
import plant_cases as cases
import pytest

from rovval.effects.lanes import nominal
from rovval.effects.library import current_shear
from rovval.plant import Inputs, Plant, parse_settings


def profile(depths: tuple[float, ...], vd: float = 0.5, **settings: float) -> np.ndarray:
    """(depths, 9) velocity of the water, its change along a path that goes down by ``vd`` m/s, and at a fixed point."""
    p = {q.name: np.array([settings.get(q.name, q.null)]) for q in current_shear.EFFECT.parameters}
    own = current_shear.rows(nominal(cases.merlin()), p)
    return np.array([[float(np.squeeze(v)) for v in current_shear.water(**own, z=np.array([z]), vd=np.array([vd]))] for z in depths])


def test_the_profile_is_straight_and_has_its_velocity_at_the_depth_it_is_told_for():
    at = profile((-5.0, 10.0, 20.0), north=0.02, north_at_depth=0.3, down_at_depth=0.01, depth=10.0)
    assert at[:, 0] == pytest.approx([0.0, 0.3, 0.5])
    assert set(at[:, 2]) == {0.01}
    assert at[:, 3] == pytest.approx([0.01] * 3)
    assert not at[:, 6:].any(), "a steady flow does not press"


def test_through_a_layer_it_goes_over_from_one_velocity_to_another():
    layer = {"north": 0.1, "east": -0.05, "depth": 10.0, "curvature": 1.0 / 3.0**2}
    far = profile((-490.0, 510.0), **layer)
    assert far[:, 0] == pytest.approx([-0.3, 0.3], rel=1e-3)
    assert far[:, 1] == pytest.approx([0.15, -0.15], rel=1e-3)
    for z in (4.0, 9.0, 10.0, 15.0):
        below, above = profile((z + 1e-4, z - 1e-4), **layer)
        assert profile((z,), **layer)[0, 3:5] == pytest.approx(0.5 * (below - above)[:2] / 2e-4, rel=1e-6)


def test_what_it_presses_is_a_share_of_its_change_along_the_path():
    at = profile((4.0, 12.0), north=0.1, east=-0.05, depth=10.0, curvature=0.1, pressing=0.25)
    assert at[:, 6:] == pytest.approx(0.25 * at[:, 3:6])
    assert (np.abs(at[:, 6]) > 0).all()


def test_without_a_change_with_depth_it_is_a_constant_current_at_any_depth():
    plant = Plant(cases.merlin())
    same = ("current_shear:north_at_depth=0.3,east_at_depth=-0.2,down_at_depth=0.1,depth=7", "current_constant:north=0.3,east=-0.2,down=0.1")
    beta = np.stack([parse_settings(plant, [one]) for one in same])
    eta = np.tile([0.0, 0.0, 25.0, 0.1, -0.1, 0.7], (2, 1))
    out = plant.simulate(Inputs(0.1, np.full((301, 7), 5.0), True), np.zeros(2, int), 300, np.zeros((2, 6)), eta, beta)
    assert np.abs(out.nu[0, -1]).max() > 0.05
    np.testing.assert_allclose(out.nu[0], out.nu[1], atol=1e-12)
