"""The table of a batch's runs: which columns it has, and what its numbers are. A column that no run fills is left out."""

from __future__ import annotations

from array import array
from collections.abc import Collection
from dataclasses import dataclass, field
from math import inf
from os.path import commonpath, relpath

from rovval.core.channels import AXES
from rovval.report.batch.row import Row
from rovval.report.common.numbers import listed

TENTH, ENOUGH_RUNS = 0.9, 10  # the largest tenth of a column is bold, where that is at least one of ten


@dataclass(frozen=True, slots=True)
class Column:
    """A column of a field of `Row` by ``name``, or of the gap on ``axis`` in ``unit``, bold from ``large`` on; ``words`` stand to the left."""

    name: str
    title: str
    words: bool = False
    axis: str = ""
    unit: str = ""
    large: float = inf

    @property
    def key(self) -> str:
        """Its name for the script that orders and filters."""
        return self.axis or self.name

    @property
    def heading(self) -> str | tuple[str, str]:
        """The title, with the unit under it where there is one."""
        return (self.title, self.unit) if self.unit else self.title


BEFORE = (  # the columns before and after those of the gap
    Column("run", "run", words=True), Column("state", "", words=True), Column("folder", "folder", words=True),
    Column("vehicle", "vehicle", words=True), Column("length", "length"),
)  # fmt: skip
AFTER = (Column("findings", "findings"), Column("verdict", "verdict and cause", words=True))
FIELDS = ("run", "state", "vehicle", "length", "findings", "verdict", "causes")  # of a row, that may be empty in all of them


@dataclass(slots=True)
class Seen:
    """What the table has to know of all its rows before the first is written: ``gaps`` by axis, in ``units``; the ``parents`` of the logs; which fields
    of `Row` some run ``filled``; whether some log is ``shorter`` than its windows."""

    runs: int = 0
    gaps: dict[str, array[float]] = field(default_factory=dict)
    units: dict[str, str] = field(default_factory=dict)
    windows: set[float] = field(default_factory=set)
    parents: set[str] = field(default_factory=set)
    filled: set[str] = field(default_factory=set)
    shorter: bool = False

    def add(self, row: Row) -> None:
        """One row more."""
        self.runs += 1
        for axis, gap in row.gap.items():
            self.gaps.setdefault(axis, array("d")).append(gap.value)
            self.units.setdefault(axis, gap.unit)
        self.filled |= {name for name in FIELDS if getattr(row, name)}
        self.parents.add(parent(row.log))
        if row.window_s is not None:
            self.windows.add(row.window_s)
            self.shorter |= row.duration_s is not None and row.duration_s < row.window_s

    def columns(self) -> list[Column]:
        """The columns that some run fills, the run itself first."""
        filled = self.filled | ({"folder"} if any(folders(self.parents).values()) else set())
        before, after = ([column for column in some if column.name in filled] for some in (BEFORE, AFTER))
        gaps = [Column("gap", axis, axis=axis, unit=self.units[axis], large=_large(self.gaps[axis])) for axis in AXES if axis in self.gaps]
        return before + gaps + after

    def lead(self) -> str:
        """What the numbers are."""
        if not self.gaps:
            return ""  # a batch that only ingests
        over = f" over windows of {listed(f'{s:g}' for s in sorted(self.windows))} s" if self.windows else ""
        over += " (less in shorter logs)" if self.shorter else ""
        bold = "; the largest tenth of each column in bold" if self.runs >= ENOUGH_RUNS else ""
        less = " Beside a cause: by how much the squared gap shrinks with it." if "causes" in self.filled else ""
        return f"Gap of the simulator on each axis, rms{over}{bold}.{less}"


def folders(parents: Collection[str]) -> dict[str, str]:
    """By the folder that a log lies in, its name below the one that all have in common, "" for that one itself; as it is where some lie on a disk and
    some in a store."""
    if not parents:
        return {}
    try:
        base = commonpath(parents)
    except ValueError:  # of absolute paths and addresses
        return {parent: parent for parent in parents}
    return {parent: relpath(parent, base).removeprefix(".") for parent in parents}


def parent(log: str) -> str:
    """The folder that a log lies in."""
    return log.rpartition("/")[0]


def _large(values: array[float]) -> float:
    known = sorted(values)
    return known[int(TENTH * len(known))] if len(known) >= ENOUGH_RUNS else inf
