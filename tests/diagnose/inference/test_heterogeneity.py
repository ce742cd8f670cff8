"""What each of several runs says of a number that all share: the test of homogeneity, and runs that agree and that do not."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from diagnose_case import merlin, own
from scipy import stats

from rovval.diagnose.hypotheses.hypothesis import columns_of
from rovval.diagnose.hypotheses.library import hypotheses
from rovval.diagnose.inference.heterogeneity import ByRun, by_run, homogeneity
from rovval.diagnose.inference.hypothesis_fit import fit_hypothesis
from rovval.diagnose.problem.problem import pose
from rovval.diagnose.windows.multiple_shooting import cut


def test_two_estimates_are_compared_as_a_test_of_their_difference_compares_them():
    values, errors = np.array([0.30, 0.42]), np.array([0.03, 0.04])
    assert homogeneity(values, errors) == pytest.approx(2.0 * stats.norm.sf(0.12 / 0.05))


def test_estimates_of_one_value_are_called_different_as_often_as_the_probability_says():
    rng = np.random.default_rng(4)
    errors = np.array([0.5, 1.0, 2.0, 1.5])
    found = np.array([homogeneity(3.0 + errors * rng.standard_normal(4), errors) for _ in range(4000)])
    for level in (0.01, 0.1, 0.5):
        assert (found < level).mean() == pytest.approx(level, abs=4.0 * np.sqrt(level * (1.0 - level) / 4000))


@cache
def losses(*planted: float) -> ByRun:
    """By-run values of a loss of thrust, which runs of one vehicle have as ``planted``."""
    runs = [own((f"thruster_degraded[HFP]:loss={loss}",), 5 + i, 100.0) for i, loss in enumerate(planted)]
    parts, _ = cut(runs, merlin(), "fossen", 10.0)
    library = [h for h in hypotheses(parts)[0] if h.name == "thruster_degraded[HFP]"]
    problem = pose(parts, columns_of(library), 0.05)
    [slot] = library[0].slots
    return by_run(problem, fit_hypothesis(problem, problem.origin, (slot,)))[slot]


@pytest.mark.slow
def test_runs_of_one_vehicle_agree():
    found = losses(0.5, 0.5)
    assert np.all(np.abs(found.values - 0.5) < 3.0 * found.errors)
    assert found.homogeneity is not None and found.homogeneity > 0.01


@pytest.mark.slow
def test_runs_between_which_the_vehicle_changed_are_told_apart():
    found = losses(0.2, 0.8)
    assert found.homogeneity is not None and found.homogeneity < 0.01
    assert found.values == pytest.approx([0.2, 0.8], abs=0.15)


@pytest.mark.slow
def test_a_single_run_has_none():
    with pytest.raises(KeyError):
        losses(0.5)
