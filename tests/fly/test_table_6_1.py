"""Table 6.1 of the thesis: thrust of each thruster at 70 rpm, as printed for its Simulink model and for Gazebo."""

from __future__ import annotations

import pytest

from rovval.fly.scenarios import table_6_1
from rovval.vehicle import load

SIMULINK = (82.7, 31.3, 83.8, 87.0, 35.2, 86.7, 31.4)
GAZEBO = (80.5, 30.4, 78.7, 82.1, 31.7, 80.3, 29.5)


def test_both_platforms_give_the_printed_thrusts():
    """Thrust is read off the motion, so that masses, allocation and conversion of both count; Gazebo's is printed up to 11 % lower."""
    rows = table_6_1.rows(load("merlin"))
    assert [row.fossen for row in rows] == pytest.approx(SIMULINK, rel=1e-6)
    assert [row.freefloating for row in rows] == pytest.approx(SIMULINK, rel=1e-6)
    assert [row.matlab for row in rows] == list(SIMULINK) and [row.ros for row in rows] == list(GAZEBO)
    assert all(0.0 < row.freefloating / printed - 1 < 0.12 for row, printed in zip(rows, GAZEBO, strict=True))


def test_another_vehicle_has_thrusts_and_nothing_printed():
    rows = table_6_1.rows(load("bluerov2_heavy"))
    assert len(rows) == 8 and all(row.fossen > 0 and row.matlab is None and row.ros is None for row in rows)
