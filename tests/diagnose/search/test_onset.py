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
from rovval.diagnose import diagnose, pipeline
from rovval.diagnose.criteria import ONSET_CLEARER
from rovval.diagnose.decision.finding import Finding
from rovval.diagnose.hypotheses.hypothesis import columns_of
from rovval.diagnose.hypotheses.library import hypotheses
from rovval.diagnose.inference.hypothesis_fit import fit_hypothesis
from rovval.diagnose.inference.laplace import laplace_evidence
from rovval.diagnose.inference.map_fit import healthy_fit
from rovval.diagnose.problem.problem import pose
from rovval.diagnose.residuals.normal_equations import NormalEquations
from rovval.diagnose.residuals.ridge import Prior
from rovval.diagnose.search.baseline import compared, healthy_baseline, reduction
from rovval.diagnose.search.joint import sufficient
from rovval.diagnose.search.onset import Onset, Stretch, evidence_with_onset, windows_from
from rovval.diagnose.windows.multiple_shooting import cut
from rovval.diagnose.windows.windows import Windows
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


def test_what_begins_in_mid_log_is_named_from_there_on(logs: tuple[Run, Run]) -> None:
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
    """One cause beside a coefficient within tolerance, in closed form: the size from the later windows makes the earlier ones worse."""
    rng = np.random.default_rng(0)
    x = rng.normal(size=(8, 30, 2))
    r = 0.1 * rng.normal(size=(8, 30)) + np.where(np.arange(8)[:, None] >= 4, 2.0, 0.0) * x[..., 0] + 0.03 * x[..., 1]
    data = NormalEquations(np.einsum("wti,wtj->wij", x, x), np.einsum("wti,wt->wi", x, r), (r**2).sum(axis=1), (0, 1))
    tolerance, wide, at = Prior({1: 0.05}), Prior({0: 4.0}), np.array([0])
    late, early = (Stretch.of(data, windows, tolerance, 1.0) for windows in (slice(4, None), slice(4)))
    evidence, size = late.explained(at, wide, 1.0)
    assert size == pytest.approx([2.0], abs=0.05) and evidence > 300.0
    assert late.reduction(at, size) > 300.0 and early.reduction(at, size) < -300.0
    assert early.explained(at, wide, 1.0)[0] < 0.0


def unnamed(onset: Onset, best: float = 0.0) -> Finding:
    """A pass over the whole log that names nothing, whose best candidate has the evidence ``best``."""
    selection: Any = SimpleNamespace(onset=onset, steps=((("waves", best, 0.3),),), healthy=None)
    decision: Any = SimpleNamespace(causes=(), evidence=0.0, fit=None)
    problem: Any = None
    return Finding(problem, {}, selection, [], (), decision)


def test_a_part_that_cannot_be_simulated_leaves_the_answer_of_the_whole(monkeypatch: pytest.MonkeyPatch):
    windows, whole = list[int](), unnamed(Onset(40.0, 500.0))
    run = own((), 5, 100.0)

    def analysed(some: tuple[Windows, ...], *_: Any) -> Any:
        windows.append(some[0].count)
        if len(windows) > 1:
            raise BadInput("too few windows can be simulated", "")
        return whole

    monkeypatch.setattr(pipeline, "analyse", analysed)
    monkeypatch.setattr(pipeline, "assemble", lambda found, *_: found)
    assert pipeline.diagnose([run], merlin()) is whole  # type: ignore[comparison-overlap]
    (part,), _ = cut([run], merlin(), "fossen", 10.0)
    assert windows == [part.count, int((part.start * part.run.dt >= 40.0).sum())]


def test_a_cause_that_never_begins_is_a_healthy_vehicle_with_its_own_tolerance(logs: tuple[Run, Run]) -> None:
    """A coefficient that the cause takes is as free before it as any other."""
    parts, _ = cut([logs[0]], merlin(), "fossen", 10.0)
    library, _ = hypotheses(parts)
    problem = pose(parts, columns_of(library), 0.05)
    drag = next(h for h in library if h.name == "linear_drag[surge]")
    always, alone = fit_hypothesis(problem, problem.origin, drag.slots), healthy_fit(problem)
    assert set(drag.slots) <= set(problem.tolerance.sd)
    assert evidence_with_onset(problem, always, 1e6, alone) == pytest.approx(laplace_evidence(problem, alone), abs=1.0)
    assert evidence_with_onset(problem, always, 0.0, alone) == pytest.approx(always.evidence, abs=5.0)  # sensitivities of tolerances made anew where it ended


def test_a_cause_from_some_moment_on_is_weighed_on_every_window(logs: tuple[Run, Run]) -> None:
    """From before the log on it is the cause itself; from after its end on, a healthy vehicle; at its own beginning it is worth more than all through."""
    parts, _ = cut([logs[0]], merlin(), "fossen", 10.0)
    library, _ = hypotheses(parts)
    problem = pose(parts, columns_of(library), 0.05)
    slots = next(h.slots for h in library if h.name == "inflow_loss")
    always = fit_hypothesis(problem, problem.origin, slots)
    alone = healthy_fit(problem)
    assert evidence_with_onset(problem, always, 0.0, alone) == pytest.approx(always.evidence, rel=1e-3)
    late = fit_hypothesis(pose((windows_from(parts[0], BEGINS),), columns_of(library), 0.05), always.beta, slots)
    assert evidence_with_onset(problem, late, BEGINS, alone) > always.evidence + ONSET_CLEARER
    assert evidence_with_onset(problem, always, 1e6, alone) == pytest.approx(laplace_evidence(problem, alone), abs=1.0)


def test_what_begins_late_is_asked_what_it_gains_from_there_on() -> None:
    """A fault of a thruster in the last third, in a log whose drag is wrong all through."""
    effects = ("quadratic_drag[surge]:scale=2.0", f"thruster_fault_onset[HFP]:loss=1.0,onset={BEGINS}")
    parts, _ = cut([own(effects, 5, 200.0)], merlin(), "fossen", 10.0)
    problem = pose(parts, columns_of(hypotheses(parts)[0]), 0.05)
    fault = next(h for h in hypotheses(parts)[0] if h.name == "thruster_fault_onset[HFP]")
    start = problem.origin.copy()
    start[list(fault.slots)] = [{"loss": 1.0, "onset": BEGINS}[problem.plant.slots[s].parameter.name] for s in fault.slots]
    fitted, baseline = fit_hypothesis(problem, start, fault.slots), healthy_baseline(problem, healthy_fit(problem))
    one = compared(problem, fault, fitted, baseline)
    everywhere, _ = reduction(baseline.losses, (fitted.loss, fitted.dynamics_loss))
    acts = np.concatenate([(part.start + part.steps) * part.run.dt > fitted.beta[list(fault.slots)].max() for part in problem.runs])
    there, _ = reduction((baseline.losses[0][acts], baseline.losses[1][acts]), (fitted.loss[acts], fitted.dynamics_loss[acts]))
    assert one.gain_since == pytest.approx(there) and there > everywhere + 0.03 and one.gain == pytest.approx(everywhere)
    little = replace(one, gain=0.05, gain_beside=0.0, restores=False)
    assert sufficient(little, alone=True) and not sufficient(replace(little, gain_since=0.0), alone=True)


@pytest.mark.parametrize(("hinted", "searched"), [(10.0, False), (250.0, True)])
def test_a_part_that_promises_little_beside_the_whole_log_is_not_searched(hinted: float, searched: bool) -> None:
    whole = unnamed(Onset(40.0, hinted), best=300.0)
    assert whole.onset == (Onset(40.0, hinted) if searched else None)
