"""The verdict: what the library lacks is unknown and located."""

from __future__ import annotations

import pytest
from diagnose_case import merlin, own, posed

from rovval.diagnose import diagnose
from rovval.diagnose.decision.verdict import decide
from rovval.diagnose.hypotheses.hypothesis import Hypothesis
from rovval.diagnose.inference.hypothesis_fit import fit_hypothesis
from rovval.diagnose.inference.laplace import laplace_evidence
from rovval.diagnose.inference.map_fit import healthy_fit
from rovval.diagnose.problem.problem import corrected_residuals
from rovval.diagnose.search.forward import Selection
from rovval.diagnose.search.model import Model, ModelPrior
from rovval.report.diagnosis.json import document as written

RELATIVES = {  # withheld with the effect: the same law, or one that is it at some value of its parameters
    "current_constant:north=0.15": ("current_constant", "current_varying", "current_shear", "tether_tension", "tether_snag"),
    "thruster_degraded[HFP]:loss=0.5": (
        "thruster_degraded",
        "thruster_fault_onset",
        "thruster_reversed",
        "thruster_interaction",
    ),
}


@pytest.mark.parametrize(
    ("planted", "axes"), [pytest.param("current_constant:north=0.15", {"surge", "sway"}, marks=pytest.mark.slow), ("thruster_degraded[HFP]:loss=0.5", {"yaw"})]
)
def test_a_withheld_effect_is_unknown_and_said_where(planted: str, axes: set[str]):
    document = written(diagnose([own((planted,), 5, 160.0)], merlin(), without=RELATIVES[planted]))
    assert document["verdict"] == "unknown" and document["causes"] == []
    assert document["left"]["axes"][0] in axes and "nothing in the library" in document["left"]["text"]


@pytest.mark.slow
def test_a_cause_without_which_the_named_set_is_as_probable_is_not_named():
    """A search that met the true cause in company alone: a gyro's bias stands beside it, and is worth nothing there."""
    problem, _ = posed(("inflow_loss:loss=0.3",))
    healthy, names = healthy_fit(problem), ("inflow_loss", "gyro_bias")
    causes = tuple(Hypothesis(n, n, tuple(i for i, s in enumerate(problem.plant.slots) if s.hypothesis == n), (), ()) for n in names)
    prior = ModelPrior.of(causes)
    fit = fit_hypothesis(problem, problem.origin, tuple(s for h in causes for s in h.slots)).without_sensitivities()
    alone, both = Model((), None, laplace_evidence(problem, healthy), prior.log_mass(())), Model(causes, fit, fit.evidence, prior.log_mass(causes))
    found = decide(problem, Selection((alone, both), both, healthy, (), (), None, prior, ()), corrected_residuals(problem), ())
    assert [h.name for h in found.causes] == ["inflow_loss"] and found.verdict == "explained"
    assert found.added["inflow_loss"] > 10.0
