"""What can be planted: one row an effect, with its place, targets, form against the library's, and what severity 1 is."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from importlib import import_module

import numpy as np

from rovval.blind.plant.effect import Effect, Planting, Setting
from rovval.blind.plant.nominal_vehicle import NominalVehicle
from rovval.blind.plant.scales import Scales
from rovval.blind.plant.spec import Planted, stream

FAMILIES = (
    "hydrodynamic", "hydrostatic", "thrusters", "propellers", "water", "proximity", "tether_drag", "tether_pull", "timing", "instruments",
    "foreign_flow", "foreign_machine", "foreign_events",
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class Entry:
    """One plantable effect. ``place`` is "foreign" where the library has nothing of the kind; ``acts`` is where it enters."""

    name: str
    place: str
    acts: str
    form: str
    targets: tuple[str, ...]
    event: bool
    least: float
    about: str
    severity_one: str
    build: type[Effect]


@cache
def catalogue() -> dict[str, Entry]:
    """Every effect by name, in the order of the families."""
    rows: dict[str, Entry] = {}
    for family in FAMILIES:
        module = import_module(f"rovval.blind.planted.{family}")
        for item in vars(module).values():
            if isinstance(item, type) and issubclass(item, Effect) and item.name and item.__module__ == module.__name__:
                about = " ".join((item.__doc__ or "").split())
                place = item.place if item.known else "foreign"
                form = item.form if item.known else "foreign"
                rows[item.name] = Entry(
                    item.name, place, item.place, form, item.targets, item.event, item.least, about, item.unit, item
                )
    return rows


def names(*, foreign: bool) -> tuple[str, ...]:
    """Names of the library's effects, or of the foreign ones."""
    return tuple(name for name, row in catalogue().items() if (row.place == "foreign") == foreign)


def build(item: Planted, nominal: NominalVehicle, scale: Scales, setting: Setting) -> Effect:
    """One effect, ready to fly, with a random stream of its own."""
    try:
        entry = catalogue()[item.name]
    except KeyError:
        raise ValueError(f"unknown effect {item.name!r}; one of: {', '.join(catalogue())}") from None
    if not np.isfinite(item.severity) or item.severity < entry.least:
        raise ValueError(f"{item.name}: severity {item.severity} means nothing here")
    rng = stream(setting.seed, "effect", item.name, item.target or "")
    return entry.build(Planting(item, nominal, scale, setting, rng))
