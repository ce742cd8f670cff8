"""Shell completion out of file names alone: nothing is parsed or imported while the user waits for the tab key."""

from __future__ import annotations

import os
from pathlib import Path

PACKAGE = Path(__file__).parent.parent
KINDS = ("vehicle", "platform", "effect", "profile", "metric", "run")
_PLACES = {"vehicle": ("vehicle/library", ".toml"), "profile": ("ingest/profiles", ".toml")}
_CODE = {"platform": "plant/platforms", "effect": "effects/library", "metric": "comparison/metrics"}


def known(kind: str, archive: Path = Path("archive")) -> list[str]:
    """Names of one kind, as `rovval list` has them."""
    if kind == "run":
        return sorted(p.name for p in archive.glob("*") if p.is_dir() and not p.name.startswith(".") and p.name != "catalogue")
    if kind in _CODE:
        return sorted(p.stem for p in (PACKAGE / _CODE[kind]).glob("*.py") if defines_one(p))
    folder, suffix = _PLACES[kind]
    return sorted(p.stem for p in (PACKAGE / folder).glob(f"*{suffix}"))


def defines_one(path: Path) -> bool:
    """Whether a file of a plug-in folder is a plug-in: helpers begin with an underscore."""
    return not path.name.startswith("_")


def vehicles(incomplete: str) -> list[str]:
    """Library vehicles, and TOML files for a vehicle of one's own."""
    return _starting(known("vehicle"), incomplete) + _paths(incomplete, ".toml")


def profiles(incomplete: str) -> list[str]:
    """Profiles that come with rovval, and TOML files."""
    return _starting(known("profile"), incomplete) + _paths(incomplete, ".toml")


def missions(incomplete: str) -> list[str]:
    """Missions that come with rovval, TOML files, and CSV files of thruster speeds."""
    library = sorted(p.stem for p in (PACKAGE / "fly/missions").glob("*.toml"))
    return _starting(library, incomplete) + sorted(_paths(incomplete, ".toml") + _paths(incomplete, ".csv"))


def yaml_files(incomplete: str) -> list[str]:
    """YAML files."""
    return sorted(_paths(incomplete, ".yaml") + _paths(incomplete, ".yml"))


def effects(incomplete: str) -> list[str]:
    """Effect names; a parameter follows behind a colon."""
    return _starting(known("effect"), incomplete)


def sources(incomplete: str) -> list[str]:
    """Run ids of ./archive, and files."""
    return _starting(known("run"), incomplete) + _paths(incomplete)


def named(kind: str, incomplete: str) -> list[str]:
    """Names of the kind that was typed before, for `rovval show KIND NAME`."""
    return _starting(known(kind), incomplete) if kind in KINDS else []


def _starting(names: list[str], incomplete: str) -> list[str]:
    return [n for n in names if n.startswith(incomplete)]


def _paths(incomplete: str, suffix: str = "") -> list[str]:
    folder, _, begin = incomplete.rpartition("/")
    base = Path(folder or ("/" if incomplete.startswith("/") else "."))
    if not base.is_dir():
        return []
    prefix = f"{folder}/" if "/" in incomplete else ""
    with os.scandir(base) as entries:
        found = [(e.name, e.is_dir()) for e in entries if e.name.startswith(begin) and not e.name.startswith(".")]
    return sorted(prefix + name + ("/" if is_dir else "") for name, is_dir in found if is_dir or name.endswith(suffix))
