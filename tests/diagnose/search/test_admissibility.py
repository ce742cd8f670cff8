"""Admissibility: which candidates may be the cause, and which is named first."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from diagnose_case import posed, slot

from rovval.diagnose.inference.hypothesis_fit import HypothesisFit
from rovval.diagnose.search.admissibility import beyond_bounds, simplest
from rovval.diagnose.search.baseline import Candidate


def test_what_only_refines_an_effect_does_not_make_it_less_simple():
    p, library = posed()
    fitted = HypothesisFit((), p.origin, SimpleNamespace(), 0.0, np.zeros(1), np.zeros(1), ())  # type: ignore[arg-type]
    by_name = {h.name: Candidate(h, fitted, evidence, 0.8, 0.0) for h in library for evidence in [400.0 if h.name == "thrust_lag" else 390.0]}
    lag, offset, hull = (by_name[name] for name in ("thrust_lag", "time_offset", "hull_interaction"))
    assert len(lag.hypothesis.slots) == 2 and len(offset.hypothesis.slots) == 1
    assert simplest(p, [lag, offset]) is lag
    assert simplest(p, [replace(hull, evidence=400.0), offset]) is offset


@pytest.mark.parametrize(("other", "evidence", "named"), [
    ("thruster_degraded[HFP]", 340.0, "thruster_fault_onset[HFP]"), ("thruster_degraded[HFP]", 398.0, "thruster_degraded[HFP]"),
    ("thruster_degraded[HFS]", 380.0, "thruster_degraded[HFS]"),
])  # fmt: skip
def test_evidence_says_whether_a_loss_of_thrust_began_in_mid_log(other: str, evidence: float, named: str):
    """No form of an equation lies between the two; between two thrusters it may."""
    p, library = posed()
    fitted = HypothesisFit((), p.origin, SimpleNamespace(), 0.0, np.zeros(1), np.zeros(1), ())  # type: ignore[arg-type]
    worth = {"thruster_fault_onset[HFP]": 400.0, other: evidence}
    rivals = [Candidate(next(h for h in library if h.name == name), fitted, much, 0.8, 0.0) for name, much in worth.items()]
    assert simplest(p, rivals).hypothesis.name == named


@pytest.mark.parametrize(
    ("name", "key", "value", "beyond"),
    [
        ("cross_drag", "cross_drag.sway_to_yaw", -0.5, True), ("cross_drag", "cross_drag.sway_to_yaw", -0.3, False),
        ("quadratic_drag[surge]", "quadratic_drag[surge].scale", -0.95, False), ("quadratic_drag[surge]", "quadratic_drag[surge].scale", 9.0, True),
        ("thruster_degraded[HFP]", "thruster_degraded[HFP].loss", 1.0, False), ("thruster_degraded[HFP]", "thruster_degraded[HFP].loss", -0.5, True),
        ("tether_tension", "tether_tension.x", 2.0, False), ("tether_drag", "tether_drag.per_length", 0.0, False), ("waves", "waves.amplitude", 3.0, True),
    ],
)  # fmt: skip
def test_a_size_at_the_end_of_its_search_is_no_cause_unless_it_is_the_end_of_the_thing(name, key, value, beyond):
    p, library = posed()
    h, where = next(h for h in library if h.name == name), slot(p, key)
    beta = p.origin.copy()
    beta[where] = value
    bounds = p.plant.slots[where].parameter
    fitted: Any = SimpleNamespace(beta=beta, at_bound=(where,) if value in (bounds.low, bounds.high) else ())
    assert beyond_bounds(p, Candidate(h, fitted, 100.0, 0.5, 0.0)) is beyond
