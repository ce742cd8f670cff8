"""What a log cannot show, in words: a family of effects that is silent for one reason is one line."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

_NUMBER = re.compile(r"\d+(?:\.\d+)?")


def not_testable(document: Mapping[str, Any]) -> list[tuple[str, str]]:
    """What this log cannot show, and why: a family that is silent for the same reason is one row, its numbers a range.

    ``linear_drag[roll], [yaw]`` beside ``would show with 1.8 to 2.8 standard errors``.
    """
    rows: dict[tuple[str, str], list[tuple[str, str]]] = {}
    for n in document.get("not_testable") or ():
        name, why = str(n["effect"]), str(n.get("why", ""))
        rows.setdefault((name.partition("[")[0], _NUMBER.sub("#", why)), []).append((name, why))
    return [(_family([n for n, _ in group]), _ranges([w for _, w in group])) for group in rows.values()]


def _family(members: Sequence[str]) -> str:
    """The first name whole, of the others only the axis or thruster."""
    return ", ".join([members[0], *(f"[{name.partition('[')[2]}" for name in members[1:])])


def _ranges(reasons: Sequence[str]) -> str:
    """Reasons that differ only in their numbers as one, with the lowest and the highest where they differ."""
    columns = [sorted(set(column), key=float) for column in zip(*(_NUMBER.findall(why) for why in reasons), strict=True)]
    spans = iter([values[0] if len(values) == 1 else f"{values[0]} to {values[-1]}" for values in columns])
    return _NUMBER.sub(lambda _: next(spans), reasons[0])
