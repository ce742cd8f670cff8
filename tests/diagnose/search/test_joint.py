"""Causes in company: two that offset each other, one that an earlier one imitated; and causes that do not hold still are not named."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from diagnose_case import foreign, merlin, own

from rovval.diagnose import diagnose
from rovval.diagnose.decision.constancy import SHARES, _varies, wavering
from rovval.diagnose.decision.verdict import COMPANY
from rovval.diagnose.hypotheses.hypothesis import Hypothesis, columns_of
from rovval.diagnose.hypotheses.library import hypotheses
from rovval.diagnose.inference.cross_validation import PAIR, folds_of
from rovval.diagnose.inference.hypothesis_fit import confirm
from rovval.diagnose.inference.problem import Problem, pose
from rovval.diagnose.residuals.normal_equations import Products
from rovval.diagnose.search.admissibility import possible
from rovval.diagnose.search.confusion import RELIEF, Rival, denied
from rovval.diagnose.search.forward import select
from rovval.diagnose.search.joint import LEAST_GAIN, worthy
from rovval.diagnose.windows.shooting import cut_all
from rovval.report.diagnosis.json import document as written


def posed(*effects: str, seed: int = 5) -> tuple[Problem, list[Hypothesis]]:
    parts, _ = cut_all([own(effects, seed, 200.0)], merlin(), "fossen", 10.0)
    library = hypotheses(parts)[0]
    return pose(parts, columns_of(library), 0.05), library


def test_a_second_cause_does_not_lead_the_first_away():
    """A step of all parameters at once takes the waves out of step, and a list beside them would seem to be worth nothing."""
    document = diagnose([own(("waves:amplitude=1.2,period=6.2,direction=-2,phase=0.4", "cg_offset:x=-0.012"), 5, 240.0)], merlin()).document()
    assert {c["effect"] for c in document["causes"]} == {"waves", "cg_offset"}, document["sentence"]
    first, second = sorted(document["causes"], key=lambda c: -c["evidence"])
    assert second["probability"] <= COMPANY < first["probability"], "a further name is less sure"


def test_a_cause_that_healthy_coefficients_hide_is_found_beside_them():
    """Thrust within its tolerance makes most of the gap, a weak current the rest: by itself it closes too little to be named."""
    document = diagnose([own(("current_constant:north=0.03,east=0.015", "reverse_asymmetry:scale=0.1", "rpm_scale:scale=0.06"), 5, 240.0)], merlin()).document()
    (cause,) = document["causes"]
    assert "current_constant" in cause["group"] and document["shrinkage"]["total"] < LEAST_GAIN, document["sentence"]
    assert document["beside_slop"]["low"] > RELIEF


def test_a_coefficient_surely_off_is_named_though_the_gap_is_another_axis():
    """Trim within its tolerance makes nine tenths of the gap, in heave; sway's drag is out of tolerance as no healthy file's is."""
    document = written(diagnose([own(("quadratic_drag[sway]:scale=0.8", "buoyancy_error:force=60"), 5, 240.0)], merlin()))
    (cause,) = document["causes"]
    assert cause["effect"] == "quadratic_drag[sway]" and document["shrinkage"]["total"] < LEAST_GAIN
    assert document["shrinkage"]["axes"]["sway"] > 0.4 and "that of sway by" in document["sentence"]


def test_a_fault_of_a_sensor_that_the_kinematic_checks_deny_is_not_named():
    p, library = posed("buoyancy_error:force=60")
    (h,) = (h for h in library if h.label == "time_offset[attitude]")
    fitted = confirm(p, p.origin, h.slots)
    seen, against = (Rival(h, fitted, 900.0, 0.5, kinematic) for kinematic in (0.1, -0.5))
    assert worthy(seen, alone=True) and not denied(seen)
    assert denied(against) and not worthy(against, alone=True) and against not in possible(p, [against])


def test_what_slop_alone_makes_is_not_called_a_cause_beside_it():
    document = diagnose([own(("reverse_asymmetry:scale=0.1", "rpm_scale:scale=0.06"), 5, 240.0)], merlin()).document()
    assert document["causes"] == [] and document["beside_slop"] is None


def test_two_causes_that_offset_each_other_are_both_found():
    """Weaker thrust and less drag: the speed is as before, only the way there differs."""
    document = diagnose([own(("rpm_scale:scale=-0.25", "quadratic_drag[surge]:scale=-0.5", "linear_drag[surge]:scale=-0.5"), 5, 240.0)], merlin()).document()
    named = {c["effect"] for c in document["causes"]}
    assert {"rpm_scale"} <= named and named & {"quadratic_drag[surge]", "linear_drag[surge]"}, document["sentence"]


def test_a_cause_that_is_there_holds_still():
    p, library = posed("inflow_loss:loss=0.4", "thruster_degraded[VAC]:loss=0.4")
    found = select(p, library, 0, lambda text, share: None)
    assert {n.hypothesis.name for n in found.named} == {"inflow_loss", "thruster_degraded[VAC]"} and found.final
    assert all(most < 0.1 * n.evidence for n, most in zip(found.named, wavering(p, found.final, found.named).values(), strict=True))


def test_a_thruster_that_drops_out_now_and_then_is_not_called_weak(tmp_path: Path):
    document = written(diagnose([foreign(tmp_path, (("intermittent_thruster", "VAC", 1.5),), 77)], merlin()))
    assert document["causes"] == [] and document["verdict"] == "unknown"
    assert "VAC" in document["left"]["text"] and "change along the log" in document["left"]["text"]


def test_commands_that_come_most_of_a_second_late_are_found_though_no_slope_shows_it():
    document = diagnose([own(("time_offset:tau=0.8",), 5, 160.0)], merlin()).document()
    (cause,) = document["causes"]
    assert cause["effect"] == "time_offset" and cause["parameters"]["tau"]["low"] < 0.8 < cause["parameters"]["tau"]["high"]


def test_velocities_in_knots_are_a_scale():
    run = own((), 5, 160.0)
    knots = replace(run, values={**run.values, **{c: 1.944 * run.get(c) for c in "uvw"}})
    (cause,) = diagnose([knots], merlin()).document()["causes"]
    assert cause["effect"] == "dvl_scale" and cause["parameters"]["scale"]["value"] == pytest.approx(0.944, abs=0.05)


def test_what_varies_is_told_from_what_does_not():
    """Values that scatter between windows have evidence for it, the same mean without scatter has evidence against it."""
    rng, m = np.random.default_rng(3), 40
    size, noise = 1.0, 0.1
    values = {scatter: size + scatter * rng.normal(size=m) + noise * rng.normal(size=m) for scatter in (0.0, 0.5)}
    found = {}
    for scatter, value in values.items():
        departure = (value - value.mean()) / noise**2
        data = Products(np.full((m, 1, 1), noise**-2), departure[:, None], departure**2, (0,))
        found[scatter] = max(_varies(data, share * size, 1.0) for share in SHARES)
    assert found[0.0] < 0 and found[0.5] > 50


def test_folds_leave_nothing_to_extrapolate_in_a_long_log():
    folds = folds_of(np.zeros(30, dtype=int))
    tests = np.stack([f.test for f in folds])
    assert (tests.sum(axis=0) == 1).all() and len(folds) == 5
    for fold in folds:
        held = np.flatnonzero(fold.test)
        assert (np.diff(held.reshape(-1, PAIR), axis=1) == 1).all(), "neighbours go together"
    assert [np.flatnonzero(f.test).tolist() for f in folds_of(np.zeros(5, dtype=int))] == [[i] for i in range(5)]


def test_a_payload_that_grows_is_not_called_a_payload_but_unknown(tmp_path: Path):
    document = written(diagnose([foreign(tmp_path, (("water_leak", "", 2.0),), 78, 300.0)], merlin()))
    assert document["causes"] == [] and document["verdict"] == "unknown"
    assert "payload_change" in document["left"]["text"] and "change along the log" in document["left"]["text"]
