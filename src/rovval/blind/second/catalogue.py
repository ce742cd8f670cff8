"""What plant b can plant: every class of the modules of `faults`, by name."""

from __future__ import annotations

from functools import cache
from importlib import import_module

import numpy as np

from rovval.blind.plant.spec import Planted, stream
from rovval.blind.second.fault import Fault, Site
from rovval.blind.second.sheet import Sheet

MODULES = ("body", "drive", "jets", "water", "line", "log", "strange")


@cache
def catalogue() -> dict[str, type[Fault]]:
    """Every effect of plant b."""
    found: dict[str, type[Fault]] = {}
    for name in MODULES:
        module = import_module(f"rovval.blind.second.faults.{name}")
        for item in vars(module).values():
            if isinstance(item, type) and issubclass(item, Fault) and item.name and item.__module__ == module.__name__:
                found[item.name] = item
    return found


def plant(item: Planted, sheet: Sheet, site: Site, seed: int) -> Fault:
    """One effect, ready to fly, with random numbers of its own. Raises ValueError for a name, target or severity that there is not."""
    kind = catalogue().get(item.name)
    if kind is None:
        raise ValueError(f"plant b has no effect {item.name!r}; one of: {', '.join(catalogue())}")
    if not np.isfinite(item.severity) or (item.severity < 0.0 and not kind.both_signs):
        raise ValueError(f"{item.name}: severity {item.severity} means nothing here")
    return kind(item, sheet, site, stream(seed, "b", "effect", item.name, item.target or ""))
