"""What begins during a log, of effects without an onset of their own: found where it is, on a plant of another kind, and nowhere else."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from diagnose_case import LIBRARY, merlin, own
from rovval import store
from rovval.blind.log import write_csv
from rovval.blind.plant import fly
from rovval.blind.spec import Planted
from rovval.data import Run
from rovval.diagnose import diagnose
from rovval.diagnose.contest import Prior
from rovval.diagnose.finding import Finding, find
from rovval.diagnose.products import Products
from rovval.diagnose.since import Beginning, _explained, _Part, _worth
from rovval.diagnose.stretches import Stretches, cut_all
from rovval.diagnose.words import since
from rovval.errors import BadInput

BEGINS = 120.0


@pytest.fixture(scope="module")
def logs(tmp_path_factory: pytest.TempPathFactory) -> tuple[Run, Run]:
    """A loss of thrust that begins in mid-log, and the same loss from the first second on."""
    folder, runs = tmp_path_factory.mktemp("since"), []
    for i, onset in enumerate((BEGINS, None)):
        flight = fly(LIBRARY / "merlin.toml", "rich", [Planted("inflow_loss", None, 1.5, onset)], 21, 240.0, 0.02)
        path = folder / f"log{i}.csv"
        write_csv(flight, path)
        runs.append(store.open_run(path, "merlin", folder / f"archive{i}"))
    return runs[0], runs[1]


def test_what_begins_in_mid_log_is_told_from_there_on(logs: tuple[Run, Run]) -> None:
    document = diagnose([logs[0]], merlin()).document
    assert document["since_s"] == pytest.approx(BEGINS, abs=15.0)
    assert [c["effect"] for c in document["causes"]] == ["inflow_loss"]
    assert document["causes"][0]["onset_s"] == document["since_s"] and document["shrinkage"]["total"] > 0.5
    assert document["sentence"].startswith(since(document)) and since(document)


def test_what_is_always_there_has_no_beginning(logs: tuple[Run, Run]) -> None:
    document = diagnose([logs[1]], merlin()).document
    assert document["since_s"] is None and since(document) == "" and [c["effect"] for c in document["causes"]] == ["inflow_loss"]
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
        selection=SimpleNamespace(began=Beginning(40.0, 500.0), rounds=()), judgement=SimpleNamespace(named=(), causes=0.0)
    )
    asked = list[int]()

    def searched(some: tuple[Stretches, ...], *_: Any) -> Any:
        asked.append(some[0].count)
        if len(asked) > 1:
            raise BadInput("too few windows can be simulated", "")
        return whole

    monkeypatch.setattr("rovval.diagnose.finding._searched", searched)
    assert find(parts, (), 0.05, 0, lambda *_: None) is whole
    assert asked == [parts[0].count, int((parts[0].start * parts[0].run.dt >= 40.0).sum())]


@pytest.mark.parametrize(
    ("named", "after", "evidence", "told"),
    [
        ((), "waves", 325.0, True),  # what came first on the whole log, which it did not name
        ((), "waves", 315.0, False),
        ((), "current_shear", 325.0, False),  # something else has to be clearly more
        ((), "current_shear", 365.0, True),
        (("waves",), "waves", 325.0, False),  # the whole log names it
    ],
)
def test_what_follows_a_change_has_to_outdo_what_the_whole_log_shows(
    monkeypatch: pytest.MonkeyPatch, named: tuple[str, ...], after: str, evidence: float, told: bool
):
    parts, _ = cut_all([own((), 5, 100.0)], merlin(), "fossen", 10.0)

    def finding(names: tuple[str, ...], causes: float, began: Beginning | None) -> Finding:
        all_of = tuple(SimpleNamespace(hypothesis=SimpleNamespace(name=name, effect=SimpleNamespace(begins=False))) for name in names)
        selection: Any = SimpleNamespace(began=began, rounds=((("waves", 300.0, 0.3), ("linear_drag[yaw]", 40.0, 0.1)),))
        problem: Any = None
        judgement: Any = SimpleNamespace(named=all_of, causes=causes)
        return Finding(problem, {}, selection, [], judgement)

    found = iter((finding(named, 300.0, Beginning(40.0, 500.0)), finding((after,), evidence, None)))
    monkeypatch.setattr("rovval.diagnose.finding._searched", lambda *_: next(found))
    one = find(parts, (), 0.05, 0, lambda *_: None)
    assert one.since == (40.0 if told else None) and [n.hypothesis.name for n in one.judgement.named] == ([after] if told else list(named))
