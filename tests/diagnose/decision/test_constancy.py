"""Constancy: a true cause has one size along the log; what varies is something else."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from diagnose_case import foreign, merlin, posed

from rovval.diagnose import diagnose
from rovval.diagnose.decision.constancy import Variation, variation
from rovval.diagnose.hypotheses.hypothesis import Hypothesis, columns_of
from rovval.diagnose.hypotheses.library import hypotheses
from rovval.diagnose.inference.map_fit import map_fit
from rovval.diagnose.problem.problem import Problem, pose
from rovval.diagnose.windows.multiple_shooting import cut
from rovval.report.diagnosis.json import document as written


def fitted(problem: Problem, library: list[Hypothesis], name: str) -> Variation:
    """That of the size of a cause, fitted by itself."""
    h = next(h for h in library if h.name == name)
    return variation(problem, map_fit(problem, problem.origin, h.slots), [h])


@pytest.mark.parametrize(("planted", "name"), [("inflow_loss:loss=0.4", "inflow_loss"), ("thruster_degraded[VAC]:loss=0.4", "thruster_degraded[VAC]")])
def test_a_cause_that_is_there_holds_still(planted: str, name: str):
    found = fitted(*posed((planted,)), name)
    assert max(found.form, *found.alike.values()) < 0.0 and found.goes_with is None


def test_from_where_the_place_of_a_cause_is_counted_is_no_part_of_its_size():
    """The depth of a stratification, counted from 20 m higher up, at the same fit."""
    problem, library = posed(("density_gradient:gradient=8,depth=3,layer=2",))
    h = next(h for h in library if h.name == "density_gradient")
    start = problem.origin.copy()
    start[[slot for slot, _ in h.at]] = [value for _, value in h.at]
    point = map_fit(problem, start, h.slots)
    at = [problem.plant.slots[slot].key for slot in point.columns].index("density_gradient.depth")
    moved, b = point.departure.copy(), point.total.b.copy()
    moved[at] += 20.0
    b[0] += 20.0 * point.precision[at]  # the prior pulls no more than before
    elsewhere = replace(point, departure=moved, total=replace(point.total, b=b))
    assert variation(problem, elsewhere, [h]).form == pytest.approx(variation(problem, point, [h]).form, abs=1e-9)


def test_a_loss_that_begins_in_mid_log_varies_as_one_that_was_always_there():
    assert fitted(*posed(("thruster_fault_onset[VAC]:loss=0.9,onset=60",)), "thruster_degraded[VAC]").either > 2.0


@pytest.mark.parametrize(
    ("planted", "name", "covariate"),
    [(("one_sided_drag", "", 1.9), "quadratic_drag[surge]", "u"), (("power_limit", "", 2.0), "rpm_scale", "thrusters' speed")],
)
def test_what_only_looks_like_a_cause_goes_with_what_it_depends_on(tmp_path: Path, planted: tuple[str, str, float], name: str, covariate: str):
    """A net that opens astern against drag, a supply that gives way under load against a scale of speed, of a plant that has nothing of this model."""
    windows, _ = cut([foreign(tmp_path, (planted,), 31)], merlin(), "fossen", 10.0)
    library, _ = hypotheses(windows)
    found = fitted(pose(windows, columns_of(library), 0.05), library, name)
    assert found.goes_with == (name, covariate) and found.either > 6.0


@pytest.mark.slow
def test_a_thruster_that_drops_out_now_and_then_is_put_down_to_no_other(tmp_path: Path):
    """The library has nothing that comes and goes; its nearest relative is a fault of the same thruster."""
    document = written(diagnose([foreign(tmp_path, (("intermittent_thruster", "VAC", 1.5),), 77)], merlin()))
    assert all(c["effect"].endswith("[VAC]") for c in document["causes"]) and document["verdict"] != "no_gap"
