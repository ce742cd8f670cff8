"""A current that changes in time: an ellipse, and the acceleration of the water that goes with it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from rovval.effects.library import current_varying


def flow(t: float, **given: float) -> np.ndarray:
    """(9,) velocity of the water, its change along the path, and at a fixed point."""
    own = dict.fromkeys(current_varying.ROWS, 0.0) | given
    return np.array(current_varying.water(**own, t=t))


def test_a_round_ellipse_keeps_its_speed_and_turns_once_a_period():
    omega = math.tau / 200.0
    for t in np.linspace(0.0, 200.0, 9):
        north, east = flow(t, north_cosine=0.2, east=0.2, omega=omega)[:2]
        assert math.hypot(north, east) == pytest.approx(0.2)
        assert math.remainder(math.atan2(east, north) - omega * t, math.tau) == pytest.approx(0.0, abs=1e-9)


def test_the_acceleration_of_the_water_is_the_slope_of_its_velocity():
    own = {"north": 0.1, "east": 0.2, "north_cosine": -0.15, "east_cosine": 0.05, "north_mean": 0.3, "omega": 0.04}
    for t in (0.0, 13.0, 170.0):
        slope = (flow(t + 0.01, **own)[:3] - flow(t - 0.01, **own)[:3]) / 0.02
        np.testing.assert_allclose(flow(t, **own)[3:6], slope, atol=1e-8)
        np.testing.assert_array_equal(flow(t, **own)[3:6], flow(t, **own)[6:])


def test_its_mean_is_what_it_is_over_whole_periods():
    own = {"north": 0.1, "east_cosine": 0.2, "north_mean": 0.3, "east_mean": -0.1, "omega": math.tau / 50.0}
    mean = np.mean([flow(t, **own) for t in np.arange(0.0, 100.0, 0.5)], axis=0)
    assert mean == pytest.approx([0.3, -0.1, *[0.0] * 7], abs=1e-12)
