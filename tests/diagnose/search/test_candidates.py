"""Candidates: the points from which hypotheses are fitted by re-simulation."""

from __future__ import annotations

import numpy as np
import pytest
from diagnose_case import posed, slot

from rovval.diagnose.hypotheses.hypothesis import displaced
from rovval.diagnose.hypotheses.library import initialised
from rovval.diagnose.inference.map_fit import healthy_fit
from rovval.diagnose.residuals.normal_equations import NormalEquations
from rovval.diagnose.search.baseline import healthy_baseline
from rovval.diagnose.search.candidates import candidates, start_of
from rovval.diagnose.search.forward import search
from rovval.diagnose.search.screening import linearised, screened


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_fit_begins_at_the_linear_answer_within_bounds(sign: float):
    p, _ = posed(seconds=60.0)
    cosine, period = slot(p, "waves.cosine"), slot(p, "waves.period")
    h = displaced(p.plant, "waves@0", tuple(p.plant.hypotheses["waves"]), (cosine,), ((period, 8.0),), 1000)
    data, bound = NormalEquations(np.zeros((1, 1, 1)), np.zeros((1, 1)), np.zeros(1), (1000,)), p.plant.slots[cosine].parameter.high
    for step, expected in ((0.7, 0.7), (2.0 * bound, bound)):
        start = start_of(p, data, h, np.array([sign * step]), p.origin, h.slots)
        assert start[period] == 8.0 and start[cosine] == pytest.approx(sign * expected)


@pytest.mark.slow
def test_what_an_effect_includes_is_searched_for_from_its_fit():
    """A hose that pulls at the bow and is not dragged: with the one initial point at the stern, the pull alone is found from where the drag's fit has it."""
    problem, library = posed(("tether_tension:north=-145,east=105,down=-15,x=1.9,z=-0.3",), seconds=120.0)
    healthy, tether = healthy_fit(problem), [h for h in library if h.name in ("tether_drag", "tether_tension")]
    begun = [h for h in initialised(problem, tether, healthy) if h.name == "tether_drag" or h.label == "tether_tension@lever0"]
    worth = {m.names: m.log_posterior for m in search(problem, tether, begun, healthy, lambda text, share: None).models}
    assert not any(len(names) > 1 for names in worth)  # both at once would be one tether twice
    assert worth[frozenset({"tether_tension"})] > worth[frozenset({"tether_drag"})] - 5.0


def test_what_would_be_negligible_is_fitted_no_further_than_quickly():
    problem, library = posed(("inflow_loss:loss=0.3",), seconds=60.0)
    healthy, few = healthy_fit(problem), [h for h in library if h.name in ("inflow_loss", "linear_drag[surge]")]
    base = healthy_baseline(problem, healthy)
    data = linearised(problem, few, healthy)
    promised = screened(problem, data, few, ())
    quick, careful = (candidates(problem, data, few, promised, dict.fromkeys(promised, needed), base, ()) for needed in (np.inf, -np.inf))
    assert quick[0].hypothesis.name == careful[0].hypothesis.name == "inflow_loss"
    assert not any(c.fit.posterior.whitened for c in quick) and careful[0].fit.posterior.whitened
    assert careful[0].evidence == pytest.approx(quick[0].evidence, rel=0.1)
