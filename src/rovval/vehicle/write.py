"""A vehicle as TOML text: what `parse` reads back is the same vehicle."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

from rovval.core.errors import UsageProblem
from rovval.vehicle.model import Vehicle

FORM = "write NAME:param=value,... as `rovval simulate --effect` takes it"


def with_effects(vehicle: Vehicle, settings: Sequence[str]) -> str:
    """TOML of the vehicle with the effects of ``settings`` added to (or replacing) those that it carries."""
    effects: dict[str, dict[str, float]] = {name: dict(values) for name, values in vehicle.effects.items()}
    for setting in settings:
        name, _, pairs = setting.partition(":")
        values = {}
        for pair in pairs.split(","):
            key, equals, value = pair.partition("=")
            if not equals:
                raise UsageProblem(f"effect setting {setting!r} has no value", FORM)
            values[key.strip()] = float(value)
        effects[name.strip()] = values
    return to_toml(vehicle.model_copy(update={"effects": effects}))


def to_toml(vehicle: Vehicle) -> str:
    """TOML text of a vehicle, floats in full so that they round-trip."""
    data = vehicle.model_dump(mode="json", exclude_none=True)
    named = ("sources", "body", "water", "mixer", "pulse_table", "uuv", "effects", "calibration", "tolerance_correlation")
    tables = {k: data.pop(k) for k in named if k in data}
    thrusters = data.pop("thruster")
    lines = [f"{key} = {_value(value)}" for key, value in data.items()]
    for name, table in tables.items():
        lines += _table(name, table)
    for thruster in thrusters:
        lines += ["", "[[thruster]]", *(f"{key} = {_value(value)}" for key, value in thruster.items())]
    return "\n".join(lines) + "\n"


def _table(name: str, table: Mapping[str, Any]) -> list[str]:
    plain = [f"{_key(k)} = {_value(v)}" for k, v in table.items() if not isinstance(v, dict)]
    lines = ["", f"[{name}]", *plain] if plain else []
    for key, value in table.items():
        if isinstance(value, dict):
            lines += _table(f"{name}.{_key(key)}", value)
    return lines


def _key(key: str) -> str:
    return key if key.replace("_", "").replace("-", "").isalnum() and key.isascii() else json.dumps(key)


def _value(value: Any) -> str:
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, list):
        return "[" + ", ".join(_value(v) for v in value) + "]"
    return repr(value)
