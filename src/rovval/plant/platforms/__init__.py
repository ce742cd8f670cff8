"""Platforms: whose equations of motion a vehicle is simulated with, one file each.

The thesis compares two simulators of one vehicle; a platform is such a simulator's model. Its file says where the equations come from, what they
leave out, which of the vehicle's numbers they take, and how they are integrated. A new file in this folder is a new value of `--model`.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from rovval.core.did_you_mean import suggestion
from rovval.core.errors import UsageProblem

if TYPE_CHECKING:
    from rovval.vehicle.model import Vehicle

USUAL = "fossen"


@dataclass(frozen=True, slots=True)
class Engine:
    """The step of a physics engine that knows the rigid body alone, and to which added mass is a force.

    ``step``: s, semi-implicit Euler. ``share``: of the newest acceleration in the low-pass filtered one that the added mass is multiplied with.
    ``time_constant``: s, of a vehicle's thruster speeds behind their commands, first order.
    """

    step: float
    share: float
    time_constant: Callable[[Vehicle], float]


@dataclass(frozen=True, slots=True)
class Platform:
    """One platform: to read, ``title``, ``equations``, ``source``, what it ``leaves_out`` and what is ``assumed`` since no source prints it; to
    compute, ``vehicle``: the vehicle with the numbers that the platform takes (raises UsageProblem for one that it cannot simulate), and the
    ``engine`` that integrates it (None: added mass in the mass matrix, classical Runge-Kutta steps)."""

    title: str
    equations: str
    source: str
    leaves_out: tuple[str, ...]
    vehicle: Callable[[Vehicle], Vehicle]
    assumed: tuple[str, ...] = ()
    engine: Engine | None = None


@cache
def names() -> tuple[str, ...]:
    """Names of all platforms."""
    return tuple(sorted(p.stem for p in Path(__file__).parent.glob("[a-z]*.py")))


@cache
def load(name: str) -> Platform:
    """The platform of that name. Raises UsageProblem where there is none."""
    if name not in names():
        raise UsageProblem(f"no platform named {name!r}", suggestion(name, names(), "`rovval list platform`"))
    found = importlib.import_module(f"{__name__}.{name}").PLATFORM
    assert isinstance(found, Platform)
    return found
