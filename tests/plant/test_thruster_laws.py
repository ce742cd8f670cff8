"""Laws of a thruster: equation 2.4 of the thesis, lags of its speed, thrust by the advance ratio."""

from __future__ import annotations

import numpy as np
import plant_cases as cases
import pytest
from real_data import real

from rovval import vehicle
from rovval.plant import Plant, electrical
from rovval.plant import thruster_lag as lag


def test_equation_2_4_recovers_a_motor_and_states_its_fit_error():
    thrust = np.array([-40.0, -20, -5, 3, 10, 30, 50])
    truth = electrical.Electrical(0.05, 0.6, 0.0, 0.0, 0, 0.0, 0.0)
    found = electrical.fit(truth.voltage(thrust), thrust)
    assert (found.resistive, found.back_emf) == pytest.approx((0.05, 0.6)) and found.rms < 1e-12
    assert found.thrust(found.voltage(thrust)) == pytest.approx(thrust)
    assert "rms error 0.000 V" in str(found)


def test_equation_2_4_on_the_thruster_bench():
    volts, thrust = np.loadtxt(real("thruster_bench/Steady_State_Data.csv"), delimiter=",")[:, :2].T
    found = electrical.fit(volts, thrust)
    assert found.n == 10 and 0.3 < found.rms < 0.5 and "at its bound of 0" in str(found)


def test_lags_settle_and_first_order_is_exponential():
    step = np.repeat([[0.0], [1.0]], [1, 40], axis=0)
    first = lag.first_order(step, 0.05, 0.2)[:, 0]
    assert first[1:] == pytest.approx(1 - np.exp(-0.05 * np.arange(40) / 0.2))
    third = lag.third_order(step, 0.05)[:, 0]
    assert third[-1] == pytest.approx(1.0, abs=1e-6)
    held, changed = lag.saturate(np.array([[3.0, -9.0]]), 5.0)
    assert held.tolist() == [[3.0, -5.0]] and changed.tolist() == [[False, True]]


def test_minerva_thrust_is_its_cubic():
    """rho D^4 n|n| theta K_T(J_a) at J_a = 0.5 ahead: K_T = 0.5/8 - 0.66/4 - 0.25/2 + 0.24 = 0.0125."""
    v = vehicle.load("minerva")
    plant = Plant(v)
    n, d = 10.0, 0.22
    at_rest = plant.thrust(np.array([[0, 0, 0, n, n]]))[0, 3]
    assert at_rest == pytest.approx(1025 * d**4 * n**2 * 0.72 * 0.24, rel=1e-6)
    u = 0.5 * n * d / 0.985
    dt = 1e-5
    speed = np.array([0, 0, 0, n, n])
    on, off = (cases.run(plant, s, seconds=dt, dt=dt, nu=[u, 0, 0, 0, 0, 0]).nu[0, 1, 0] for s in (speed, 0 * speed))
    force = (on - off) / dt * (460 + 293)
    assert force == pytest.approx(2 * 0.985 / np.hypot(0.985, 0.174) * 1025 * d**4 * n**2 * 0.72 * 0.0125, rel=0.01)
