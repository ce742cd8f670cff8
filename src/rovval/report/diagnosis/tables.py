"""What was tried and what could not be, as rows that every format prints: steps of the search, and effects that the log cannot show."""

from __future__ import annotations

import re
from collections.abc import Sequence

from rovval.diagnose.result.diagnosis import Candidate, Diagnosis
from rovval.report.common.numbers import per_cent, probability

MOST_CANDIDATES, MOST_RANKED = 8, 16  # of a step of the search, of the screen
WEIGHED = (
    "Each was fitted by re-simulation. Bar: the share by which it reduces the squared gap on held-out windows. Evidence: twice the log Bayes factor."
)
SCREEN = "Score: the share by which an effect reduces the squared gap on held-out windows, linearised"
_NUMBER = re.compile(r"\d+(?:\.\d+)?")


def steps(d: Diagnosis) -> list[tuple[str, tuple[Candidate, ...]]]:
    """Every step of the search that had candidates, with what they were added to."""
    beside = ("on its own", "beside the best of those", "beside the best two")
    return [(beside[min(k, len(beside) - 1)], rows[:MOST_CANDIDATES]) for k, rows in enumerate(d.finalists) if rows]


def screen(d: Diagnosis) -> str:
    """What the scores of the screen are."""
    beside = "" if d.detection is None else f", coefficients free within their tolerances beside it (these alone: {per_cent(d.detection.tolerance_share)})"
    return f"{SCREEN}{beside}; small differences say nothing."


def harm(d: Diagnosis) -> list[str]:
    """Axes that get worse with the causes."""
    return [f"{h.axis}: the squared error grows by {per_cent(h.change)} with the effects found" for h in d.harm]


def not_testable(d: Diagnosis) -> list[tuple[str, str]]:
    """What this log cannot show, and why: a family that is silent for the same reason is one row, its numbers a range.

    ``linear_drag[roll], [yaw]`` beside ``would show with 1.8 to 2.8 standard errors``.
    """
    rows: dict[tuple[str, str], list[tuple[str, str]]] = {}
    for n in d.not_testable:
        rows.setdefault((n.effect.partition("[")[0], _NUMBER.sub("#", n.why)), []).append((n.effect, n.why))
    return [(_family([name for name, _ in group]), _ranges([why for _, why in group])) for group in rows.values()]


def _family(members: Sequence[str]) -> str:
    """The first name whole, of the others only the axis or thruster."""
    return ", ".join([members[0], *(f"[{name.partition('[')[2]}" for name in members[1:])])


def _ranges(reasons: Sequence[str]) -> str:
    """Reasons that differ only in their numbers as one, with the lowest and the highest where they differ."""
    columns = [sorted(set(column), key=float) for column in zip(*(_NUMBER.findall(why) for why in reasons), strict=True)]
    spans = iter([values[0] if len(values) == 1 else f"{values[0]} to {values[-1]}" for values in columns])
    return _NUMBER.sub(lambda _: next(spans), reasons[0])


def models(d: Diagnosis) -> list[str]:
    """How probable each kind of model is that was compared; none in a document of before they were written."""
    if d.probabilities is None:
        return []
    kinds = {
        "causes": "causes of the library", "healthy": "a vehicle as its file has it, within tolerance",
        "miscalibrated_file": "a file that is off in many numbers", "something_else": "something that the library does not hold",
    }  # fmt: skip
    return [f"{kinds[kind]}: {probability(p)}" for kind, p in sorted(d.probabilities.model_dump().items(), key=lambda item: -item[1])]
