"""The marks of a blind check in words: which are shares, what the columns are called, a mark with its interval."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from rovval.blind.scoring import tables
from rovval.core.counts import counted
from rovval.report.common.numbers import interval, number, per_cents

Number = Mapping[str, Any]  # value, low, high and n of a mark, as the score has them

COLUMNS = {  # mark -> heading
    "top_1": "top-1", "right_when_one_named": "one named", "group_hit": "group", "truth_named": "named", "all_found": "all named",
    "group_size": "size", "errors": "errors", "detected": "found", "blamed": "blamed", "said_unknown": "unknown",
    "axis": "axis", "of_oracle": "/oracle", "cpu_s": "CPU s",
}  # fmt: skip
LABELS = {
    **tables.SHARES,
    **tables.MEANS,
    **tables.MEDIANS,
    "parameter_error": "relative error of parameters",
    "coverage_90": "90 % intervals that hold the truth",
}
PERCENT = {*tables.SHARES, "coverage_90", "share_found"}


@dataclass(frozen=True, slots=True)
class Mark:
    """A mark as it is printed: its ``value``, its 90 % ``interval`` ("" for none) and the ``n`` logs that it is about."""

    value: str
    interval: str
    n: int


def mark(name: str, number_: Number | None) -> Mark | None:
    """The mark ``name`` as it is printed; None where it was not scored."""
    if number_ is None or number_["value"] is None:
        return None
    low, high = number_["low"], number_["high"]
    if name in PERCENT:
        return Mark(f"{100 * number_['value']:.0f} %", per_cents(low, high).removesuffix(" %"), number_["n"])
    return Mark(number(number_["value"], 2), interval(low, high, digits=2), number_["n"])


def short(name: str, number_: Number | None) -> str:
    """The value alone: 83 %, 1.2; "" where there is none."""
    found = mark(name, number_)
    return found.value if found else ""


def long(name: str, number_: Number | None) -> str:
    """The value with its interval: 83 % [69, 91]."""
    found = mark(name, number_)
    return f"{found.value} {found.interval}" if found else "none"


def title(result: Mapping[str, Any]) -> str:
    """What was scored."""
    return f"Blind check: {result['vehicle']}, seed {result['seed']}, {counted(len(result['logs']), 'log')}, engine {result['engine']}"
