"""The baseline: what causes gain beside coefficients within tolerance."""

from __future__ import annotations

import pytest
from diagnose_case import merlin, own, posed, slot

from rovval.diagnose import diagnose
from rovval.diagnose.inference.hypothesis_fit import fit_hypothesis
from rovval.diagnose.inference.map_fit import healthy_fit
from rovval.diagnose.search.baseline import healthy_without, reduction_beside
from rovval.report.diagnosis.json import document as written


@pytest.mark.slow
def test_a_cause_that_healthy_coefficients_hide_is_found_beside_them():
    """Thrust within its tolerance makes most of the gap, a weak current the rest: by itself it brings too little to be named."""
    document = diagnose([own(("current_constant:north=0.03,east=0.015", "reverse_asymmetry:scale=0.1", "rpm_scale:scale=0.06"), 5, 240.0)], merlin()).document()
    (cause,) = document["causes"]
    assert "current_constant" in cause["group"] and document["shrinkage"]["total"] < 0.15, document["sentence"]
    assert document["within_tolerance"]["low"] > 0.0


@pytest.mark.slow
def test_a_coefficient_surely_off_is_named_though_the_gap_is_another_axis():
    """Trim within its tolerance makes nine tenths of the gap, in heave; sway's drag is out of tolerance as no healthy file's is."""
    document = written(diagnose([own(("quadratic_drag[sway]:scale=0.8", "buoyancy_error:force=60"), 5, 240.0)], merlin()))
    (cause,) = document["causes"]
    assert cause["effect"] == "quadratic_drag[sway]" and document["shrinkage"]["total"] < 0.15
    assert document["shrinkage"]["axes"]["sway"] > 0.4 and "heave" in document["sentence"].lower()


@pytest.mark.slow
def test_what_tolerances_alone_make_is_no_cause():
    document = diagnose([own(("reverse_asymmetry:scale=0.1", "rpm_scale:scale=0.06"), 5, 240.0)], merlin()).document()
    assert document["causes"] == [] and document["within_tolerance"] is None


def test_a_coefficient_does_not_hide_behind_its_own_tolerance():
    """Healthy drag may be what the cause is a departure of: without its own tolerance the others leave the gap open."""
    p = posed(("quadratic_drag[surge]:scale=0.4",), seconds=100.0)[0]
    own, healthy = (slot(p, "quadratic_drag[surge].scale"),), healthy_fit(p)
    others, final = healthy_without(p, healthy, own), fit_hypothesis(p, p.origin, own)
    assert healthy.beta[own[0]] != p.origin[own[0]] and others.beta[own[0]] == p.origin[own[0]]
    assert reduction_beside(p, final, others, 0)[1] > reduction_beside(p, final, healthy, 0)[1] - 0.01 and reduction_beside(p, final, others, 0)[1] > 0.0
