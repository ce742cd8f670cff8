"""Constancy: a true cause has one value along the log; what varies or drifts is no cause."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from diagnose_case import foreign, merlin, posed

from rovval.diagnose import diagnose
from rovval.diagnose.decision.constancy import variation, variation_evidence
from rovval.diagnose.hypotheses.library import initialised
from rovval.diagnose.inference.map_fit import healthy_fit
from rovval.diagnose.residuals.normal_equations import NormalEquations
from rovval.diagnose.search.forward import search
from rovval.report.diagnosis.json import document as written


def test_a_cause_that_is_there_holds_still():
    p, library = posed(("inflow_loss:loss=0.4", "thruster_degraded[VAC]:loss=0.4",))
    healthy = healthy_fit(p)
    found = search(p, library, initialised(p, library, healthy), healthy, 0, lambda text, share: None)
    assert {n.hypothesis.name for n in found.causes} == {"inflow_loss", "thruster_degraded[VAC]"} and found.fit
    assert all(most < 0.1 * n.evidence for n, most in zip(found.causes, variation(p, found.fit, found.causes).values(), strict=True))


def test_a_thruster_that_drops_out_now_and_then_is_not_called_weak(tmp_path: Path):
    document = written(diagnose([foreign(tmp_path, (("intermittent_thruster", "VAC", 1.5),), 77)], merlin()))
    assert document["causes"] == [] and document["verdict"] == "unknown"
    assert "VAC" in document["left"]["text"] and "change along the log" in document["left"]["text"]


def test_what_varies_is_told_from_what_does_not():
    """Values that scatter between windows have evidence for it, the same mean without scatter has evidence against it."""
    rng, m = np.random.default_rng(3), 40
    size, noise = 1.0, 0.1
    values = {scatter: size + scatter * rng.normal(size=m) + noise * rng.normal(size=m) for scatter in (0.0, 0.5)}
    found = {}
    for scatter, value in values.items():
        departure = (value - value.mean()) / noise**2
        data = NormalEquations(np.full((m, 1, 1), noise**-2), departure[:, None], departure**2, (0,))
        found[scatter] = variation_evidence(data, size, 1.0)
    assert found[0.0] < 0 and found[0.5] > 50


def test_a_value_that_no_window_shows_does_not_vary():
    """On a log without windows on its axis a parameter goes back to the file's value: shares of nothing were divided by."""
    blind = NormalEquations(np.zeros((12, 1, 1)), np.zeros((12, 1)), np.ones(12), (0,))
    assert variation_evidence(blind, 0.0, 1.0) == 0.0
    assert variation_evidence(blind, 1e-200, 1.0) == 0.0
    assert variation_evidence(blind, 0.5, 1.0) == 0.0


def test_a_payload_that_grows_is_not_called_a_payload_but_unknown(tmp_path: Path):
    document = written(diagnose([foreign(tmp_path, (("water_leak", "", 2.0),), 78, 300.0)], merlin()))
    assert document["causes"] == [] and document["verdict"] == "unknown"
    assert "payload_change" in document["left"]["text"] and "change along the log" in document["left"]["text"]
