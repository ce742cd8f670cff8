"""Which kernel a plant needs, and which functions of the effects are in it."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from types import MappingProxyType
from typing import Any

from rovval import effects

W = 16  # lanes of a block: fewer than 16 trips and LLVM leaves the loop scalar; with 32 every effect's numbers leave a 32 kB L1 (measured)
HOOKS = ("speed", "acting", "static", "thrust", "water", "wrench")
OF_STATE = ("thrust", "water", "wrench")  # of the motion of a stage; "acting" and "static" are of the thrusters at rest, "speed" of the log alone
PER_THRUSTER = ("speed", "acting", "static", "thrust")
SWITCHED = ("acting", "static", "thrust", "water", "wrench")  # worked out only in blocks where some lane has the effect
LOGGED = ("altitude", "wall_distance", "voltage", "tether_length", "load", "turned")  # columns of a prepared log
LOG = (*LOGGED, "t")  # rows of the log at one time, before the extra wrench

# What an effect's function may ask for by the name of its argument, beside the effect's own rows: functions of the body's motion ...
BODY_NAMES = (
    "u", "v", "w", "ur", "vr", "wr", "vn", "ve", "vd", "cn", "ce", "cd", "p", "q", "r", "x", "y", "z",
    "r11", "r12", "r13", "r21", "r22", "r23", "r31", "r32", "r33", *LOG,
)  # fmt: skip
# ... and functions of one thruster: speed, thrust, axial and cross flow.
THRUSTER_NAMES = ("n", "T", "ua", "cross", *LOG)


@dataclass(frozen=True, slots=True)
class Hook:
    """One function of the state: its effect, its kind (of `HOOKS`), the function, the names of its arguments; of an effect that is a sum, one such for each
    ``component``."""

    effect: str
    kind: str
    function: Callable[..., Any]
    arguments: tuple[str, ...]
    component: str = ""

    @property
    def name(self) -> str:
        """Name of the effect, or of its component."""
        return self.effect + self.component

    def row(self, argument: str) -> str:
        """Row of the effect's own that stands for an argument: the component's, or what all components share."""
        own = argument + self.component
        return own if own in effect_rows(self.effect)[0] else argument


@dataclass(frozen=True, slots=True)
class Spec:
    """What a kernel holds: number of ``thrusters``; ``dense`` 6 x 6 added mass and drag or diagonals; ``advance``: thrust depends on
    the advance ratio; ``full``: every effect or none; ``share``: of the newest acceleration in the filtered one of which added mass is a force,
    in a step of Euler's (0: added mass is in the mass matrix, in one of Runge and Kutta's); ``lanes`` of a block."""

    thrusters: int
    dense: bool
    advance: bool
    full: bool
    share: float = 0.0
    lanes: int = W

    @property
    def flow(self) -> bool:
        """Whether thrust depends on the flow past the thruster, and so on the motion."""
        return self.full or self.advance

    @property
    def explicit(self) -> bool:
        """Whether added mass is a force on a rigid body."""
        return self.share > 0.0

    @property
    def name(self) -> str:
        """Short name, part of the file's name."""
        kinds = {"dense": self.dense, "advance": self.advance, "explicit": self.explicit}
        return "_".join(["full" if self.full else "nominal", str(self.thrusters), *(kind for kind, has in kinds.items() if has)])


@cache
def hooks(full: bool) -> tuple[Hook, ...]:
    """Functions of the state of every effect, in the order of their names; none for a nominal kernel."""
    found = []
    for name in effects.names() if full else ():
        module = effects.module(name)
        for kind in HOOKS:
            if function := getattr(module, kind, None):
                arguments = tuple(inspect.signature(function).parameters)
                found += [Hook(name, kind, function, arguments, of) for of in components(name)]
    return tuple(found)


@cache
def switches() -> Mapping[str, int]:
    """Effects, and components of effects, that a block can go without, and the column of each in the kernel's argument ``acts``."""
    return MappingProxyType({name: i for i, name in enumerate(dict.fromkeys(h.name for h in hooks(True) if h.kind in SWITCHED))})


def components(effect: str) -> tuple[str, ...]:
    """Endings of the names of what an effect is the sum of; one empty ending where it is no sum."""
    return tuple(getattr(effects.module(effect), "COMPONENTS", ("",)))


@cache
def component_of(effect: str, parameter: str) -> str:
    """Component of an effect to which a parameter belongs; one that all share goes with the first."""
    return next((of for of in components(effect)[1:] if parameter.endswith(of)), components(effect)[0])


@cache
def effect_rows(name: str) -> tuple[tuple[str, ...], bool]:
    """Names of the effect's own rows, and whether they stand once per thruster: those of a thruster's function do unless SHARED."""
    module = effects.module(name)
    each = any(hasattr(module, kind) for kind in PER_THRUSTER) and not getattr(module, "SHARED", False)
    return tuple(getattr(module, "ROWS", ())), each
