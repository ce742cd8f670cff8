"""The navigation filter on a motion that is known: a vehicle that swims in a circle while its instruments have noise and biases."""

from __future__ import annotations

import numpy as np

from rovval.core.data import Array
from rovval.core.frames import rotation_from_euler
from rovval.fly.loop.navigation import Navigation
from rovval.fly.loop.sensors import Instruments
from rovval.fly.mission import Sensors

G, DT, LANES, SPEED, TURN = 9.81, 0.1, 16, 0.3, 0.2  # TURN, rad/s: half a minute a circle


def errors(sensors: Sensors, samples: int) -> Array:
    """Of the velocities that the filter says (samples, LANES, 3), m/s."""
    nu, eta = np.tile([SPEED, 0.0, 0.0, 0.0, 0.0, TURN], (LANES, 1)), np.zeros((LANES, 6))
    instruments, found = Instruments(sensors, LANES, G, DT, np.random.SeedSequence(3)), []
    navigation = Navigation(sensors, nu, eta, G, DT)
    before = np.einsum("bij,bj->bi", rotation_from_euler(eta[:, 3:]), nu[:, :3])
    for k in range(samples):
        psi = TURN * k * DT
        eta = np.tile([SPEED / TURN * np.sin(psi), SPEED / TURN * (1 - np.cos(psi)), 0.0, 0.0, 0.0, psi], (LANES, 1))
        found.append(navigation.update(instruments.measure(nu, eta, before, None)).nu[:, :3] - nu[:, :3])
        before = np.einsum("bij,bj->bi", rotation_from_euler(eta[:, 3:]), nu[:, :3])
    return np.array(found)


def test_what_leaks_of_gravity_turns_with_the_body():
    """Biases of accelerometer and attitude are fixed to the body: taken as fixed to the world, they were learned anew in every circle, and the velocity was
    off for many seconds on end (a correlation of 0.6 over a second)."""
    sensors = Sensors()
    late = errors(sensors, 1800)[600:, :, :2]
    assert np.sqrt((late**2).mean()) < sensors.velocity.noise
    later = (late[:-10] * late[10:]).mean() / (late**2).mean()
    assert abs(later) < 0.25, "errors a second apart have little to do with each other"


def test_without_noise_and_bias_the_filter_says_what_is():
    silent = {name: {"noise": 0.0, "bias": 0.0} for name in ("gyro", "accelerometer", "attitude", "depth", "velocity", "position")}
    assert np.abs(errors(Sensors.model_validate(silent), 300)[100:]).max() < 0.01 * SPEED
