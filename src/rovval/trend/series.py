"""What is followed over the dives of a vehicle: the gap on each axis, and the size of each cause that was named, from the rows of the catalogue."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from itertools import groupby
from math import exp
from typing import Any, Literal

import numpy as np

from rovval.core.channels import AXES
from rovval.core.data import Array

Row = Mapping[str, Any]
Of = Literal["gap", "cause"]
UNITS = dict(zip(AXES, ("m/s",) * 3 + ("rad/s",) * 3, strict=True))
COLUMNS = ("pipeline", "vehicle", "run", "log", "current", "date", "dated_by", "method", "stops", *AXES, "causes")  # of the catalogue, that are asked for
SAME_GAP = 0.01  # two gaps that differ by less are one: by so much they differ with the water's density or the digits of a log
FEWEST = 4  # dives on which a cause is named before its size is followed: level, scatter and a change of it leave one to judge by
SAME_SIZE = 1e-3  # the same for a cause's size where no interval is told, as a share of it


@dataclass(frozen=True, slots=True)
class Series:
    """One quantity of one vehicle over its dives, as one pipeline judged them by one method: the newest.

    ``name`` is the axis, or the cause and its parameter; ``values`` (n,) in ``unit`` (SI) at ``dates``. ``other_method`` are the dives that were left
    out since another code, vehicle file or option judged them, ``stopped`` those whose simulation left sane limits, ``dated_by_file`` those of
    which only the file's time is known.
    """

    pipeline: str
    vehicle: str
    of: Of
    name: str
    unit: str
    runs: tuple[str, ...]
    dates: tuple[datetime, ...]
    values: tuple[float, ...]
    least: float
    other_method: int
    stopped: int
    dated_by_file: int

    @property
    def time_s(self) -> Array:
        """(n,) s since the first dive."""
        return np.array([(date - self.dates[0]).total_seconds() for date in self.dates])

    @property
    def level(self) -> Array:
        """(n,) what changes are looked for in: gaps as logarithms, since they vary by factors; sizes of causes as they are."""
        return np.log(self.values) if self.of == "gap" else np.array(self.values)

    def value_of(self, level: float) -> float:
        """Back from a level."""
        return exp(level) if self.of == "gap" else level


def all_series(rows: Iterable[Row]) -> list[Series]:
    """The series of every vehicle and pipeline; logs whose content was replaced are left out."""

    def owner(row: Row) -> tuple[str, str]:
        return row["pipeline"], row["vehicle"]

    kept = sorted((row for row in rows if row["current"] and row["date"] is not None), key=lambda r: (owner(r), r["date"], r["log"]))
    return [series for _, group in groupby(kept, key=owner) for series in _of_one(list(group))]


def _of_one(rows: Sequence[Row]) -> list[Series]:
    method = rows[-1]["method"]
    usable = [row for row in rows if row["method"] == method and not row["stops"]]
    facts = {
        "pipeline": rows[-1]["pipeline"], "vehicle": rows[-1]["vehicle"], "other_method": sum(row["method"] != method for row in rows),
        "stopped": sum(row["method"] == method and bool(row["stops"]) for row in rows),
    }  # fmt: skip
    gaps = [_series("gap", axis, UNITS[axis], [(row, row[axis]) for row in usable if row[axis]], SAME_GAP, facts) for axis in AXES]
    sizes = {name: found for name, found in _sizes(usable).items() if len(found) >= FEWEST}
    return [series for series in gaps if series.runs] + [_cause(name, found, facts) for name, found in sizes.items()]


def _sizes(rows: Sequence[Row]) -> dict[str, list[tuple[Row, Mapping[str, Any]]]]:
    """The sizes of every parameter of every cause by its name, each with its row."""
    found: dict[str, list[tuple[Row, Mapping[str, Any]]]] = {}
    for row in rows:
        for cause in row["causes"] or ():
            for parameter in cause["parameters"] or ():
                if parameter["value"] is not None:
                    found.setdefault(f"{cause['effect']} {parameter['name']}", []).append((row, parameter))
    return found


def _cause(name: str, found: Sequence[tuple[Row, Mapping[str, Any]]], facts: Mapping[str, Any]) -> Series:
    """A cause's size; it is not known better than by its own interval of 90 %."""
    errors = [(p["high"] - p["low"]) / (2 * 1.6449) for _, p in found if p["high"] is not None and p["low"] is not None]
    typical = float(np.median([abs(p["value"]) for _, p in found]))
    least = float(np.median(errors)) if errors else 0.0
    return _series("cause", name, found[-1][1]["unit"] or "1", [(row, p["value"]) for row, p in found], max(least, SAME_SIZE * typical, 1e-12), facts)


def _series(of: Of, name: str, unit: str, found: Sequence[tuple[Row, float]], least: float, facts: Mapping[str, Any]) -> Series:
    return Series(
        of=of, name=name, unit=unit, least=least, runs=tuple(row["run"] for row, _ in found), values=tuple(value for _, value in found),
        dates=tuple(row["date"].astimezone(UTC) for row, _ in found), dated_by_file=sum(row["dated_by"] != "stamps" for row, _ in found), **facts,
    )  # fmt: skip
