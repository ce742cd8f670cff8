"""Change points: a step of the level is found, and none invented."""

from __future__ import annotations

import numpy as np
import pytest
from diagnose_case import merlin, own

from rovval.diagnose.criteria import LEAST_WINDOWS
from rovval.diagnose.hypotheses.change_points import change_points, largest_changes
from rovval.diagnose.windows.multiple_shooting import cut_run
from rovval.diagnose.windows.windows import Windows

RNG = np.random.default_rng


@pytest.fixture(scope="module")
def part() -> Windows:
    return cut_run(own((), 4, 240.0), merlin(), "fossen", 10.0)


@pytest.mark.parametrize("at", [3, 10, 17])
def test_a_break_is_where_the_level_steps(at):
    noise = np.random.default_rng(at).normal(0.0, 0.2, 20)
    found = largest_changes(noise + np.where(np.arange(20) < at, 0.0, 2.0), 2, 5)
    assert max(found)[1] == 5 + at
    assert all(5 + LEAST_WINDOWS <= i <= 25 - LEAST_WINDOWS for _, i in found)
    assert largest_changes(noise[: 2 * LEAST_WINDOWS - 1], 2) == []


def test_a_change_point_is_found_and_none_invented(part):
    rng, m = RNG(14), part.count
    signal = rng.normal(size=(m, 3))
    assert change_points(part, signal, 0) == []
    signal[3 * m // 4 :, 1] += 8.0
    [at] = change_points(part, signal, 0)
    assert at == pytest.approx(part.start[3 * m // 4] * 0.1, abs=10.5)
