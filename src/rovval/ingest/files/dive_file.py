"""A dive file: TOML that names the files which are one dive, each with its profile and its clock."""

from __future__ import annotations

import tomllib
from datetime import datetime
from pathlib import Path

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from rovval.core.errors import BadInput, UsageProblem, all_at_once

NAME = "dive.toml"  # a dive file is called so, or NAME.dive.toml
WILD = "*?["


class DiveLog(BaseModel):
    """A file of a dive, or several that match a pattern, each with the same clock."""

    model_config = ConfigDict(extra="forbid", frozen=True, use_attribute_docstrings=True)

    file: str = Field(min_length=1)
    """Path, relative to the dive file; with * every file that matches: a recording that was split."""
    profile: str = ""
    """A built-in profile, or a TOML file beside the dive file. Without it the one that fits."""
    channels: tuple[str, ...] = ()
    """The channels that are taken from it (`u`; a whole family as `n`). Without it all."""
    offset_s: float | None = None
    """Seconds that are added to its stamps. A clock that counts from a start of its own (since power-on) states it, against the first log's."""
    begins: datetime | None = None
    """The moment of its first sample, with an offset (2026-11-23T10:00:00Z), where the stamps do not say it and those of other logs do."""


class Dive(BaseModel):
    """The files of one dive, and what is true of all of them."""

    model_config = ConfigDict(extra="forbid", frozen=True, use_attribute_docstrings=True)

    log: tuple[DiveLog, ...] = Field(min_length=1)
    """`[[log]]`, once a file."""
    vehicle: str = ""
    """The vehicle, where the profiles name none or several."""
    from_s: float | None = Field(default=None, ge=0.0)
    to_s: float | None = Field(default=None, gt=0.0)
    """The stretch that is taken of the dive, s since its first sample: what --from and --to are to a command, for every use of it."""


def is_dive(path: Path) -> bool:
    """Whether a path is a dive file, by its name."""
    return path.name == NAME or path.name.endswith(f".{NAME}")


def load_dive(path: Path) -> Dive:
    """A checked dive file. Raises `UsageProblem` with every problem, `BadInput` where it cannot be read."""
    try:
        dive = Dive.model_validate(tomllib.loads(path.read_text(encoding="utf-8")))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise UsageProblem(f"dive file {path}: not readable as TOML: {error}", _HINT) from None
    except OSError as error:
        raise BadInput(f"{path}: cannot be read: {error.strerror}", "check its permissions") from None
    except ValidationError as error:
        problems = [f"{'.'.join(map(str, e['loc']))}: {e['msg']}" for e in error.errors()]
        raise UsageProblem(all_at_once(problems, f"dive file {path}"), _HINT) from None
    if dive.from_s is not None and dive.to_s is not None and dive.to_s <= dive.from_s:
        raise UsageProblem(f"dive file {path}: to_s = {dive.to_s:g} is not after from_s = {dive.from_s:g}", "give both in s since the dive's start")
    if plain := [log.file for log in dive.log if log.begins is not None and log.begins.tzinfo is None]:
        raise UsageProblem(f"dive file {path}: begins of {', '.join(plain)} states no offset from UTC", "write Z or +02:00 behind it")
    return dive


_HINT = "see docs/formats.md: [[log]] with file, and profile, channels, offset_s, begins as needed"


def parts_of(path: Path, dive: Dive) -> list[tuple[DiveLog, Path]]:
    """Every log of the dive with its file, in order; a pattern's files by name. Raises `BadInput` naming all that are not there."""
    found: list[tuple[DiveLog, Path]] = []
    gone = []
    for log in dive.log:
        wild = any(sign in log.file for sign in WILD)
        files = sorted(path.parent.glob(log.file)) if wild else [path.parent / log.file]
        files = [f for f in files if f.exists() and f != path]
        gone += [] if files else [log.file]
        found += [(log, file) for file in files]
    if gone:
        raise BadInput(all_at_once([f"{name} is not there" for name in gone], f"{path}: logs of the dive"), f"paths count from {path.parent}")
    return found


def files_of_dive(path: Path) -> tuple[Path, ...]:
    """The dive file, its logs (files or folders), and the profiles that lie beside it: what a run of it is made of."""
    try:
        dive = load_dive(path)
        parts = parts_of(path, dive)
    except (BadInput, UsageProblem):
        return (path,)  # whoever reads it says what is wrong
    profiles = [path.parent / log.profile for log in dive.log if log.profile.endswith(".toml")]
    return tuple(dict.fromkeys((path, *(file for _, file in parts), *(p for p in profiles if p.is_file()))))
