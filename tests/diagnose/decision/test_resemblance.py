"""Resemblance: what is left of the gap tells causes from what only looks like them, and a further cause from the form error of the others."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from diagnose_case import posed
from scipy import stats

from rovval.diagnose.criteria import (
    CAUSES_LEAVE,
    FORCE_ALIKE,
    FORCE_RIGHT,
    FORCE_SHAPE,
    FORM_ALIKE,
    FURTHER_CAUSE,
    HEALTHY_GAP,
    LEAST_EVIDENCE,
    LIBRARY_ALIKE,
    NOT_FOUND,
    PRIOR_CAUSES,
    PRIOR_SOMETHING_ELSE,
    SHOWS_BESIDE,
    VARIATIONS,
)
from rovval.diagnose.decision.resemblance import (
    Left,
    adds_to_forces,
    evidence_by_force,
    gap_left,
    looks_like_form_error,
    unlogged_about_healthy,
    unlogged_where_they_act,
    what_is_left,
)
from rovval.diagnose.hypotheses.hypothesis import Hypothesis
from rovval.diagnose.inference.gap import explainable_gap, tolerated_gap, weighted_errors
from rovval.diagnose.inference.hypothesis_fit import fit_hypothesis
from rovval.diagnose.inference.unlogged_forces import ForceLeft
from rovval.diagnose.problem.problem import corrected_residuals
from rovval.diagnose.search.model import Model


def left(healthy: float = 1e-6, **shares: float | tuple[float, float]) -> Left:
    """What sets of causes leave, of the dynamics and with parity: ``a_b=0.3`` is that of a and b together."""
    found = {frozenset(names.split("_")): np.broadcast_to(share, (2,)).astype(float) for names, share in shares.items()}
    return Left(found, {names: (float(share.min()), healthy) for names, share in found.items()})


def none_of_the_library(names: frozenset[str], known: Left | None, beside: bool = False) -> float:
    """Probability that what looks like causes is none of the library."""
    return 1.0 - what_is_left(names, known, beside).right


AB = frozenset("ab")


def test_where_nothing_is_known_priors_alone_judge():
    odds = LIBRARY_ALIKE * PRIOR_SOMETHING_ELSE / PRIOR_CAUSES
    assert none_of_the_library(AB, None) == pytest.approx(odds / (1.0 + odds))
    assert looks_like_form_error("b", AB, None) == pytest.approx(FORM_ALIKE / (FURTHER_CAUSE + FORM_ALIKE))


def test_a_force_that_shows_beside_causes_speaks_against_them_by_how_often_it_does():
    odds = SHOWS_BESIDE[1] / SHOWS_BESIDE[0] * LIBRARY_ALIKE * PRIOR_SOMETHING_ELSE / PRIOR_CAUSES
    assert none_of_the_library(AB, None, beside=True) == pytest.approx(odds / (1.0 + odds))
    shown, alone = (none_of_the_library(AB, left(a_b=0.3), beside) for beside in (True, False))
    assert shown / (1.0 - shown) == pytest.approx(SHOWS_BESIDE[1] / SHOWS_BESIDE[0] * alone / (1.0 - alone))


def test_what_adds_to_the_forces_where_it_acts_is_told_from_what_takes_them_away():
    alone = {"surge": 40.0, "sway": 10.0, "yaw": 500.0}
    assert not adds_to_forces(alone, alone) and not adds_to_forces({}, {})
    assert not adds_to_forces(alone, {"surge": 0.0, "sway": 30.0, "yaw": 510.0}), "less in all, and what hardly changes in yaw is none of theirs"
    assert adds_to_forces(alone, {"surge": 40.0, "sway": 10.0, "yaw": 600.0}) and adds_to_forces(alone, {"surge": 30.0, "sway": 30.0, "yaw": 500.0})
    assert not adds_to_forces({"surge": 0.0}, {"surge": 0.9 * LEAST_EVIDENCE}), "no strong evidence"


def test_causes_that_add_to_the_forces_where_they_act_are_rather_something_else():
    known = left(a_b=0.3)
    fewer, more = (none_of_the_library(AB, replace(known, adding=frozenset(sets))) for sets in ([], [AB]))
    assert more / (1.0 - more) == pytest.approx(SHOWS_BESIDE[1] / NOT_FOUND * fewer / (1.0 - fewer))
    assert none_of_the_library(AB, replace(known, adding=frozenset({AB})), beside=True) == more, "what adds to them shows beside them: it is counted once"
    assert none_of_the_library(AB, replace(known, adding=frozenset({frozenset("a")}))) == fewer, "of another set it says nothing"


def test_causes_that_leave_a_force_where_they_act_are_rather_something_else():
    """The odds are a ratio of two densities: over all forces that of something else, so found, integrates to one."""

    def odds(size: float, median: float = FORCE_RIGHT, wanders: bool = False) -> float:
        none = 1.0 - what_is_left(AB, replace(left(a_b=0.3), unlogged={AB: ForceLeft(size, median, FORCE_ALIKE)}), wanders=wanders).right
        return none / (1.0 - none)

    unknown = none_of_the_library(AB, left(a_b=0.3))
    at_rest = unknown / (1.0 - unknown)
    size = np.arange(0.00005, 1.0, 0.0001)
    right = stats.fisk(FORCE_SHAPE, scale=FORCE_RIGHT)  # log-logistic
    alike = np.array([odds(s) for s in size]) / at_rest * right.pdf(size)
    assert alike.sum() * 0.0001 == pytest.approx(stats.fisk(FORCE_SHAPE, scale=FORCE_ALIKE).cdf(1.0), rel=1e-3), "the rest of it is beyond the thrusters' own"
    assert odds(0.01) < at_rest < odds(0.2) < odds(0.4)
    assert odds(0.2, 3.0 * FORCE_RIGHT) < 0.5 * odds(0.2), "of what wanders more is expected"
    assert odds(0.4, wanders=True) > 10.0 * odds(0.01, wanders=True)
    assert evidence_by_force(ForceLeft(0.2, 0.07, FORCE_ALIKE)) == pytest.approx(2.0 * np.log(odds(0.2, 0.07) / at_rest))


def test_no_force_by_itself_decides():
    """Now and then right causes leave many times what is expected; and that there is none does not make any causes right."""
    known = left(a_b=0.3)
    none, most = (none_of_the_library(AB, replace(known, unlogged={AB: ForceLeft(size, FORCE_RIGHT, FORCE_ALIKE)})) for size in (0.0, 1e5))
    unknown, factor = none_of_the_library(AB, known), (FORCE_ALIKE / FORCE_RIGHT) ** FORCE_SHAPE
    for p, by in ((none, 1.0 / factor), (most, factor)):
        assert p / (1.0 - p) == pytest.approx(by * unknown / (1.0 - unknown), rel=1e-3)


def test_what_a_calibration_left_and_what_wanders_is_expected_to_leave_a_force():
    problem, _ = posed(("inflow_loss:loss=0.3",))
    nominal = dict.fromkeys(("surge", "sway", "heave", "roll", "pitch", "yaw"), 0.5)
    beside = nominal | {"surge": 0.1}
    assert unlogged_where_they_act(problem, beside, nominal, wanders=False) == pytest.approx((0.1, FORCE_RIGHT, FORCE_ALIKE))
    assert unlogged_where_they_act(problem, beside, nominal, wanders=True) == pytest.approx((0.1, FORCE_RIGHT + VARIATIONS[0] * 0.5, FORCE_ALIKE))


def test_the_force_about_a_healthy_vehicle_is_judged_where_it_is():
    """On the axes that hold it, whatever the others are spared."""
    problem, _ = posed(("inflow_loss:loss=0.3",))
    pushed = dict.fromkeys(("surge", "sway", "heave", "roll", "pitch", "yaw"), 0.0) | {"surge": 0.1}
    assert unlogged_about_healthy(problem, pushed) == pytest.approx((0.1, FORCE_RIGHT, FORCE_ALIKE))
    assert unlogged_about_healthy(problem, dict.fromkeys(pushed, 0.0)) == pytest.approx((0.0, FORCE_RIGHT, FORCE_ALIKE))


def test_both_distributions_are_distributions():
    """Odds over a grid of shares, times the density where causes are right, integrate to the prior odds: the uniform density is one."""
    share = (np.arange(2000) + 0.5) / 2000.0
    odds = LIBRARY_ALIKE * PRIOR_SOMETHING_ELSE / PRIOR_CAUSES
    p = np.array([none_of_the_library(AB, left(a=s)) for s in share])
    assert np.mean(odds * (1.0 - p) / p) == pytest.approx(1.0, abs=1e-3)
    q = np.array([looks_like_form_error("b", AB, left(a=1.0, a_b=s)) for s in share])
    assert np.mean(q / (1.0 - q)) == pytest.approx(FORM_ALIKE / FURTHER_CAUSE, abs=1e-3)


@pytest.mark.parametrize("expected", [1e-6, 0.2, 1.0, 10.0])
@pytest.mark.parametrize("share", [0.1, 0.6, 0.95])
def test_what_a_healthy_vehicle_shows_is_integrated_over(expected: float, share: float):
    """Against draws: of a gap of 1 a part is the healthy vehicle's, exponential, and of the rest causes leave a beta distributed share, others any."""
    rng = np.random.default_rng(7)
    healthy = rng.exponential(expected, 4_000_000)
    healthy = healthy[healthy < 1.0]
    causes, others = rng.beta(1.0, 1.0 / CAUSES_LEAVE - 1.0, healthy.size), rng.uniform(size=healthy.size)
    near = [np.mean(np.abs(healthy + (1.0 - healthy) * part - share) < 0.01) for part in (causes, others)]
    odds = LIBRARY_ALIKE * PRIOR_SOMETHING_ELSE / PRIOR_CAUSES * near[1] / near[0] if near[0] else np.inf
    assert none_of_the_library(AB, left(expected, a_b=share)) == pytest.approx(1.0 / (1.0 + 1.0 / odds), rel=0.05, abs=1e-3)


def test_what_is_left_is_evidence_for_causes_that_close_the_gap_and_against_those_that_do_not():
    """Over all shares that may be left it says nothing in the mean, but for what the priors say: the densities are densities."""
    share = (np.arange(2000) + 0.5) / 2000.0
    odds = np.exp([what_is_left(AB, left(a=s)).evidence for s in share])
    assert np.mean(odds) == pytest.approx(1.0 + LIBRARY_ALIKE * PRIOR_SOMETHING_ELSE / PRIOR_CAUSES, abs=1e-3)
    assert odds[0] > 5.0 > 1.0 > odds[1000] > odds[-1] == pytest.approx(LIBRARY_ALIKE * PRIOR_SOMETHING_ELSE / PRIOR_CAUSES, abs=1e-3)
    assert what_is_left(AB, left(0.5, a=0.6)).evidence > what_is_left(AB, left(a=0.6)).evidence, "what tolerances may make speaks against none"


def test_a_weak_effect_is_not_something_else_for_what_a_healthy_vehicle_shows():
    """Most of the gap is left either way; only where it is much larger than a healthy vehicle's does that say anything."""
    assert none_of_the_library(AB, left(1.0, a_b=0.8)) < 0.15 < 0.4 < none_of_the_library(AB, left(0.01, a_b=0.8))


def test_a_set_is_judged_by_its_best_part():
    """A further cause that predicts nothing does not speak against the others."""
    assert none_of_the_library(AB, left(a=0.1, a_b=0.9)) == none_of_the_library(frozenset("a"), left(a=0.1))
    assert none_of_the_library(frozenset("b"), left(a=0.1, b=0.9)) > 0.5


def test_a_sensor_is_judged_with_parity():
    """A compass that deviates moves no vehicle: the dynamics are as wrong with it as without."""
    assert none_of_the_library(frozenset("a"), left(a=(1.0, 0.1))) < 0.05
    assert looks_like_form_error("b", AB, left(a=(0.1, 0.9), a_b=(0.1, 0.2))) < 0.05


def test_a_further_cause_that_adds_to_the_gap_is_none():
    assert left(a=0.3, a_b=0.6).beyond("b", AB) == pytest.approx(2.0)
    adds, little, half = (looks_like_form_error("b", AB, left(a=0.3, a_b=share)) for share in (0.6, 0.29, 0.15))
    assert adds == 1.0 > little > half


def test_what_a_fit_leaves_is_measured_on_held_out_windows():
    """The effect that was planted leaves next to nothing; another one of the same axis, fitted as well, leaves much."""
    problem, _ = posed(("inflow_loss:loss=0.3",))
    models = []
    for name in ("inflow_loss", "added_mass[surge]"):
        slots = tuple(i for i, s in enumerate(problem.plant.slots) if s.hypothesis == name)
        fit = fit_hypothesis(problem, problem.origin, slots)
        models.append(Model((Hypothesis(name, name, slots, (), ()),), fit, fit.evidence, 0.0))
    shares = gap_left(problem, models)
    planted, other = (shares.shares[frozenset({name})] for name in ("inflow_loss", "added_mass[surge]"))
    assert planted.max() < 0.1 < 0.5 < other.min()
    assert shares.acting[frozenset({"inflow_loss"})][1] == pytest.approx(HEALTHY_GAP * tolerated_gap(problem) / explainable_gap(problem)[0], rel=0.05)
    parts = {name: replace(getattr(problem.gap, name), c=0.0 * getattr(problem.gap, name).c) for name in ("dynamics", "total")}
    still = replace(problem, gap=replace(problem.gap, **parts))
    assert gap_left(still, models).shares[frozenset({"inflow_loss"})].tolist() == [1.0, 1.0]  # no error above noise is there to be taken away


def test_causes_are_judged_where_they_act():
    """Thrust is lost, and the buoyancy is off as well: the loss leaves the gap in heave as it is, and closes that in surge."""
    problem, _ = posed(("inflow_loss:loss=0.1", "buoyancy_error:force=60"))
    slots = tuple(i for i, s in enumerate(problem.plant.slots) if s.hypothesis == "inflow_loss")
    fit = fit_hypothesis(problem, problem.origin, slots)
    names = frozenset({"inflow_loss"})
    found = gap_left(problem, [Model((Hypothesis("inflow_loss", "inflow_loss", slots, (), ()),), fit, fit.evidence, 0.0)])
    share, expected = found.where_they_act(names)
    assert share < 0.2 < 0.6 < found.shares[names].min()
    assert 0.0 < expected < 0.3
    assert found.where_they_act(frozenset({"waves"}))[0] == 1.0  # was not fitted


def test_what_causes_open_counts_against_them_as_much_however_little_there_was():
    """Of a heave that had next to no gap, as much opened as the loss of thrust closes leaves all, and far more of it at most twice that."""
    problem, _ = posed(("inflow_loss:loss=0.3",))
    index, slots = problem.plant.index, tuple(i for i, s in enumerate(problem.plant.slots) if s.hypothesis in ("inflow_loss", "buoyancy_error"))
    begin = problem.origin.copy()
    begin[index["inflow_loss.loss"]], begin[index["buoyancy_error.force"]] = 0.29, 200.0
    fit = fit_hypothesis(problem, begin, slots)
    nominal = weighted_errors(problem, corrected_residuals(problem))
    closed = sum(nominal[axis] - fit.parts[axis] for axis in ("surge", "sway", "yaw"))
    lifted, far = (replace(fit, parts={**fit.parts, "heave": nominal["heave"] + more}) for more in (closed, 1e3 * closed))
    names = frozenset({"inflow_loss", "buoyancy_error"})
    causes = tuple(Hypothesis(name, name, slots, (), ()) for name in sorted(names))
    right, opened, most = (gap_left(problem, [Model(causes, one, one.evidence, 0.0)]).acting[names][0] for one in (fit, lifted, far))
    assert right < 0.3 and opened == pytest.approx(1.0, abs=0.15) and 1.9 < most <= 2.0
