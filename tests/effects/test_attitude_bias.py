"""A sensor that sits askew turns with the vehicle: its bias is a tilt of its axes, whatever the attitude."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from rovval.core.frames import attitude_difference
from rovval.effects.library import attitude_bias
from rovval.effects.log import Log

TILT = {"phi": np.array([0.05]), "theta": np.array([-0.03])}


def logged(*euler: float) -> np.ndarray:
    """Euler angles (3,) that the sensor logs of a vehicle with these."""
    eta = np.array([[[1.0, 2.0, 3.0, *euler]]])
    return np.asarray(attitude_bias.observe(Log(np.zeros_like(eta), eta, 0.1, np.zeros((1, 6)), eta[:, 0]), TILT).eta[0, 0, 3:])


def test_near_level_it_adds_to_roll_and_pitch():
    assert logged(0.0, 0.0, 1.2) == pytest.approx([0.05, -0.03, 1.2], abs=0.002)


@pytest.mark.parametrize("euler", [(0.0, 0.0, 0.0), (2.9, 0.4, -1.0), (0.3, 1.45, 2.0), (pi, -1.2, 0.5)])
def test_at_any_attitude_it_is_the_same_tilt_of_the_sensor_in_the_vehicle(euler: tuple[float, float, float]):
    assert attitude_difference(logged(*euler), np.array(euler)) == pytest.approx([0.05, -0.03, 0.0], abs=1e-9)


def test_upside_down_what_rolls_it_turns_the_other_way_in_pitch():
    """As the vehicle rolls over, the pitch that it logs changes sign."""
    level, over = logged(0.0, 0.0, 0.0), logged(pi, 0.0, 0.0)
    assert over[1] == pytest.approx(-level[1], abs=1e-3)
