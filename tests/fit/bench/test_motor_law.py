"""The law of a thruster's motor, equation 2.4 of the thesis, found in tables of voltage and thrust."""

from __future__ import annotations

import numpy as np
import pytest
from real_data import real

from rovval.fit.bench import motor_law


def test_equation_2_4_recovers_a_motor_and_states_its_fit_error():
    thrust = np.array([-40.0, -20, -5, 3, 10, 30, 50])
    truth = motor_law.MotorLaw(0.05, 0.6, 0.0, 0.0, 0, 0.0, 0.0)
    found = motor_law.fit(truth.voltage(thrust), thrust)
    assert (found.resistive, found.back_emf) == pytest.approx((0.05, 0.6)) and found.rms < 1e-12
    assert found.thrust(found.voltage(thrust)) == pytest.approx(thrust)
    assert "rms error 0.000 V" in str(found)


def test_equation_2_4_on_the_thruster_bench():
    volts, thrust = np.loadtxt(real("thruster_bench/Steady_State_Data.csv"), delimiter=",")[:, :2].T
    found = motor_law.fit(volts, thrust)
    assert found.n == 10 and 0.3 < found.rms < 0.5 and "at its bound of 0" in str(found)
