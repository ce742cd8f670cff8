"""docs/profiles.md, written out of the model and the examples: ``python -m rovval.ingest.documentation.document > docs/profiles.md``."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from typing import Any, Literal, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from rovval import ingest
from rovval.core.channels import CHANNELS
from rovval.core.units import SI
from rovval.ingest.documentation.examples import Example, examples
from rovval.ingest.profile.model import Clock, Markers, Profile, Source

INTRO = """# Profiles

A profile is one TOML file that says, for one source of logs, which column or topic is which channel, in which unit and frame. Nothing is guessed: a
channel without a unit is refused, an unknown key is refused, and all that is wrong with a profile is said at once.

Written by `python -m rovval.ingest.documentation.document` out of `src/rovval/ingest/profile`; change that.

For a new source:

1. `rovval inspect LOG`: what is in the log, which columns may be its stamps, which built-in profile reads it.
2. `rovval profile propose LOG > my_log.toml`: a profile out of names, units in headers, message types and values. Each guess is marked REVIEW; while the
   line `draft = true` stands, every result says that nobody has reviewed it.
3. Confirm or mend the lines with REVIEW, and delete the line `draft`.
4. `rovval profile check my_log.toml LOG`: the first rows in SI, what matched, what is left over, and what the motion itself says against it.

`rovval list profile` names the built-in ones, `rovval show profile NAME` prints one to copy. Every command that takes a log takes `--profile FILE`.
"""
AXES = """## Axes

Inside, the body is forward-starboard-down, the world north-east-down, everything in SI and radians. A profile says what the log has, as a whole
(`frame`, `world`) and for a single channel where it differs:

| channel | turned by | positive in `fsd` / `ned` |
|---|---|---|
| u, v, w, udot, vdot, wdot | `frame` | ahead, to starboard, down |
| p, q, r | `frame` | roll to starboard, nose up, turn to starboard |
| x, y, z | `world` | north, east, down; in `enu` x is east and y is north |
| phi | (the same in all) | roll to starboard |
| theta | `frame` | nose up; in `flu` nose down |
| psi | `world` | clockwise from north; in `enu` counter-clockwise from east, in `nwu` counter-clockwise from north |
| attitude | `frame` and `world` | the quaternion w, x, y, z that turns vectors of `frame` into `world` |
| u, v, w with `frame = "world"` | `world`, then the attitude | along north, east, down |
"""


def text() -> str:
    """The page."""
    keys = ((Profile, "a profile"), (Clock, "`[time]`"), (Source, "a channel"), (Markers, "`[markers]`"))
    parts = [INTRO, *(_keys(model, f"## Keys of {of}") for model, of in keys), _channels(), AXES]
    parts += [_units(), _formats(), "## Worked examples\n", *(_example(i, e) for i, e in enumerate(examples(), 1))]
    return "\n".join(parts)


def _keys(model: type[BaseModel], title: str) -> str:
    lines = [title, "", _first_line(model), "", "| key | takes | default | meaning |", "|---|---|---|---|"]
    for name, info in model.model_fields.items():
        default = "required" if info.is_required() else _shown(info.default)
        lines.append(f"| `{name}` | {_type(info)} | {default} | {' '.join((info.description or '').split())} |".replace("|  |", "| |"))
    return "\n".join(lines) + "\n"


def _first_line(model: type[BaseModel]) -> str:
    return " ".join((model.__doc__ or "").split()).replace("``", "`")


def _shown(value: Any) -> str:
    if value is None or value == () or value == {} or value == "":
        return ""
    return f"`{str(value).lower() if isinstance(value, bool) else value}`"


def _type(info: FieldInfo) -> str:
    """A type in words."""
    return ", or ".join(dict.fromkeys(_words(info.annotation)))


def _words(kind: Any) -> Iterator[str]:
    if get_origin(kind) is Literal:
        yield ", ".join(f"`{v}`" for v in get_args(kind))
    elif get_origin(kind) is dict or (isinstance(kind, type) and issubclass(kind, BaseModel)):
        yield "a table"
    elif get_origin(kind) is tuple:
        yield "list of numbers" if float in get_args(kind) else "list of texts"
    elif kind in (str, float, bool):
        yield {str: "text", float: "number", bool: "`true`, `false`"}[kind]
    elif kind is not type(None):
        for part in get_args(kind):
            if not isinstance(part, FieldInfo):
                yield from _words(part)


def _channels() -> str:
    families_said = "A family has members: `n:HFP` is the speed of thruster HFP, `stick:surge` the pilot's command ahead."
    lines = ["## Channels", "", f"{families_said} `attitude` stands for phi, theta and psi.", ""]
    lines += ["| channel | SI unit | meaning | to 10 Hz by | bridges up to | refused beyond |", "|---|---|---|---|---|---|"]
    families = {"n", "n_cmd", "pwm", "stick"}
    for c in CHANNELS.values():
        name = f"{c.name}:{'AXIS' if c.name == 'stick' else 'THRUSTER'}" if c.name in families else c.name
        lines.append(f"| `{name}` | {c.unit} | {c.meaning} | {c.resampling} | {c.longest_gap_s:g} s | {c.low:g} to {c.high:g} |")
    return "\n".join(lines) + "\n"


def _units() -> str:
    names = ", ".join(f"`{u}`" for u in SI)
    return f"## Units\n\n{names}; `quaternion` for `attitude`. `degree_latitude` is latitude or longitude in degrees, `radps_shaft` a shaft speed in rad/s.\n"


def _formats() -> str:
    lines = ["## Formats", "", "| `format` | files | what |", "|---|---|---|"]
    for name in ingest.readers():
        module = ingest.reader(name)
        files = ", ".join(s or "folders" for s in module.SUFFIXES)
        said = " ".join((module.__doc__ or "").split("\n\n")[0].split())
        lines.append(f"| `{name}` | {files} | {said} |")
    return "\n".join(lines) + "\n"


def _example(number: int, e: Example) -> str:
    out = [f"{name} = {', '.join(f'{v:g}' for v in values)}, ..." for name, values in e.comes_out.items()]
    out += [f"the first stamp is {e.t0.replace('T', ' ').replace('+00:00', ' UTC')}"] if e.t0 else []
    return (
        f"### {number}. {e.title}\n\n{e.says}\n\n`{e.file}`:\n\n```\n{e.log.strip()}\n```\n\nThe profile:\n\n```toml\n{e.profile.strip()}\n```\n\n"
        "What comes out, in SI:\n\n```\n" + "\n".join(out) + "\n```\n"
    )


if __name__ == "__main__":
    sys.stdout.write(text())
