"""Plausibility: what a fitted hypothesis is called, it is."""

from __future__ import annotations

import pytest
from diagnose_case import posed, slot

from rovval.diagnose.inference.hypothesis_fit import fit_hypothesis
from rovval.diagnose.inference.map_fit import healthy_fit
from rovval.diagnose.search.baseline import compared, healthy_baseline
from rovval.diagnose.search.plausible import plausible


@pytest.mark.parametrize(("fraction", "is_reversed"), [(1.0, True), (0.65, True), (0.6, False)])
def test_a_thruster_is_reversed_where_it_is_nearer_to_that_than_to_a_dead_one(fraction: float, is_reversed: bool):
    """By the speed of its shaft: what pushes the other way by less than a quarter of its thrust turns at less than half of its speed, and is a dead one of a
    vehicle whose other numbers are off."""
    p, library = posed((f"thruster_reversed[HFP]:fraction={fraction}",), seconds=60.0)
    h = next(h for h in library if h.name == "thruster_reversed[HFP]")
    start, place = p.origin.copy(), slot(p, "thruster_reversed[HFP].fraction")
    start[place] = fraction
    fit = fit_hypothesis(p, start, h.slots)
    assert fit.beta[place] == pytest.approx(fraction, abs=0.1)
    assert plausible(p, compared(h, fit, healthy_baseline(p, healthy_fit(p)))) == is_reversed
