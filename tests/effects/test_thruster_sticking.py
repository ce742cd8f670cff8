"""A thruster that sticks at low speed."""

from __future__ import annotations

import numpy as np
import pytest

from rovval.effects.library.thruster_sticking import acting


def test_next_to_nothing_below_the_speed_of_breaking_away_and_all_of_it_well_above():
    n = np.array([-30.0, -4.0, -1.0, 0.0, 1.0, 4.0, 30.0])
    turned = acting(4.0**4, n)
    assert np.abs(turned[2:5]).max() < 0.005 and turned[5] == pytest.approx(2.0) and turned[6] == pytest.approx(30.0, rel=1e-3)
    np.testing.assert_allclose(turned, -turned[::-1], atol=1e-12)
    assert np.array_equal(acting(0.0, n), n)
