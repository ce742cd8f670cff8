"""Shrinkage in all and per axis: held out, with intervals, and never flattered by the windows that it was fitted on."""

from __future__ import annotations

import functools

import numpy as np
import pytest
from diagnose_case import merlin, own

from rovval.diagnose.criteria import FORM_ALIKE, FURTHER_CAUSE
from rovval.diagnose.hypotheses.hypothesis import columns_of
from rovval.diagnose.hypotheses.library import hypotheses
from rovval.diagnose.inference.gap import squared_errors
from rovval.diagnose.inference.hypothesis_fit import (
    HypothesisFit,
    fit_hypothesis,
    held_out_linearisations,
    linearised_in_effects,
)
from rovval.diagnose.inference.shrinkage import GapReduction, form_error, shrinkage, worsened_axes
from rovval.diagnose.problem.problem import Problem, corrected_residuals, pose
from rovval.diagnose.residuals.normal_equations import normal_equations
from rovval.diagnose.residuals.nuisances import initial_state_sd
from rovval.diagnose.windows.multiple_shooting import cut_run


@functools.cache
def fitted(name: str, planted: str = "", *seeds: int) -> tuple[Problem, HypothesisFit]:
    parts = tuple(cut_run(own((planted,) if planted else (), seed, 120.0), merlin(), "fossen", 10.0) for seed in seeds)
    library = [h for h in hypotheses(parts)[0] if h.name == name]
    problem = pose(parts, columns_of(library), 0.05)
    return problem, fit_hypothesis(problem, problem.origin, library[0].slots)


@pytest.mark.parametrize("seeds", [(4,), (4, 5, 6)], ids=["fifths of one log", "one of three logs"])
def test_windows_are_scored_as_the_total_scores_them(seeds):
    problem, found = fitted("inflow_loss", "inflow_loss:loss=0.25", *seeds)
    moved = held_out_linearisations(problem, found, linearised_in_effects(problem, found))
    loss = [normal_equations(one, p.ok, problem.gap.variance, initial_state_sd(p)).c for one, p in zip(moved, problem.runs, strict=True)]
    np.testing.assert_allclose(np.concatenate(loss), found.dynamics_loss, rtol=1e-9)


def test_every_axis_has_a_share_inside_its_interval():
    problem, found = fitted("inflow_loss", "inflow_loss:loss=0.25", 4)
    shrunk = shrinkage(problem, found, corrected_residuals(problem), 0)
    assert shrunk.axes.keys() == shrunk.axes_interval.keys() == {"surge", "sway", "heave", "roll", "pitch", "yaw"}
    assert all(shrunk.axes_interval[a].low <= share <= shrunk.axes_interval[a].high for a, share in shrunk.axes.items())
    assert shrunk.axes["surge"] > 0.9 and not worsened_axes(shrunk)


def test_what_fits_only_noise_shrinks_no_axis():
    """In-sample, a fit to noise always gains; on held-out windows it does not."""
    problem, found = fitted("cg_offset", "", 7)
    before, inside = (squared_errors(problem, corrected_residuals(problem, b)) for b in (None, found.beta))
    shrunk = shrinkage(problem, found, corrected_residuals(problem), 0)
    flattered = {a: 1 - inside[a].sum() / before[a].sum() for a in before}
    assert sum(shrunk.axes.values()) < sum(flattered.values())
    assert max(shrunk.axes.values()) < 0.02
    assert shrunk.axes_interval["pitch"].low < 0


def test_nothing_fitted_shrinks_nothing_and_a_worse_axis_is_named():
    problem, _ = fitted("cg_offset", "", 7)
    assert shrinkage(problem, None, [], 0) == GapReduction(0.0, 0.0, 0.0, 0.0, {}, {}, held_out=True)
    assert worsened_axes(GapReduction(axes={"surge": 0.4, "yaw": -0.051, "roll": -0.049})) == {"yaw": 0.051}


def likely_form_error(beyond: float, healthy: float = 1e-9) -> float:
    return form_error(np.full(2, beyond), np.full(2, healthy))


def test_a_cause_that_closes_a_fifth_of_what_others_leave_may_as_well_be_their_form_error():
    likely = [likely_form_error(beyond) for beyond in (0.1, 0.5, 0.787, 0.95, 1.0, 2.0)]
    assert likely == sorted(likely) and likely[0] < 0.01 and likely[2] == pytest.approx(0.5, abs=0.01)
    assert likely[-2:] == [1.0, 1.0]
    assert form_error(np.array([0.95, 0.1]), np.full(2, 1e-9)) == pytest.approx(likely[0]), "a fault of a sensor closes what parity shows"


def test_what_a_healthy_vehicle_shows_does_not_speak_against_a_further_cause():
    """Little is left for it to close where others leave no more than tolerances make; there the priors say more."""
    likely = [likely_form_error(0.85, healthy) for healthy in (1e-9, 0.3, 1.0, 100.0)]
    assert likely == sorted(likely, reverse=True)
    assert likely[0] > 0.6 and likely[-1] == pytest.approx(FORM_ALIKE / (FORM_ALIKE + FURTHER_CAUSE), abs=0.15)
