"""A profile: one TOML file that says, for one source of logs, which column or topic is which channel, in which unit and frame.

Nothing is guessed: a mapped channel without unit is refused by name. Keys of `[channels]` are names of `rovval.core.channels`;
`"n:*" = {column = "*_PV", unit = "rpm"}` maps every column that fits the pattern, and `attitude` with the unit `quaternion`
stands for the three Euler angles. docs/profiles.md has the whole language; `model` is where it is defined.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from rovval.core.did_you_mean import suggestion
from rovval.core.errors import UsageProblem, all_at_once
from rovval.ingest.profile.model import ARDUSUB_FRAMES, ATTITUDE, GEODETIC, WORLD_VELOCITY, Clock, Profile, Source
from rovval.ingest.profile.problems import problems

__all__ = ["ARDUSUB_FRAMES", "ATTITUDE", "FOLDER", "GEODETIC", "WORLD_VELOCITY", "Clock", "Profile", "Source", "load_profile", "parse_profile", "profiles"]

FOLDER = Path(__file__).parent.parent / "profiles"


def profiles() -> tuple[str, ...]:
    """Names of the built-in profiles."""
    return tuple(sorted(path.stem for path in FOLDER.glob("*.toml")))


def load_profile(name_or_path: str | Path) -> Profile:
    """A built-in profile by name, or a user's by path; refuses with every problem at once (`UsageProblem`)."""
    built_in = FOLDER / f"{name_or_path}.toml"
    path = built_in if built_in.parent == FOLDER and built_in.is_file() else Path(name_or_path)
    try:
        table = tomllib.loads(path.read_text(encoding="utf-8"))
    except (FileNotFoundError, IsADirectoryError):
        hint = f"{suggestion(str(name_or_path), profiles(), '`rovval list profile`')}, or give a path to a TOML file"
        raise UsageProblem(f"unknown profile {str(name_or_path)!r}", hint) from None
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise UsageProblem(f"profile {path}: not readable as TOML: {error}") from None
    return parse_profile(table, str(path)).beside(path.parent)


def parse_profile(table: Mapping[str, Any], where: str) -> Profile:
    """A checked profile from TOML's tables; ``where`` names it in messages. Raises `UsageProblem` with every problem."""
    try:
        profile = Profile.model_validate(dict(table))
    except ValidationError as error:
        raise UsageProblem(all_at_once([_say(e) for e in error.errors()], f"profile {where}"), _HINT) from None
    if found := problems(profile):
        raise UsageProblem(all_at_once(found, f"profile {where}"), _HINT)
    return profile


_HINT = "docs/profiles.md has the language with examples; `rovval profile propose LOG` writes a profile to begin with"


def _say(error: Any) -> str:
    place = [str(part) for part in error["loc"]]
    if place[:1] == ["channels"] and place[2:] == ["unit"]:
        return f"channel {place[1]!r}: states no unit; nothing is guessed"
    return f"{'.'.join(place)}: {error['msg']}" + (f" (got {error['input']!r})" if error["type"] != "missing" else "")
