"""Vehicles: the class, the library of TOML files, and the audit that every one passes when it is loaded."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import TYPE_CHECKING

from rovval.core.did_you_mean import suggestion
from rovval.core.errors import BadVehicle, UsageProblem, all_at_once

if TYPE_CHECKING:
    from rovval.vehicle.model import Vehicle

LIBRARY = Path(__file__).parent / "library"


def names() -> tuple[str, ...]:
    """Names of the vehicles that come with rovval."""
    return tuple(sorted(p.stem for p in LIBRARY.glob("*.toml")))


def load(name_or_path: str | Path) -> Vehicle:
    """The vehicle of that name in the library, or of that TOML file, audited.

    Raises:
        UsageProblem: there is no such vehicle or file.
        BadVehicle: the file is not a vehicle; every problem is listed at once.
    """
    path = Path(name_or_path)
    if path.suffix != ".toml":
        path = LIBRARY / f"{name_or_path}.toml"
        if not path.exists():
            meant = suggestion(str(name_or_path), names(), "`rovval list vehicle`")
            raise UsageProblem(f"no vehicle named {str(name_or_path)!r}", f"{meant}, or give a path to a .toml file")
    if not path.is_file():
        raise UsageProblem(f"vehicle file {path} does not exist", "see `rovval list vehicle`; the README shows how to write one")
    return parse(path.read_text(encoding="utf-8"), str(path))


def parse(text: str, where: str) -> Vehicle:
    """A vehicle from TOML text; ``where`` names it in messages. Raises BadVehicle with every problem at once."""
    from pydantic import ValidationError

    from rovval.vehicle.audit import audit
    from rovval.vehicle.model import Vehicle

    try:
        vehicle = Vehicle.model_validate(tomllib.loads(text))
    except tomllib.TOMLDecodeError as error:
        raise BadVehicle(f"{where} is not TOML: {error}", "mend the line that is named") from None
    except ValidationError as error:
        lines = [f"{'.'.join(map(str, e['loc']))}: {e['msg']} (is {e['input']!r:.60})" for e in error.errors()]
        raise BadVehicle(all_at_once(lines, where), "compare with `rovval show vehicle merlin`") from None
    if problems := audit(vehicle):
        raise BadVehicle(all_at_once(problems, where), "mend the numbers that are named")
    return vehicle
