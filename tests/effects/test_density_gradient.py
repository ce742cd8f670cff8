"""Water that gets denser with depth, through a layer."""

from __future__ import annotations

import numpy as np
import pytest

from rovval.effects.library import density_gradient


def lift(z: float, layer: float) -> float:
    """Additional buoyancy (N) of a level vehicle at depth ``z``, of 100 N/m in the middle of a layer at 20 m."""
    level = {"r31": 0.0, "r32": 0.0, "r33": 1.0}
    return -float(density_gradient.wrench(100.0, 20.0, 1.0 / layer, 0.0, 0.0, 0.0, z, **level)[2])


def test_buoyancy_grows_in_proportion_within_the_layer_and_no_further_beyond_it():
    assert lift(20.0, 3.0) == 0.0
    assert lift(20.3, 3.0) == pytest.approx(30.0, rel=0.01) and lift(19.7, 3.0) == pytest.approx(-30.0, rel=0.01)
    assert lift(200.0, 3.0) == pytest.approx(300.0, rel=0.01) and lift(-160.0, 3.0) == pytest.approx(-300.0, rel=0.01)


def test_a_layer_as_high_as_the_sea_is_a_constant_gradient():
    z = np.linspace(0.0, 40.0, 9)
    np.testing.assert_allclose([lift(float(one), 1000.0) for one in z], 100.0 * (z - 20.0), rtol=1e-3)
