"""Questions to `diagnose` whose answer is known, asked in two processes, and the tables in which their answers stand."""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from rovval import vehicle
from rovval.comparison import compare
from rovval.core.data import Run
from rovval.diagnose import diagnose
from rovval.simulation import simulate
from rovval.storage.archive import open_run

PROCESSES = 2
TENTH = 0.1  # of the squared gap: a piece that closes less when it is put back is not asked for
WRONG = 0.1  # of the names that are printed at a probability of 0.9 or above: at most as many
BINS = ((0.9, 1.01), (0.5, 0.9), (0.0, 0.5))  # of printed probabilities


@dataclass(frozen=True, slots=True)
class Question:
    """What was done (``piece``) to ``logs`` or to a ``vehicle`` (TOML); a first cause among ``right`` is right, with none of these any cause is wrong.

    ``read`` reads a log and damages it; ``whole`` is the vehicle (TOML) before, where it is known."""

    piece: str
    logs: tuple[Path, ...]
    vehicle: str
    right: tuple[str, ...]
    read: Callable[[Path], Run] = open_run
    whole: str = ""

    @property
    def log(self) -> str:
        return " ".join(path.name.partition(".")[0] for path in self.logs)


@dataclass(frozen=True, slots=True)
class Answer:
    """What `diagnose` named: ``causes`` and their printed probabilities, the ``document``, and the share of the squared gap that is ``closed`` when what
    was done is undone (None: the vehicle before is not known)."""

    question: Question
    causes: tuple[tuple[str, float], ...]
    document: Mapping[str, Any]
    closed: float | None

    @property
    def mark(self) -> str:
        """``right``, ``wrong``, ``silent`` where something was to be named and is not, ``group`` where the right name is what the first cannot be
        told from."""
        right = set(self.question.right)
        if not self.causes:
            return "silent" if right else "right"
        if self.causes[0][0] in right:
            return "right"
        return "group" if right & set(self.document["causes"][0]["group"]) else "wrong"

    @property
    def asked(self) -> bool:
        """Whether something is to be named that closes a tenth of the gap when it is put back."""
        return bool(self.question.right) and (self.closed is None or self.closed >= TENTH)

    def __str__(self) -> str:
        said = ", ".join(f"{name} {probability:.2f}" for name, probability in self.causes) or str(self.document["verdict"])
        return f"{self.mark}: {said}" + ("" if self.closed is None else f" ({self.closed:.0%})")


@cache
def ask(questions: tuple[Question, ...]) -> tuple[Answer, ...]:
    """The answers, in order; two at a time, since each takes half a minute."""
    context = multiprocessing.get_context("forkserver")
    with ProcessPoolExecutor(PROCESSES, context) as pool:
        return tuple(pool.map(_answer, questions))


def _answer(question: Question) -> Answer:
    runs, asked = [question.read(path) for path in question.logs], vehicle.parse(question.vehicle, question.piece)
    document = diagnose(runs, asked).document()
    causes = tuple((cause["effect"], float(cause["probability"])) for cause in document["causes"])
    return Answer(question, causes, document, _closed(question, document) if question.whole and question.right else None)


def _closed(question: Question, document: Mapping[str, Any]) -> float:
    """Share of the squared gap that goes when what was done is undone, axes weighted as the diagnosis weights them."""
    [path] = question.logs
    after, before = (
        compare(run, simulate(run, vehicle.parse(toml, "gap"), window_s=document["window_s"])).windowed
        for run, toml in ((question.read(path), question.vehicle), (open_run(path), question.whole))
    )
    axes = {axis: gap["share"] for axis, gap in document["gap"]["axes"].items() if axis in after}
    return float(sum(share * (1.0 - (before[axis].rmse / after[axis].rmse) ** 2) for axis, share in axes.items()) / sum(axes.values()))


def table(answers: Sequence[Answer]) -> str:
    """Markdown: a row a piece, a column a log; how each was marked, what was named with its probability, and what the piece closes when put back."""
    logs = tuple(dict.fromkeys(one.question.log for one in answers))
    cells = {(one.question.piece, one.question.log): str(one) for one in answers}
    lines = ["| piece | " + " | ".join(logs) + " |", "|---" * (len(logs) + 1) + "|"]
    for piece in dict.fromkeys(one.question.piece for one in answers):
        lines.append(f"| {piece} | " + " | ".join(cells.get((piece, log), "") for log in logs) + " |")
    return "\n".join(lines)


def named_first(answers: Sequence[Answer]) -> tuple[int, int]:
    """How many pieces are named first, and of how many that were to be."""
    asked = [one for one in answers if one.asked]
    return sum(one.mark == "right" for one in asked), len(asked)


def overconfident(answers: Sequence[Answer], least: float = BINS[0][0]) -> tuple[int, int]:
    """How many of the names printed at ``least`` or above are wrong, and of how many; in an answer of several every name counts."""
    said = [name in one.question.right for one in answers for name, p in one.causes if p >= least]
    return said.count(False), len(said)


def confidence(answers: Sequence[Answer]) -> str:
    """Markdown: printed probabilities beside how many of the names were right."""
    lines = ["| printed probability | names | right |", "|---|---|---|"]
    for low, high in BINS:
        said = [name in one.question.right for one in answers for name, probability in one.causes if low <= probability < high]
        lines.append(f"| {low:g} to {min(high, 1.0):g} | {len(said)} | {sum(said)} |")
    return "\n".join(lines)
