"""Steps of one sample are the motion of the whole run, whatever effects with a memory act."""

from __future__ import annotations

import numpy as np
import plant_cases as cases
import pytest

from rovval import vehicle
from rovval.plant import Inputs, Plant, parse_settings
from rovval.plant.stepping import Stepper

LANES: tuple[list[str], ...] = (
    [],
    ["thrust_lag:tau=0.3,dead=0.2", "current_constant:north=0.4"],
    ["waves:cosine=0.5", "seabed:firmness=1,depth=11"],
    ["supply_droop:droop=0.5"],
)


@pytest.mark.parametrize("name", ["merlin", pytest.param("minerva", marks=pytest.mark.slow)])
@pytest.mark.parametrize("lanes", [(0,), (1, 0, 2, 3)])
def test_steps_are_the_motion_of_the_whole_run(name, lanes):
    plant, rng, steps = Plant(vehicle.load(name), substeps=2), np.random.default_rng(5), 60
    speed = np.stack([cases.random_inputs(rng, plant).speed[:steps] for _ in lanes])
    speed = np.concatenate([np.zeros_like(speed[:, :1]), speed], axis=1)
    nu, eta = cases.random_states(rng, len(lanes))
    beta = np.stack([parse_settings(plant, LANES[i]) for i in lanes])
    stepper = Stepper(plant, beta, nu, eta, 0.1)
    seen = []
    for k in range(steps):
        stepper.step(speed[:, k + 1])
        seen.append(np.concatenate([stepper.nu, stepper.eta], axis=1))
    for b in range(len(lanes)):
        whole = plant.simulate(Inputs(0.1, speed[b], False), np.zeros(1, int), steps, nu[b : b + 1], eta[b : b + 1], beta[b : b + 1])
        np.testing.assert_allclose(np.array(seen)[:, b, :6], whole.nu[0, 1:], atol=1e-9)
        np.testing.assert_allclose(np.exp(1j * np.array(seen)[:, b, 6:]), np.exp(1j * whole.eta[0, 1:]), atol=1e-9)


def test_a_lane_that_leaves_sane_limits_says_when_and_why():
    plant = Plant(vehicle.load("bluerov2_heavy"))
    stepper = Stepper(plant, np.tile(plant.null, (2, 1)), np.array([[14.9] + 5 * [0.0], 6 * [0.0]]), np.zeros((2, 6)), 0.1)
    for _ in range(20):
        stepper.step(np.array([[0.0, 0.0, 2000.0, 2000.0] + 4 * [0.0], 8 * [0.0]]))
    assert stepper.stopped[0] > 0 and stepper.stopped[1] == -1
    assert "m/s" in stepper.why[0] or "rad/s" in stepper.why[0]
