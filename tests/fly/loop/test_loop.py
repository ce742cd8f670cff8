"""The parts of the closed loop against what the textbooks say of them."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import solve_discrete_are

from rovval import vehicle
from rovval.core.channels import AXES
from rovval.fly.loop.allocation import thrusters_of
from rovval.fly.loop.controllers import Axis, Tracking, placed
from rovval.fly.loop.navigation import Kalman
from rovval.fly.mission import Control, Limits
from rovval.vehicle.model import allocation


@pytest.mark.parametrize("axis", [Axis(4404.0, 200.0, 2000.0), Axis(32.2, 33.0, 190.0), Axis(0.6, 0.0, 1.5)])
def test_gains_put_all_three_poles_where_they_are_wanted(axis):
    gains = placed(axis, 0.5)
    poles = np.roots([axis.mass, axis.linear + gains.kd, gains.kp, gains.ki])
    np.testing.assert_allclose(poles, -0.5, atol=1e-4)


def test_an_axis_that_drag_damps_more_is_not_slowed_down():
    gains = placed(Axis(1.0, 3.0, 0.0), 0.5)
    assert gains.kd == pytest.approx(0.0) and gains.kp > 0


def test_on_its_own_model_the_loop_follows_the_step_of_three_equal_poles():
    """x = 1 - exp(-wt) (1 + wt + (wt)^2 / 2); integrated finely here, with a force that is held for each sample as the loop knows it."""
    axis, w, dt = Axis(100.0, 20.0, 0.0), 0.5, 0.1
    loop = Tracking(axis, Control(bandwidth_rad_s=w), None, np.inf, dt)
    x = v = 0.0
    for k in range(300):
        t = k * dt
        assert x == pytest.approx(1 - np.exp(-w * t) * (1 + w * t + (w * t) ** 2 / 2), abs=0.02)
        force = float(loop.force(np.ones(1), np.array([x]), np.array([v]))[0])
        loop.integrate(np.ones(1))
        for _ in range(20):
            v += dt / 20 * (force - axis.linear * v) / axis.mass
            x += dt / 20 * v


@pytest.mark.parametrize("name", vehicle.names())
def test_allocation_gives_the_wrench_that_is_asked_for(name):
    rov = vehicle.load(name)
    thrusters = thrusters_of(rov, Limits())
    wanted = np.where(thrusters.controlled, 1e-3 * rov.weight, 0.0) * np.array([1, -1, 1, 0.05, -0.05, 0.05])
    speed, given = thrusters.allocate(wanted[None])
    thrust = np.where(speed > 0, thrusters.k_pos, thrusters.k_neg) * speed * np.abs(speed)
    assert (given == 1.0).all()
    np.testing.assert_allclose((allocation(rov) @ thrust[0])[thrusters.controlled], wanted[thrusters.controlled], atol=1e-9 * rov.weight)


def test_where_thrust_is_short_depth_and_heading_come_first():
    """No thruster beyond its limit, the first axes whole, the others along their own direction."""
    rov = vehicle.load("bluerov2_heavy")
    thrusters = thrusters_of(rov, Limits())
    asked = np.array([[500.0, 100.0, 30.0, 0.0, 0.0, 3.0]])
    speed, given = thrusters.allocate(asked)
    assert (np.abs(speed[0]) <= thrusters.limit + 1e-9).all() and np.isclose(np.abs(speed[0]), thrusters.limit).any()
    thrust = np.where(speed > 0, thrusters.k_pos, thrusters.k_neg) * speed * np.abs(speed)
    got = allocation(rov) @ thrust[0]
    assert given[0, AXES.index("heave")] == given[0, AXES.index("yaw")] == 1.0
    assert 0.0 < given[0, 0] < 1.0
    np.testing.assert_allclose(got, given[0] * asked[0], atol=1e-6)


def test_the_filter_s_gain_is_that_of_the_riccati_equation():
    """Position measured at every sample, driven by an accelerometer with bias: its covariance settles at the stabilising solution."""
    dt, q, r = 0.1, np.diag([0.0, 4e-5, 1e-6]), 0.09
    f, h = np.array([[1.0, dt, -0.5 * dt**2], [0.0, 1.0, -dt], [0.0, 0.0, 1.0]]), np.array([[1.0, 0.0, 0.0]])
    filtered = Kalman(np.zeros((2, 1, 3)), np.eye(3), f, q)
    for _ in range(4000):
        filtered.correct(0, slice(0, 1), np.zeros((2, 1)), r, np.ones(2, dtype=bool))
        filtered.predict(np.zeros((2, 1, 3)))
    p = solve_discrete_are(f.T, h.T, q, np.array([[r]]))
    before = filtered.x.copy()
    filtered.correct(0, slice(0, 1), np.ones((2, 1)), r, np.array([True, False]))
    np.testing.assert_allclose((filtered.x - before)[0, 0], p[:, 0] / (p[0, 0] + r), rtol=1e-6)
    assert not (filtered.x - before)[1].any(), "what does not arrive corrects nothing"
