"""Thrust that goes by another power of the speed than its square."""

from __future__ import annotations

import csv

import numpy as np
import pytest
from diagnose_case import merlin, own
from real_data import real

from rovval.diagnose import diagnose
from rovval.effects.library.thrust_curve import static


@pytest.mark.parametrize("power", [-0.3, 0.1, 0.3])
def test_it_is_another_power_about_the_speed_at_which_nothing_changes(power: float):
    n = np.array([-40.0, -20.0, -10.0, 10.0, 20.0, 40.0])
    square = 0.01 * n * abs(n)
    thrust = static(power, 20.0, square, n)
    assert thrust == pytest.approx(square * (abs(n) / 20.0) ** power, rel=0.03)
    assert thrust[4] == square[4] and (thrust == -thrust[::-1]).all()
    assert np.array_equal(static(0.0, 20.0, square, n), square)


def test_thrust_never_turns_round():
    n = np.linspace(-300.0, 300.0, 601)
    T = static(np.array([[-0.45], [0.45]]), 20.0, n * abs(n), n)
    assert (T * n >= 0.0).all() and (np.sign(T) == np.sign(n)).all()


@pytest.mark.parametrize("volts", [10, 16, 20])
def test_a_published_thruster_is_nearer_to_it_than_to_the_square(volts: int):
    """Blue Robotics' table of the T200, ahead: thrust goes by the speed to the power of 2.04 to 2.07."""
    with real(f"t200/T200_{volts}V.csv").open() as file:
        rows = [{name.strip(): float(x) for name, x in row.items() if x} for row in csv.DictReader(file)]
    n, T = np.array([(row["RPM"] / 60.0, row["Force"]) for row in rows if row["RPM"] > 600.0 and row["Force"] > 0.0]).T
    middle = float(np.exp(np.log(n).mean()))

    def misfit(power: float) -> float:
        by_square = T / static(power, middle, n * n, n)
        return float(np.log(by_square).std())

    powers = np.linspace(-0.3, 0.3, 121)
    best = float(powers[np.argmin([misfit(power) for power in powers])])
    assert 0.02 < best < 0.12 and misfit(best) < 0.7 * misfit(0.0)


@pytest.mark.slow
@pytest.mark.parametrize("power", [-0.1, 0.1])
def test_a_healthy_vehicle_has_some_of_it(power: float):
    """Twice the tolerance, as much as the table has."""
    assert not diagnose([own((f"thrust_curve:power={power}",), 3, 300.0)], merlin()).causes
