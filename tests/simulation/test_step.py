"""The integration step: a stiff vehicle is integrated stably, an ordinary one as before."""

import numpy as np
import pytest

from rovval import vehicle
from rovval.core.data import Array
from rovval.plant import Inputs, Plant
from rovval.simulation.step import steps_a_sample
from rovval.vehicle.model import Vehicle, as_matrix


def rolling(steps: int, scale: float) -> Array:
    """Roll rate (T + 1,) rad/s of a BlueROV2 whose vertical thrusters roll it at full speed, its drag ``scale`` times the file's."""
    v = vehicle.load("bluerov2_heavy")
    body = v.body.model_copy(update={"quadratic_drag": tuple(np.diag(as_matrix(v.body.quadratic_drag)) * [1.0, 1.0, 1.0, scale, 1.0, 1.0])})
    v = v.model_copy(update={"body": body})
    speed = np.zeros((41, 8))
    speed[:, 4:] = 50.0 * np.array([1.0, -1.0, 1.0, -1.0])
    plant = Plant(v, "fossen", steps)
    zero = np.zeros((1, 6))
    return np.asarray(plant.simulate(Inputs(dt=0.1, speed=speed, hold=True), np.zeros(1, dtype=np.int64), 40, zero, zero, plant.null[None]).nu[0, :, 3])


def thrust(v: Vehicle, share: float) -> Array:
    k = np.array([t.k_pos for t in v.thruster])
    return np.asarray(share * (k * 3000.0**2)[None] * np.array([0.0, 0.0, 0.0, 0.0, 1.0, -1.0, 1.0, -1.0]))


def test_a_light_vehicle_that_rolls_fast_takes_more_steps_and_one_that_does_not_takes_one():
    v = vehicle.load("bluerov2_heavy")
    assert steps_a_sample(v, thrust(v, 1.0), 0.1) > 1
    assert steps_a_sample(v, thrust(v, 0.01), 0.1) == 1
    merlin = vehicle.load("merlin")
    assert steps_a_sample(merlin, np.full((1, len(merlin.thruster)), 500.0), 0.1) == 1


def test_as_many_steps_as_asked_for_agree_with_many_where_one_does_not():
    v = vehicle.load("bluerov2_heavy")
    body = v.body.model_copy(update={"quadratic_drag": tuple(np.diag(as_matrix(v.body.quadratic_drag)) * [1.0, 1.0, 1.0, 4.0, 1.0, 1.0])})
    asked = steps_a_sample(v.model_copy(update={"body": body}), thrust(v, 1.0), 0.1)
    exact = rolling(16, 4.0)
    assert rolling(asked, 4.0)[-1] == pytest.approx(exact[-1], rel=0.02)
    assert abs(rolling(1, 4.0)[-1] - exact[-1]) > 0.1 * abs(exact[-1])
