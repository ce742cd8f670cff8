"""`maximum` where some values are none that a vehicle may have: it ends before them, with sensitivities taken on the near side."""

from __future__ import annotations

import numpy as np
import pytest

from rovval.fit.calibration.estimate import Problem, Quadratic, maximum

MEASURED, FLOOR = np.array([2.0, 1.5]), np.array([0.1])
OK = [np.ones((200, 1), dtype=bool)]
NOTHING = Quadratic(np.zeros((2, 2)), np.zeros(2))


def problem(wall: float, high: float = np.inf, besides: Quadratic = NOTHING) -> Problem:
    """Two numbers, each the mean of a hundred samples; the simulation stops where the first is above ``wall``, and its bound is ``high``."""

    def residuals(values: np.ndarray) -> list[np.ndarray]:
        error = np.repeat(values - MEASURED, 100)[:, None] + 0.1 * np.random.default_rng(0).standard_normal((200, 1))
        return [error if values[0] <= wall else np.full((200, 1), np.nan)]

    return Problem(residuals, OK, 1.0, FLOOR, np.zeros(2), np.full(2, 10.0), np.full(2, -np.inf), np.array([high, np.inf]), [besides])


def test_values_that_no_vehicle_may_have_end_the_search_before_them():
    free, walled = (maximum(problem(wall), [np.zeros(2)]) for wall in (np.inf, 1.0))
    assert free.values == pytest.approx(MEASURED, abs=0.05)
    assert 0.8 < walled.values[0] <= 1.0


def test_a_search_that_begins_at_the_wall_takes_its_sensitivities_from_the_near_side():
    walled = maximum(problem(0.0), [np.zeros(2)])
    assert walled.values[0] <= 0.0
    assert np.isfinite(walled.covariance).all()


def test_a_value_rests_on_its_bound_and_the_others_go_on():
    found = maximum(problem(np.inf, high=1.0), [np.zeros(2)])
    assert found.values[0] == 1.0
    assert found.values[1] == pytest.approx(MEASURED[1], abs=0.05)


def test_a_search_that_can_begin_nowhere_says_so():
    with pytest.raises(ValueError, match="every starting point"):
        maximum(problem(-1.0), [np.zeros(2)])


def test_what_a_run_says_besides_is_weighed_with_its_residuals():
    """A hundred samples of 0.1 each, and besides as many of another mean: the estimate is half-way, as sure as of both."""
    alone = maximum(problem(np.inf), [np.zeros(2)])
    mean, sure = alone.values[0] + alone.error[0], alone.error[0] ** -2
    both = maximum(problem(np.inf, besides=Quadratic(np.diag([sure, 0.0]), np.array([sure * mean, 0.0]))), [np.zeros(2)])
    assert both.values[0] == pytest.approx(alone.values[0] + alone.error[0] / 2, abs=alone.error[0] / 10)
    assert both.values[1] == pytest.approx(alone.values[1], abs=alone.error[1] / 10)
    assert both.error[0] == pytest.approx(alone.error[0] / np.sqrt(2.0), rel=0.05)
