"""The worked examples of docs/profiles.md, one file each: a few lines of a log, the profile, and what comes out."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path

FOLDER = Path(__file__).parent / "examples"


@dataclass(frozen=True, slots=True)
class Example:
    """``log`` is the text of ``file``, of a bag one message a line (topic, type, stamp, fields); ``comes_out``: channel -> its values in SI; ``t0`` the
    moment of the first stamp and ``t`` the stamps since it (s), where the example is about them."""

    title: str
    says: str
    file: str
    log: str
    profile: str
    comes_out: dict[str, list[float]]
    t0: str = ""
    t: tuple[float, ...] = ()


def examples() -> tuple[Example, ...]:
    """All examples, in the order of their files."""
    return tuple(_example(path) for path in sorted(FOLDER.glob("*.toml")))


def _example(path: Path) -> Example:
    table = tomllib.loads(path.read_text(encoding="utf-8"))
    return Example(**table | {"t": tuple(table.get("t", ())), "says": " ".join(table["says"].split())})
