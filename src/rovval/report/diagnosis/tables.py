"""What was tried and what could not be, as rows that every format prints: steps of the search, and effects that the log cannot show."""

from __future__ import annotations

import re
from collections.abc import Sequence

from rovval.diagnose.result.diagnosis import Candidate, Diagnosis
from rovval.report.common.numbers import per_cent
from rovval.report.diagnosis.sentences.plain import falls

MOST_CANDIDATES, MOST_RANKED = 8, 16  # of a step of the search, of the screen
WEIGHED = (
    "Each effect was simulated with the values that suit this log best. Error: what is left of it (rms) on data not used for the fit. Evidence: how much more "
    "likely the log is with the effect than without, as twice the natural logarithm of the ratio; above 10 is very strong."
)
SCREEN = "A first look at all effects, by a straight-line approximation. Score: the share of the squared error that an effect would take away"
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
    return [f"{h.axis}: with the effects found, the error {falls(-h.change)}" for h in d.harm]


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


def models(d: Diagnosis) -> list[tuple[str, float]]:
    """How probable each kind of model is that was compared, the most probable first; none in a document of before they were written."""
    if d.probabilities is None:
        return []
    kinds = {
        "causes": "one or more effects of the library", "healthy": "nothing: the vehicle is as its file has it, each number within its tolerance",
        "miscalibrated_file": "a vehicle file that is off in many numbers at once", "something_else": "something that the library does not hold",
        "not_found": "an effect of the library that was not found, or has other equations here",
    }  # fmt: skip
    known = {kind: p for kind, p in d.probabilities.model_dump().items() if p or kind != "not_found"}  # a document of before it was told has none
    return [(kinds[kind], p) for kind, p in sorted(known.items(), key=lambda item: -item[1])]
