"""What begins during a log, of effects without an onset of their own: found where it is, on a plant of another kind, and nowhere else."""

from __future__ import annotations

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
from rovval.diagnose.decision.finding import Finding
from rovval.diagnose.hypotheses.hypothesis import columns_of
from rovval.diagnose.hypotheses.library import hypotheses
from rovval.diagnose.inference.hypothesis_fit import fit_hypothesis
from rovval.diagnose.inference.laplace import laplace_evidence
from rovval.diagnose.inference.map_fit import healthy_fit
from rovval.diagnose.problem.problem import pose
from rovval.diagnose.residuals.normal_equations import NormalEquations
from rovval.diagnose.residuals.ridge import Prior
from rovval.diagnose.search.onset import Onset, Stretch, evidence_with_onset, onset_cost, windows_from
from rovval.diagnose.windows.multiple_shooting import cut
from rovval.diagnose.windows.windows import Windows
from rovval.report.diagnosis.json import document as written
from rovval.report.diagnosis.sentences.sentence import since
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


@pytest.mark.slow
def test_what_begins_in_mid_log_is_named_from_there_on(logs: tuple[Run, Run]) -> None:
    found = diagnose([logs[0]], merlin())
    document = written(found)
    assert document["since_s"] == pytest.approx(BEGINS, abs=15.0)
    assert document["causes"][0]["effect"] == "inflow_loss"
    assert document["causes"][0]["onset_s"] == document["since_s"] and document["shrinkage"]["total"] > 0.5
    assert document["sentence"].startswith(since(found)) and since(found)


@pytest.mark.slow
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
    whole = Stretch.of(data, slice(None), tolerance, 1.0)
    assert late.explained(at, wide, 1.0) > 200.0 + whole.explained(at, wide, 1.0)
    assert early.explained(at, wide, 1.0) < 0.0


def answered(onset: Onset, best: float = 0.0, verdict: str = "unknown") -> Finding:
    """A pass over the whole log whose best causes have the evidence ``best``."""
    selection: Any = SimpleNamespace(onset=onset, healthy=None)
    decision: Any = SimpleNamespace(causes=(), evidence=best, fit=None, verdict=verdict)
    problem: Any = None
    return Finding(problem, {}, selection, [], (), decision)


def test_a_part_that_cannot_be_simulated_leaves_the_answer_of_the_whole(monkeypatch: pytest.MonkeyPatch):
    windows, whole = list[int](), answered(Onset(40.0, 500.0))
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
    assert evidence_with_onset(problem, late, BEGINS, alone) > always.evidence + onset_cost(problem)
    assert evidence_with_onset(problem, always, 1e6, alone) == pytest.approx(laplace_evidence(problem, alone), abs=1.0)


@pytest.mark.parametrize(
    ("hinted", "verdict", "searched"),
    [(10.0, "explained", False), (250.0, "explained", True), (10.0, "partly_explained", True), (10.0, "unknown", True)],
)
def test_a_part_that_promises_little_beside_a_log_that_is_explained_is_not_searched(hinted: float, verdict: str, searched: bool) -> None:
    whole = answered(Onset(40.0, hinted), 300.0, verdict)
    assert whole.onset == (Onset(40.0, hinted) if searched else None)
