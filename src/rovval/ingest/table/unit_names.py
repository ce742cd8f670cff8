"""Units as headers and logs write them, and the line of units that some exports have below their header."""

from __future__ import annotations

import re
from collections.abc import Sequence

from rovval.core.units import SI
from rovval.ingest.table.text_table import ELEMENT, stated_unit

SPELLINGS = {
    "°": "deg", "degrees": "deg", "degree": "deg", "°/s": "deg/s", "dps": "deg/s", "m/s^2": "m/s2", "m/s²": "m/s2",
    "1/min": "rpm", "r/min": "rpm", "metre": "m", "meter": "m", "metres": "m", "meters": "m", "mps": "m/s", "v": "V", "knots": "knot",
    "radps": "rad/s", "radians": "rad", "kn": "knot", "kt": "knot", "sec": "s", "seconds": "s", "%": "percent",
}  # fmt: skip
NUMBER = re.compile(r"[+-]?(\d+([.,]\d*)?|[.,]\d+)([eE][+-]?\d+)?")


def unit_of(said: str) -> str:
    """A unit in the words of a profile; one that is not known stays as it is said."""
    return said if said in SI else SPELLINGS.get(said.casefold(), said)


def are_units(cells: Sequence[str]) -> bool:
    """Whether the cells of a line below a header are units: none is a number, and most of those that are written are units that are known."""
    written = [said for c in cells if (said := _said(c))]
    known = [c for c in written if unit_of(c) in SI]
    return len(known) > 0.5 * len(written) and not any(NUMBER.fullmatch(c) for c in written)


def with_units(names: Sequence[str], units: Sequence[str]) -> tuple[str, ...]:
    """The names of a header with the units of the line below it in brackets, where they state none themselves and are no element of an array."""
    said = [_said(u) for u in units]
    return tuple(f"{n} [{u}]" if n and u and stated_unit(n) is None and not ELEMENT.search(n) else n for n, u in zip(names, said, strict=True))


def _said(cell: str) -> str:
    """What a cell says of a unit; "" where it says that there is none."""
    return cell.strip("[]()- ")
