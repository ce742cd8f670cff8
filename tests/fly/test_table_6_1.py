"""Table 6.1 of the thesis: thrust of each thruster at 70 rpm, as printed for its Simulink model and for Gazebo."""

from __future__ import annotations

import pytest

from rovval.fly.scenarios import table_6_1
from rovval.vehicle import load

SIMULINK = (82.7, 31.3, 83.8, 87.0, 35.2, 86.7, 31.4)
GAZEBO = (80.5, 30.4, 78.7, 82.1, 31.7, 80.3, 29.5)


def test_each_platform_gives_the_printed_thrusts_that_its_gains_are_taken_from():
    """Thrust is read off the motion, so that masses, allocation and conversion of each count; Gazebo's is printed 3 to 10 % lower than Simulink's."""
    rows = table_6_1.rows(load("merlin"))
    assert [row.ours["fossen"] for row in rows] == pytest.approx(SIMULINK, rel=1e-6)
    assert [row.ours["freefloating"] for row in rows] == pytest.approx(SIMULINK, rel=1e-6)
    assert [row.ours["uuv"] for row in rows] == pytest.approx(GAZEBO, rel=1e-6)
    assert [row.matlab for row in rows] == list(SIMULINK) and [row.ros for row in rows] == list(GAZEBO)
    assert all(-0.1 < row.ours["uuv"] / row.ours["fossen"] - 1 < -0.025 for row in rows)


def test_another_vehicle_has_thrusts_and_nothing_printed():
    rows = table_6_1.rows(load("merlin").model_copy(update={"name": "sister", "uuv": None}))
    assert all(row.ours["fossen"] == pytest.approx(row.ours["uuv"], rel=1e-6) for row in rows)
    assert all(row.ours["fossen"] > 0 and row.matlab is None and row.ros is None for row in rows)
