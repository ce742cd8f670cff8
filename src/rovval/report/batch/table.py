"""The table of a batch's runs: which columns it has, and what its numbers are. A column that no run fills is left out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
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


def columns(rows: Sequence[Row]) -> list[Column]:
    """The columns that some run fills, the run itself first."""
    possible = [
        Column("run", "run", words=True),
        Column("state", "", words=True),
        Column("folder", "folder", words=True),
        Column("vehicle", "vehicle", words=True),
        Column("length", "length"),
        *(_gap(axis, rows) for axis in AXES if any(axis in r.gap for r in rows)),
        Column("findings", "findings"),
        Column("verdict", "verdict and cause", words=True),
    ]
    return [c for c in possible if c.axis or any(getattr(r, c.name) for r in rows)]


def lead(rows: Sequence[Row]) -> str:
    """What the numbers are."""
    if not any(r.gap for r in rows):
        return ""  # a batch that only ingests
    windows = sorted({r.window_s for r in rows if r.window_s is not None})
    over = f" over windows of {listed(f'{s:g}' for s in windows)} s" if windows else ""
    over += " (less in shorter logs)" if any(r.window_s and r.duration_s is not None and r.duration_s < r.window_s for r in rows) else ""
    bold = "; the largest tenth of each column in bold" if len(rows) >= ENOUGH_RUNS else ""
    less = " Beside a cause: by how much the squared gap shrinks with it." if any(r.causes for r in rows) else ""
    return f"Gap of the simulator on each axis, rms{over}{bold}.{less}"


def folders(logs: Sequence[str]) -> list[str]:
    """The folder of each log below the one that all have in common, "" for that one itself; as it is where some lie on a disk and some in a store."""
    if not logs:
        return []
    parents = [log.rpartition("/")[0] for log in logs]
    distinct = set(parents)
    try:
        base = commonpath(distinct)
    except ValueError:  # of absolute paths and addresses
        return parents
    below = {parent: relpath(parent, base).removeprefix(".") for parent in distinct}
    return [below[parent] for parent in parents]


def _gap(axis: str, rows: Sequence[Row]) -> Column:
    gaps = [r.gap[axis] for r in rows if axis in r.gap]
    known = sorted(g.value for g in gaps)
    return Column("gap", axis, axis=axis, unit=gaps[0].unit, large=known[int(TENTH * len(known))] if len(known) >= ENOUGH_RUNS else inf)
