"""Prior mass of models: fixed by the number of causes, whatever the library holds."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from math import exp, factorial

import pytest

from rovval.diagnose.criteria import FURTHER_CAUSE, PRIOR_CAUSES, PRIOR_FILE, PRIOR_HEALTHY, PRIOR_SOMETHING_ELSE
from rovval.diagnose.hypotheses.hypothesis import Hypothesis
from rovval.diagnose.search.model import Model, ModelPrior, better_fits

NAMES = ("waves", "dvl_scale", "linear_drag[surge]", "linear_drag[sway]", "thruster_degraded[T1]", "thruster_degraded[T2]", "thruster_degraded[T3]")


def library(names: Sequence[str]) -> list[Hypothesis]:
    return [Hypothesis(name, f"{name}@{start}", (), (), ()) for name in names for start in range(2)]


@pytest.mark.parametrize("names", [NAMES, NAMES[:4], NAMES[:1]])
def test_the_mass_of_one_cause_is_the_same_however_many_could_be_it(names: tuple[str, ...]):
    """Initial points of one hypothesis are not several."""
    prior = ModelPrior.of(library(names))
    assert sum(exp(prior.log_mass([Hypothesis(name, name, (), (), ())])) for name in names) == pytest.approx(PRIOR_CAUSES * (1.0 - FURTHER_CAUSE))
    assert exp(prior.log_mass([])) == pytest.approx(PRIOR_HEALTHY)


def test_an_effect_has_its_share_however_many_thrusters_it_may_be_of():
    prior = ModelPrior.of(library(NAMES))
    one, of_three = (exp(prior.log_mass([Hypothesis(name, name, (), (), ())])) for name in ("waves", "thruster_degraded[T2]"))
    assert one == pytest.approx(3.0 * of_three)


def test_sets_of_two_do_not_hold_more_than_is_theirs():
    prior = ModelPrior.of(library(NAMES))
    pairs = [exp(prior.log_mass([Hypothesis(n, n, (), (), ()) for n in pair])) for pair in combinations(NAMES, 2)]
    of_two = PRIOR_CAUSES * (1.0 - FURTHER_CAUSE) * FURTHER_CAUSE
    assert 0.5 * of_two < sum(pairs) <= of_two


def test_all_that_may_be_is_certain():
    """One cause or as many as one likes: a library of one effect, each further cause of which is another."""
    one = Hypothesis("waves", "waves", (), (), ())
    of_any = sum(exp(ModelPrior(1, {"waves": 1}).log_mass([one] * k)) / factorial(k) for k in range(1, 50))
    assert of_any == pytest.approx(PRIOR_CAUSES)
    assert pytest.approx(1.0) == PRIOR_HEALTHY + PRIOR_CAUSES + PRIOR_FILE + PRIOR_SOMETHING_ELSE


def test_evidence_and_prior_are_on_one_scale():
    """Twice the log Bayes factor: evidence of 2 is a factor of e."""
    more, less = (Model((), None, evidence, -1.0) for evidence in (12.0, 10.0))
    assert more.log_posterior - less.log_posterior == pytest.approx(1.0)


def test_sets_of_as_many_causes_that_fit_better_are_told_best_first():
    def model(names: str, evidence: float) -> Model:
        return Model(tuple(Hypothesis(n, n, (), (), ()) for n in names), None, evidence, -1.0)

    met = [model("", 0.0), model("a", 10.0), model("b", 14.0), model("b", 30.0), model("c", 20.0), model("d", 4.0), model("ab", 50.0), model("ba", 60.0)]
    assert [(sorted(m.names), m.evidence) for m in better_fits(met, met[1])] == [(["b"], 30.0), (["c"], 20.0)]
    assert better_fits(met, met[3]) == [] and better_fits(met, met[0]) == []
