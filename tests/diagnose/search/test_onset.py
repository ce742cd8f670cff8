"""What begins during a log, of effects without an onset of their own: found where it is, on a plant of another kind, and nowhere else."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from diagnose_case import LIBRARY, merlin, own

from rovval.blind.cases.csv_log import write_csv
from rovval.blind.cases.flight import fly
from rovval.blind.plant.spec import Planted
from rovval.core.data import Run
from rovval.core.errors import BadInput
from rovval.diagnose import diagnose
from rovval.diagnose.decision.finding import Finding, find
from rovval.diagnose.hypotheses.hypothesis import columns_of
from rovval.diagnose.hypotheses.library import hypotheses
from rovval.diagnose.inference.hypothesis_fit import confirm
from rovval.diagnose.inference.laplace import whole_evidence
from rovval.diagnose.inference.map_fit import healthy_point
from rovval.diagnose.inference.prior import Prior
from rovval.diagnose.inference.problem import pose
from rovval.diagnose.residuals.normal_equations import Products
from rovval.diagnose.search.baseline import bare, rival
from rovval.diagnose.search.confusion import closed
from rovval.diagnose.search.joint import worthy
from rovval.diagnose.search.onset import CLEARER, Beginning, _explained, _Part, _worth, after
from rovval.diagnose.search.switched import switched
from rovval.diagnose.windows.shooting import Stretches, cut_all
from rovval.report.diagnosis.json import document as written
from rovval.report.diagnosis.sentence import since
from rovval.storage.archive import open_run

BEGINS = 120.0


@pytest.fixture(scope="module")
def logs(tmp_path_factory: pytest.TempPathFactory) -> tuple[Run, Run]:
    """A loss of thrust that begins in mid-log, and the same loss from the first second on."""
    folder, runs = tmp_path_factory.mktemp("since"), []
    for i, onset in enumerate((BEGINS, None)):
        flight = fly(LIBRARY / "merlin.toml", "rich", [Planted("inflow_loss", None, 1.5, onset)], 21, 240.0, 0.02)
        path = folder / f"log{i}.csv"
        write_csv(flight, path)
        runs.append(open_run(path, "merlin", folder / f"archive{i}"))
    return runs[0], runs[1]


def test_what_begins_in_mid_log_is_told_from_there_on(logs: tuple[Run, Run]) -> None:
    found = diagnose([logs[0]], merlin())
    document = written(found)
    assert document["since_s"] == pytest.approx(BEGINS, abs=15.0)
    assert [c["effect"] for c in document["causes"]] == ["inflow_loss"]
    assert document["causes"][0]["onset_s"] == document["since_s"] and document["shrinkage"]["total"] > 0.5
    assert document["sentence"].startswith(since(found)) and since(found)


def test_what_is_always_there_has_no_beginning(logs: tuple[Run, Run]) -> None:
    found = diagnose([logs[1]], merlin())
    document = found.document()
    assert document["since_s"] is None and since(found) == "" and [c["effect"] for c in document["causes"]] == ["inflow_loss"]
    assert document["causes"][0]["onset_s"] is None


def test_the_windows_before_deny_what_they_do_not_hold() -> None:
    """One cause beside a coefficient of slop, in closed form: the size from the later windows makes the earlier ones worse."""
    rng = np.random.default_rng(0)
    x = rng.normal(size=(8, 30, 2))
    r = 0.1 * rng.normal(size=(8, 30)) + np.where(np.arange(8)[:, None] >= 4, 2.0, 0.0) * x[..., 0] + 0.03 * x[..., 1]
    data = Products(np.einsum("wti,wtj->wij", x, x), np.einsum("wti,wt->wi", x, r), (r**2).sum(axis=1), (0, 1))
    slop, wide, at = Prior({1: 0.05}), Prior({0: 4.0}), np.array([0])
    late, early = (_Part.of(data, windows, slop, 1.0) for windows in (slice(4, None), slice(4)))
    evidence, size = _explained(late, at, wide, 1.0)
    assert size == pytest.approx([2.0], abs=0.05) and evidence > 300.0
    assert _worth(late, at, size) > 300.0 and _worth(early, at, size) < -300.0
    assert _explained(early, at, wide, 1.0)[0] < 0.0


def test_a_part_that_cannot_be_simulated_leaves_the_answer_of_the_whole(monkeypatch: pytest.MonkeyPatch):
    parts, _ = cut_all([own((), 5, 100.0)], merlin(), "fossen", 10.0)
    whole: Any = SimpleNamespace(
        selection=SimpleNamespace(began=Beginning(40.0, 500.0), rounds=()), decision=SimpleNamespace(causes=())
    )
    asked = list[int]()

    def searched(some: tuple[Stretches, ...], *_: Any) -> Any:
        asked.append(some[0].count)
        if len(asked) > 1:
            raise BadInput("too few windows can be simulated", "")
        return whole

    monkeypatch.setattr("rovval.diagnose.decision.finding._searched", searched)
    assert find(parts, (), 0.05, 0, lambda *_: None) is whole
    assert asked == [parts[0].count, int((parts[0].start * parts[0].run.dt >= 40.0).sum())]


@pytest.mark.parametrize(
    ("first", "causes", "evidence", "told"),
    [
        ((("waves", 300.0, 0.3),), 0.0, 1325.0, True),  # of a healthy vehicle 1000: the whole log shows 300 more, named or not
        ((("waves", 300.0, 0.3),), 0.0, 1315.0, False),
        ((("waves", 100.0, 0.3),), 300.0, 1325.0, True),
        ((("waves", 100.0, 0.3),), 300.0, 1315.0, False),
        ((), 0.0, 1025.0, True),
    ],
)
def test_what_follows_a_change_has_to_outdo_what_the_whole_log_shows(
    monkeypatch: pytest.MonkeyPatch, first: tuple[tuple[str, float, float], ...], causes: float, evidence: float, told: bool
):
    parts, _ = cut_all([own((), 5, 100.0)], merlin(), "fossen", 10.0)

    def finding(name: str, causes: float, began: Beginning | None) -> Finding:
        named = (SimpleNamespace(hypothesis=SimpleNamespace(name=name, effect=SimpleNamespace(begins=False))),) if causes else ()
        selection: Any = SimpleNamespace(began=began, rounds=(first,), healthy=None)
        problem: Any = None
        decision: Any = SimpleNamespace(causes=named, evidence=causes, fit=object())
        return Finding(problem, {}, selection, [], decision)

    found = iter((finding("voltage_sag", causes, Beginning(40.0, 70.0)), finding("reverse_asymmetry", 80.0, None)))
    monkeypatch.setattr("rovval.diagnose.decision.finding._searched", lambda *_: next(found))
    monkeypatch.setattr("rovval.diagnose.decision.finding.whole_evidence", lambda *_: 1000.0)
    monkeypatch.setattr("rovval.diagnose.decision.finding.switched", lambda problem, late, since, healthy: evidence if since == 40.0 else 0.0)
    one = find(parts, (), 0.05, 0, lambda *_: None)
    assert one.since == (40.0 if told else None)
    assert [n.hypothesis.name for n in one.decision.causes] == (["reverse_asymmetry"] if told else ["voltage_sag"] if causes else [])


def test_a_cause_that_never_begins_is_a_healthy_vehicle_with_its_own_tolerance(logs: tuple[Run, Run]) -> None:
    """A coefficient that the cause takes is as free before it as any other."""
    parts, _ = cut_all([logs[0]], merlin(), "fossen", 10.0)
    library, _ = hypotheses(parts)
    problem = pose(parts, columns_of(library), 0.05)
    drag = next(h for h in library if h.name == "linear_drag[surge]")
    always, alone = confirm(problem, problem.origin, drag.slots), healthy_point(problem)
    assert set(drag.slots) <= set(problem.slop.sd)
    assert switched(problem, always, 1e6, alone) == pytest.approx(whole_evidence(problem, alone), abs=1.0)
    assert switched(problem, always, 0.0, alone) == pytest.approx(always.evidence, abs=5.0)  # slopes of slop made anew where it settled


def test_a_cause_from_some_moment_on_is_weighed_on_every_window(logs: tuple[Run, Run]) -> None:
    """From before the log on it is the cause itself; from after its end on, a healthy vehicle; at its own beginning it is worth more than all through."""
    parts, _ = cut_all([logs[0]], merlin(), "fossen", 10.0)
    library, _ = hypotheses(parts)
    problem = pose(parts, columns_of(library), 0.05)
    slots = next(h.slots for h in library if h.name == "inflow_loss")
    always = confirm(problem, problem.origin, slots)
    alone = healthy_point(problem)
    assert switched(problem, always, 0.0, alone) == pytest.approx(always.evidence, rel=1e-3)
    late = confirm(pose((after(parts[0], BEGINS),), columns_of(library), 0.05), always.beta, slots)
    assert switched(problem, late, BEGINS, alone) > always.evidence + CLEARER
    assert switched(problem, always, 1e6, alone) == pytest.approx(whole_evidence(problem, alone), abs=1.0)


def test_what_begins_late_is_asked_what_it_closes_from_there_on() -> None:
    """A fault of a thruster in the last third, in a log whose drag is wrong all through."""
    effects = ("quadratic_drag[surge]:scale=2.0", f"thruster_fault_onset[HFP]:loss=1.0,onset={BEGINS}")
    parts, _ = cut_all([own(effects, 5, 200.0)], merlin(), "fossen", 10.0)
    problem = pose(parts, columns_of(hypotheses(parts)[0]), 0.05)
    fault = next(h for h in hypotheses(parts)[0] if h.name == "thruster_fault_onset[HFP]")
    start = problem.origin.copy()
    start[list(fault.slots)] = [{"loss": 1.0, "onset": BEGINS}[problem.plant.slots[s].parameter.name] for s in fault.slots]
    fitted, ground = confirm(problem, start, fault.slots), bare(problem, healthy_point(problem))
    one = rival(problem, fault, fitted, ground)
    everywhere, _ = closed(ground.loss, (fitted.loss, fitted.dynamic_loss))
    acts = np.concatenate([(part.start + part.steps) * part.run.dt > fitted.beta[list(fault.slots)].max() for part in problem.parts])
    there, _ = closed((ground.loss[0][acts], ground.loss[1][acts]), (fitted.loss[acts], fitted.dynamic_loss[acts]))
    assert one.begun == pytest.approx(there) and there > everywhere + 0.03 and one.gain == pytest.approx(everywhere)
    little = replace(one, gain=0.05, beside=0.0, mends=False)
    assert worthy(little, alone=True) and not worthy(replace(little, begun=0.0), alone=True)


@pytest.mark.parametrize(("hinted", "searched"), [(59.0, False), (61.0, True)])
def test_what_promises_little_beside_the_whole_log_is_not_searched(monkeypatch: pytest.MonkeyPatch, hinted: float, searched: bool) -> None:
    selection: Any = SimpleNamespace(began=Beginning(40.0, hinted), rounds=((("waves", 300.0, 0.3),),), healthy=None)
    decision: Any = SimpleNamespace(causes=(), evidence=0.0, fit=None)
    problem: Any = None
    asked, parts = list[int](), cut_all([own((), 5, 100.0)], merlin(), "fossen", 10.0)[0]

    def once(*_: Any) -> Finding:
        asked.append(1)
        return Finding(problem, {}, selection, [], decision)

    monkeypatch.setattr("rovval.diagnose.decision.finding._searched", once)
    assert find(parts, (), 0.05, 0, lambda *_: None).since is None
    assert len(asked) == (2 if searched else 1)
