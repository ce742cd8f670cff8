"""Thrust that is lost at high shaft speed."""

from __future__ import annotations

import numpy as np
import pytest

from rovval.effects.library.ventilation import static


def test_little_is_lost_well_below_the_speed_and_the_share_well_above_it():
    n = np.array([-60.0, -20.0, -8.0, 0.0, 8.0, 20.0, 60.0])
    thrust = 0.01 * n * abs(n)
    left = static(0.6, 1.0 / 20.0, thrust, n)
    assert left[4] == pytest.approx(thrust[4], rel=0.01) and left[5] == pytest.approx(0.7 * thrust[5]) and left[6] == pytest.approx(0.4 * thrust[6], rel=0.01)
    np.testing.assert_allclose(left, -left[::-1], atol=1e-12)
    assert np.array_equal(static(0.0, 1.0 / 20.0, thrust, n), thrust)
