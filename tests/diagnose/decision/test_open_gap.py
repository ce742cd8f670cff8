"""What no model explains says how likely something else is: its size, what it is measured against, and the odds that follow."""

from __future__ import annotations

from math import exp

import numpy as np
import pytest
from diagnose_case import diagnosed, foreign, merlin, posed
from scipy.integrate import quad

from rovval.diagnose import Diagnosis, diagnose
from rovval.diagnose.criteria import OPEN_GAP_RIGHT
from rovval.diagnose.decision.open_gap import evidence_of_something_else, left_open, open_gap
from rovval.diagnose.inference.hypothesis_fit import fit_hypothesis
from rovval.diagnose.inference.map_fit import healthy_fit


@pytest.fixture(scope="session")
def bumped(tmp_path_factory: pytest.TempPathFactory) -> Diagnosis:
    """A healthy vehicle that is bumped now and then, by the independent plant: forces that go with nothing that is logged."""
    planted = (("collision_bumps", "", 1.0),)
    return diagnose([foreign(tmp_path_factory.mktemp("bumps"), planted, seed=3, slop=0.03, mission="yoyo")], merlin())


def test_its_odds_are_those_of_two_densities():
    """The ratio of densities, averaged over sizes where the equations are right, is one: so it can mislead a healthy vehicle only so often."""
    average, _ = quad(lambda q: exp(0.5 * evidence_of_something_else(q) - q / OPEN_GAP_RIGHT) / OPEN_GAP_RIGHT, 0.0, np.inf)
    assert average == pytest.approx(1.0, abs=1e-6)


def test_it_grows_with_size_beyond_what_healthy_logs_show():
    sizes = [evidence_of_something_else(q) for q in (0.0, OPEN_GAP_RIGHT, 0.3, 0.6, 3.0)]
    assert sizes[0] < sizes[1] < 0.0 < sizes[2] < sizes[3] < sizes[4]


def test_a_log_of_the_equations_themselves_leaves_none_open():
    problem, _ = posed()
    assert open_gap(problem, [healthy_fit(problem)]) < OPEN_GAP_RIGHT
    belief = diagnosed().probabilities
    assert belief is not None and belief.healthy > 0.9


def test_the_best_of_the_models_counts():
    problem, _ = posed(("buoyancy_error:force=60",))
    healthy = healthy_fit(problem)
    other, _ = posed()
    assert open_gap(problem, [healthy]) > open_gap(other, [healthy_fit(other)])
    assert open_gap(problem, [healthy, healthy]) == open_gap(problem, [healthy])


@pytest.mark.slow
def test_bumps_that_no_model_has_are_no_healthy_vehicle(bumped: Diagnosis):
    """The probabilities say what the verdict says."""
    assert bumped.verdict == "unknown" and not bumped.causes
    assert bumped.probabilities is not None and bumped.probabilities.something_else + bumped.probabilities.not_found > 0.8
    assert bumped.left is not None and bumped.left.accounted is not None and bumped.left.accounted < 0.5


def test_causes_leave_little_open_and_half_of_them_more():
    """Two effects are planted: with both, what is left is no more than noise and tolerances make; with the smaller of them it is."""
    problem, library = posed(("buoyancy_error:force=150", "quadratic_drag[surge]:scale=1.0"))
    buoyancy, drag = (next(h for h in library if h.name == name).slots for name in ("buoyancy_error", "quadratic_drag[surge]"))
    both, one = (fit_hypothesis(problem, problem.origin, slots) for slots in ((*buoyancy, *drag), drag))
    assert left_open(problem, both) < 0.5 < 1.0 < left_open(problem, one)
