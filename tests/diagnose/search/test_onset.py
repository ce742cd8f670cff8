"""What begins during a log, of effects without an onset of their own: found where it is, on a plant of another kind, and nowhere else."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from diagnose_case import LIBRARY, foreign, logged, merlin, own

from rovval import effects
from rovval.blind.cases.flight import fly
from rovval.blind.plant.spec import Planted
from rovval.core.data import Run
from rovval.core.errors import BadInput
from rovval.diagnose import diagnose, pipeline
from rovval.diagnose.decision.finding import Finding, began, may_begin
from rovval.diagnose.decision.posterior import Probabilities
from rovval.diagnose.decision.verdict import decide
from rovval.diagnose.hypotheses.hypothesis import Hypothesis, columns_of
from rovval.diagnose.hypotheses.library import hypotheses
from rovval.diagnose.inference.hypothesis_fit import fit_hypothesis
from rovval.diagnose.inference.laplace import Posterior, laplace_evidence, promised_evidence
from rovval.diagnose.inference.map_fit import healthy_fit, posterior_at
from rovval.diagnose.problem.problem import Problem, corrected_residuals, pose
from rovval.diagnose.residuals.normal_equations import NormalEquations
from rovval.diagnose.residuals.ridge import Prior
from rovval.diagnose.search.forward import Selection
from rovval.diagnose.search.model import Model, ModelPrior, Part
from rovval.diagnose.search.onset import Stretch, evidence_with_onset, moved_onset, onset_cost, windows_from, with_onset
from rovval.diagnose.windows.multiple_shooting import cut
from rovval.diagnose.windows.windows import Windows
from rovval.report.diagnosis.json import document as written
from rovval.report.diagnosis.sentences.sentence import since

BEGINS = 120.0


@pytest.fixture(scope="module")
def logs(tmp_path_factory: pytest.TempPathFactory) -> tuple[Run, Run]:
    """A loss of thrust that begins in mid-log, and the same loss from the first second on."""
    folder, runs = tmp_path_factory.mktemp("since"), []
    for i, onset in enumerate((BEGINS, None)):
        flight = fly(LIBRARY / "merlin.toml", "rich", [Planted("inflow_loss", None, 1.5, onset)], 21, 240.0, 0.02)
        runs.append(logged(flight, folder / f"log{i}.csv"))
    return runs[0], runs[1]


@pytest.mark.slow
def test_what_begins_in_mid_log_is_named_from_there_on(logs: tuple[Run, Run]) -> None:
    found = diagnose([logs[0]], merlin())
    document = written(found)
    assert document["since_s"] == pytest.approx(BEGINS, abs=15.0)
    assert document["causes"][0]["effect"] == "inflow_loss"
    assert document["causes"][0]["onset_s"] == document["since_s"] and document["shrinkage"]["total"] > 0.5
    assert document["sentence"].startswith(since(found)) and since(found)
    told = {row["effect"].partition("[")[0] for part in ("ranking", "not_testable") for row in document[part]}
    assert told == {name for name in effects.names() if effects.load(name).competes}  # those with an onset of their own, too, which only the whole log shows


@pytest.mark.slow
def test_what_is_always_there_has_no_beginning(logs: tuple[Run, Run]) -> None:
    found = diagnose([logs[1]], merlin())
    document = found.document()
    assert document["since_s"] is None and since(found) == "" and [c["effect"] for c in document["causes"]] == ["inflow_loss"]
    assert document["causes"][0]["onset_s"] is None


@pytest.mark.slow
@pytest.mark.parametrize("planted", ["buoyancy_error", "payload_change"])
def test_what_begins_by_itself_is_told_from_what_begins_in_mid_log(tmp_path: Path, planted: str) -> None:
    """A weight from mid-log on, which is a model with an onset, and a payload that is taken up, which has one of its own, compete on the same log: a payload
    has mass, too."""
    [cause] = diagnose([foreign(tmp_path, ((planted, "", 1.5),), 22, 240.0, 0.02, onset=BEGINS)], merlin()).causes
    assert cause.effect == planted
    assert cause.onset_s == pytest.approx(BEGINS, abs=15.0)


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


def answered(onset: float) -> Finding:
    """A pass over the whole log that suspects an onset and names nothing."""
    selection: Any = SimpleNamespace(onset=onset, healthy=None, best=SimpleNamespace(fit=None))
    decision: Any = SimpleNamespace(causes=(), fit=None)
    problem: Any = None
    return Finding(problem, {}, selection, [], (), decision)


@pytest.fixture
def passes(monkeypatch: pytest.MonkeyPatch) -> tuple[Finding, list[tuple[int, list[str]]]]:
    """What a pass over the whole log finds, and (windows, what was left out) of every pass that is asked for; of a part too few windows can be simulated."""
    whole, asked = replace(answered(40.0), untestable={"crossflow_loss": "no typical size of it shows"}), list[tuple[int, list[str]]]()

    def searched(some: tuple[Windows, ...], without: list[str], *_: Any) -> Any:
        asked.append((some[0].count, list(without)))
        if len(asked) > 1:
            raise BadInput("too few windows can be simulated", "")
        return whole

    monkeypatch.setattr(pipeline, "searched", searched)
    monkeypatch.setattr(pipeline, "decided", lambda met: met)
    monkeypatch.setattr(pipeline, "assemble", lambda found, *_: found)
    return whole, asked


def test_a_part_that_cannot_be_simulated_leaves_the_answer_of_the_whole(passes: tuple[Finding, list[tuple[int, list[str]]]]):
    run, (whole, asked) = own((), 5, 100.0), passes
    assert pipeline.diagnose([run], merlin()) is whole  # type: ignore[comparison-overlap]
    (part,), _ = cut([run], merlin(), "fossen", 10.0)
    assert [count for count, _ in asked] == [part.count, int((part.start * part.run.dt >= 40.0).sum())]


def test_what_the_whole_log_does_not_show_is_not_asked_of_a_part(passes: tuple[Finding, list[tuple[int, list[str]]]]):
    """Fewer windows may show a size that the whole log had no use for; it has no prior mass among the models of the whole log."""
    pipeline.diagnose([own((), 5, 100.0)], merlin())
    (_, of_whole), (_, of_part) = passes[1]
    assert "crossflow_loss" not in of_whole and "crossflow_loss" in of_part


@pytest.fixture(scope="module")
def posed(logs: tuple[Run, Run]) -> tuple[Problem, Windows, list[Hypothesis], Posterior]:
    """The log with a loss from mid-log on as an estimation problem: with its windows, the library and the healthy fit."""
    (windows,), _ = cut([logs[0]], merlin(), "fossen", 10.0)
    library, _ = hypotheses((windows,))
    problem = pose((windows,), columns_of(library), 0.05)
    return problem, windows, library, healthy_fit(problem)


def named(library: list[Hypothesis], name: str) -> Hypothesis:
    return next(h for h in library if h.name == name)


@pytest.mark.slow
def test_a_cause_that_never_begins_is_a_healthy_vehicle_with_its_own_tolerance(posed: tuple[Problem, Windows, list[Hypothesis], Posterior]) -> None:
    """A coefficient that the cause takes is as free before it as any other."""
    problem, _, library, alone = posed
    drag = named(library, "linear_drag[surge]")
    always = fit_hypothesis(problem, problem.origin, drag.slots)
    assert set(drag.slots) <= set(problem.tolerance.sd)
    never, throughout = (with_onset(problem, [drag], -1.0, Part(t, problem, always), alone) for t in (1e6, 0.0))
    assert never.evidence + onset_cost(problem) == pytest.approx(laplace_evidence(problem, alone), abs=1.0)
    assert throughout.evidence + onset_cost(problem) == pytest.approx(always.evidence, abs=1.0)


def test_before_its_causes_a_vehicle_is_as_its_calibration_knows_it(posed: tuple[Problem, Windows, list[Hypothesis], Posterior]) -> None:
    """Numbers that a calibration knows only together are known so before one of them is a cause: where all windows are before it, nothing is gained or lost."""
    problem = posed[0]
    thrust, drag = (next(i for i, s in enumerate(problem.plant.slots) if s.key == key) for key in ("rpm_scale.scale", "quadratic_drag[surge].scale"))
    together = Prior(dict(problem.tolerance.sd) | {thrust: 0.3, drag: 0.6}, (thrust, drag), np.array([[1.0, 0.95], [0.95, 1.0]]))
    calibrated = replace(problem, tolerance=together)
    healthy = healthy_fit(calibrated)
    weaker = fit_hypothesis(calibrated, healthy.beta, (thrust,))
    assert evidence_with_onset(calibrated, weaker, 1e6, healthy) == pytest.approx(promised_evidence(calibrated, healthy), abs=0.01)


def test_a_cause_from_some_moment_on_is_weighed_on_every_window(posed: tuple[Problem, Windows, list[Hypothesis], Posterior]) -> None:
    """From before the log on it is the cause itself; from after its end on, a healthy vehicle; at its own beginning it is worth more than all through."""
    problem, windows, library, alone = posed
    loss = named(library, "inflow_loss")
    always = fit_hypothesis(problem, problem.origin, loss.slots)
    throughout, never = (with_onset(problem, [loss], -1.0, Part(t, problem, always), alone) for t in (0.0, 1e6))
    beside, healthy, own = always.posterior.beta, alone.beta.copy(), list(loss.slots)
    healthy[own] = beside[own]
    starts = [posterior_at(problem, beta, always.posterior.columns, always.posterior.effect_count) for beta in (beside, healthy)]  # all else of either fit
    better = max(starts, key=lambda one: promised_evidence(problem, one))
    after = better.beta.copy()
    step = np.where(better.tangent_only, 0.0, better.solve(better.curvature, better.descent))
    for column, moved in zip(better.columns, step, strict=True):  # as far as bounds allow
        after[column] = problem.plant.slots[column].parameter.within(after[column] + moved)
    stepped = posterior_at(problem, after, better.columns, better.effect_count)  # a start gains nothing by its linearisation alone
    assert stepped.cost() < better.cost()
    expected = min(promised_evidence(problem, one) for one in (better, stepped))
    assert throughout.evidence + onset_cost(problem) == pytest.approx(expected, rel=1e-9)
    assert throughout.evidence + onset_cost(problem) == pytest.approx(always.evidence, abs=0.5)
    assert never.evidence + onset_cost(problem) == pytest.approx(laplace_evidence(problem, alone), abs=1.0)
    there = pose((windows_from(windows, BEGINS),), columns_of(library), 0.05)
    begun = with_onset(problem, [loss], -1.0, Part(BEGINS, there, fit_hypothesis(there, always.beta, loss.slots)), alone)
    assert begun.evidence > always.evidence and begun.names == {"inflow_loss"} and begun.log_prior == -1.0
    assert begun.fit is not None and never.fit is not None and throughout.fit is not None
    assert begun.fit.loss.sum() < throughout.fit.loss.sum() < never.fit.loss.sum() == pytest.approx(problem.gap.total.c.sum())
    assert begun.fit.posterior.dynamics_loss().sum() < always.posterior.dynamics_loss().sum()


def test_causes_that_begin_together_are_compared_in_the_part_where_they_act(posed: tuple[Problem, Windows, list[Hypothesis], Posterior]) -> None:
    """That something begins is judged on the whole log, which of two causes it is under the noise model of the windows from there on; that of
    all windows has another opinion."""
    problem, windows, library, alone = posed
    there = pose((windows_from(windows, BEGINS),), columns_of(library), 0.05)
    one, other = (fit_hypothesis(there, there.origin, named(library, name).slots) for name in ("inflow_loss", "quadratic_drag[surge]"))
    loss = with_onset(problem, [named(library, "inflow_loss")], -1.0, Part(BEGINS, there, one), alone)
    drag = with_onset(problem, [named(library, "quadratic_drag[surge]")], -1.0, Part(BEGINS, there, other), alone, loss)
    assert loss.evidence - drag.evidence == pytest.approx(one.evidence - other.evidence) and loss.evidence > drag.evidence
    assert drag.fit is not None and drag.fit.evidence == drag.evidence
    apart = with_onset(problem, [named(library, "quadratic_drag[surge]")], -1.0, Part(BEGINS, there, other), alone)
    assert apart.evidence != pytest.approx(drag.evidence, abs=1.0)


@pytest.mark.parametrize(("verdict", "off_beside", "searched"), [("unknown", False, True), ("explained", False, False), ("explained", True, True)])
def test_the_part_after_an_onset_is_searched_where_the_whole_log_has_no_answer(
    posed: tuple[Problem, Windows, list[Hypothesis], Posterior], verdict: str, off_beside: bool, searched: bool
) -> None:
    """Eighty seconds after the loss began what explains the whole log best cannot begin: that is an answer, or there is none, or none without further numbers
    of the file that are off."""
    problem, _, library, alone = posed
    loss = named(library, "inflow_loss")
    always = fit_hypothesis(problem, problem.origin, loss.slots)
    selection: Any = SimpleNamespace(onset=BEGINS + 80.0, healthy=alone, best=Model((loss,), always, always.evidence, -1.0))
    at_work = frozenset({"inflow_loss"})
    believed = Probabilities({at_work: 0.3, frozenset(): 0.0}, {}, {at_work: 0.6 if off_beside else 0.1}, 0.0, 0.1, 0.0, 0.0)
    decision: Any = SimpleNamespace(verdict=verdict, causes=(loss,), probabilities=believed)
    assert may_begin(Finding(problem, {}, selection, [], (), decision), BEGINS + 80.0) is searched


@pytest.mark.slow
def test_a_change_of_density_from_mid_log_is_told_from_a_weight(tmp_path: Path) -> None:
    """On the whole log they are as good as each other, and a weight was named at 0.97."""
    log = foreign(tmp_path, (("density_gradient", "", -1.428),), 144490247, 300.0, 0.03, mission="survey", onset=107.1)
    found = diagnose([log], merlin()).document()
    assert [c["effect"] for c in found["causes"]] == ["density_gradient"] and found["causes"][0]["probability"] > 0.6
    assert found["since_s"] == pytest.approx(107.1, abs=15.0)


@pytest.mark.slow
def test_a_gyro_s_bias_from_mid_log_has_its_size(tmp_path: Path) -> None:
    """On the whole log it is told as if from the start, with less than half of its size, and needs a file that is off in further numbers beside it; and the
    window in which it begins, with the bias in half of it, looks like a scale as well. The bias walks: its size is its mean from there on, by the same flight
    without it."""
    planted = Planted("gyro_bias", "roll", -2.156, 104.6)
    flights = [fly(LIBRARY / "merlin.toml", "station", some, 1970485373, 300.0, 0.03) for some in ([planted], [])]
    found = diagnose([logged(flights[0], tmp_path / "log.csv")], merlin()).document()
    after = flights[0].time_s > found["since_s"]
    biased, healthy = (flight.measured["AngVelX"][after].mean() for flight in flights)
    assert [c["effect"] for c in found["causes"]] == ["gyro_bias"]
    assert 104.6 <= found["since_s"] <= 104.6 + 15.0
    assert found["causes"][0]["parameters"]["p"]["value"] == pytest.approx(np.deg2rad(biased - healthy), rel=0.05)


@pytest.mark.slow
def test_a_set_that_is_named_of_a_larger_one_begins_when_that_does(posed: tuple[Problem, Windows, list[Hypothesis], Posterior]) -> None:
    """The loss is in every set that was found from its beginning on, and none of what is beside it is likelier at work than not: the loss alone, which was
    not fitted, is named from the same second on."""
    problem, windows, library, alone = posed
    there, prior = pose((windows_from(windows, BEGINS),), columns_of(library), 0.05), ModelPrior.of(library)
    beside = (("added_mass[roll]",), ("inertia_error[roll]", "quadratic_drag[heave]"), ("inertia_error[roll]", "added_mass[heave]", "linear_drag[heave]"))
    found = list[Model]()
    for others, probability in zip(beside, (0.4, 0.3, 0.3), strict=True):
        causes = tuple(named(library, name) for name in ("inflow_loss", *others))
        fit = fit_hypothesis(there, there.origin, tuple(s for h in causes for s in h.slots))
        begun = with_onset(problem, causes, prior.log_mass(causes), Part(BEGINS, there, fit), alone)
        found.append(replace(begun, evidence=2.0 * (np.log(probability) + 100.0 - begun.log_prior)))
    nothing = Model((), None, laplace_evidence(problem, alone), prior.log_mass(()))
    selection = Selection((nothing, *found), found[0], alone, (), (), BEGINS, prior, tuple(library))
    decision = decide(problem, selection, corrected_residuals(problem), ())
    assert [h.name for h in decision.causes] == ["inflow_loss"] and decision.since == BEGINS


def test_an_onset_is_moved_to_where_the_causes_begin(posed: tuple[Problem, Windows, list[Hypothesis], Posterior]) -> None:
    """The fit to the windows from late in the effect on says where it began; one that begins where it does stays, and so does one
    that begins in the window before, which holds it in part."""
    problem, windows, library, alone = posed
    loss = named(library, "inflow_loss")
    there = pose((windows_from(windows, BEGINS + 40.0),), columns_of(library), 0.05)
    late = fit_hypothesis(there, there.origin, loss.slots)
    moved = moved_onset(problem, late, BEGINS + 40.0, alone)
    assert moved == pytest.approx(BEGINS, abs=15.0)
    assert moved_onset(problem, late, moved, alone) == moved
    found: Any = SimpleNamespace(best=Model((loss,), late, late.evidence, -1.0), healthy=alone)
    decision: Any = None
    late_pass, whole = (Finding(posed_there, {}, found, [], (), decision) for posed_there in (there, problem))
    following = float(windows.start[windows.start * windows.run.dt > moved][0] * windows.run.dt)
    assert [began(late_pass, whole, time) for time in (BEGINS + 40.0, following, moved)] == [moved, following, moved]
