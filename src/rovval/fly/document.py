"""docs/missions.md, written out of the mission file's own model: ``python -m rovval.fly.document > docs/missions.md``."""

from __future__ import annotations

import sys
from typing import Any

from pydantic import BaseModel
from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined

from rovval.fly import mission
from rovval.fly.mission import Control, Gains, Hold, Limits, Mission, Protocol, Sensor, Sensors, Speeds, Start, Water, WayPoints

HEAD = """# Missions

What `rovval fly MISSION.toml` reads. Written by `python -m rovval.fly.document` out of `src/rovval/fly/mission.py`; change that.

A mission is a vehicle, a start, and legs that follow one another: planned thruster speeds, the movement protocol, each thruster alone, set-points for the
autopilot, way points. Units stand in the names; depth is positive down, heading from north over east. A misspelt key is refused, all problems at once.

    rovval fly survey --dry-run                    its timeline, and what it would exceed; flies nothing
    rovval fly survey --out archive/survey         flies it; the run is a log like any other
    rovval compare archive/survey                  the simulator beside its own flight: zero, but for rounding and what the filter has wrong
    rovval fly steps --vehicle minerva --draws 1000 --effect current_constant:east=0.2
    rovval fly speeds.csv --vehicle merlin         planned thruster speeds alone: t_s and the rpm of each thruster, as in a leg of kind "speeds"
    rovval fly thrusters_singly --noise 0.3        each thruster alone: the log that shows each thruster's loss and direction
    rovval fit archive/thrusters_singly-merlin-fossen --parameters 'thruster_degraded,thruster_misaligned[HFS]' --out tuned.toml

How it flies: the platform (`--model`) moves on 0.1 s at a time, thrusters turning linearly between samples. With a `[sensors]` table instruments measure
the true motion, with noise, bias, delay and drop-outs, and an INS-like Kalman filter closes the loop and is what the run holds; without it, or with
`--noise 0`, the true state does. Controllers take their gains from the vehicle's own mass and drag by pole placement (Fossen 2011, 12.2; Skogestad 2003
for speeds), the thrusters their speeds from the pseudo-inverse of the allocation matrix; where thrust is short, depth, heading, roll and pitch come before
speed. `--draws N` flies N vehicles more, their coefficients drawn within the tolerances of a healthy file (docs/effects.md).

Of thrusters that turn alone, `rovval fit` finds losses of 0.25 and 0.15 within their intervals with the sensors as they are; that a thruster is turned by
7 degrees it tells from a loss with a third of their noise (`--noise 0.3`), and says of the whole of it that these logs do not tell the two apart.

The surface takes buoyancy and nothing else, the bottom is flat and acts at the middle of the hull: no thruster draws air, no hull capsizes on a stone.
"""
TABLES: tuple[tuple[str, type[BaseModel]], ...] = (
    ("The file", Mission), ("[start]", Start), ("[water]", Water), ("[limits]", Limits), ("[control]", Control), ("[control.AXIS]", Gains),
    ("[sensors]", Sensors), ("[sensors.NAME]", Sensor), ('[[leg]] kind = "speeds"', Speeds), ('[[leg]] kind = "protocol"', Protocol),
    ('[[leg]] kind = "singly"', mission.Singly), ('[[leg]] kind = "hold"', Hold), ('[[leg]] kind = "way_points"', WayPoints),
)  # fmt: skip
HIDDEN = ("folder", "kind")


def text() -> str:
    """The whole document, Markdown."""
    parts = [HEAD.rstrip("\n"), *(_section(title, model) for title, model in TABLES), "## Examples that come with rovval"]
    parts += [f"### {name}\n\n```toml\n{(mission.FOLDER / f'{name}.toml').read_text(encoding='utf-8').rstrip()}\n```" for name in mission.names()]
    return "\n\n".join(parts) + "\n"


def _section(title: str, model: type[BaseModel]) -> str:
    """One table of the file."""
    rows = [f"| `{name}` | {_default(field)} | {_allowed(model, name)} | {field.description or ''} |" for name, field in model.model_fields.items()
            if name not in HIDDEN]  # fmt: skip
    about = " ".join((model.__doc__ or "").split())
    return "\n".join([f"## {title}", "", about, "", "| key | default | allowed | meaning |", "|---|---|---|---|", *rows])


def _default(field: FieldInfo) -> str:
    """What stands for a key that the file leaves out."""
    value: Any = field.default
    if value is PydanticUndefined:
        return "needed"
    if isinstance(value, Sensor):
        given = value.model_dump(exclude_defaults=True)
        return ", ".join(f"{k} {v:g}" for k, v in given.items())
    if isinstance(value, BaseModel) or value in (None, (), ""):
        return "none" if not isinstance(value, BaseModel) else "as below"
    if isinstance(value, bool):
        return str(value).lower()
    return ", ".join(value) if isinstance(value, tuple) else f"{value}"


def _allowed(model: type[BaseModel], name: str) -> str:
    """The range of a number, or the words of a choice, as the model's JSON schema has them."""
    schema: dict[str, Any] = model.model_json_schema()["properties"][name]
    options = [o for o in schema.get("anyOf", [schema]) if o.get("type") != "null"]
    words = []
    for option in options:
        inner = option.get("items", option) if option.get("type") == "array" else option
        words += [", ".join(inner["enum"])] if "enum" in inner else []
        signs = (("exclusiveMinimum", "> {:g}"), ("minimum", ">= {:g}"), ("exclusiveMaximum", "< {:g}"), ("maximum", "<= {:g}"))
        words += [" and ".join(sign.format(inner[key]) for key, sign in signs if key in inner)]
        words += [f"matches `{inner['pattern']}`"] if "pattern" in inner else []
    return "; ".join(w for w in words if w) or {"number": "a number", "boolean": "true, false", "string": "a string"}.get(str(options[0].get("type")), "")


if __name__ == "__main__":
    sys.stdout.write(text())
