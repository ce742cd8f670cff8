"""Which kernel a plant needs, which functions of the effects are in it, and where each number of a lane stands in it.

A lane's numbers stand in one block of ROWS x W doubles, W lanes side by side, so that one loop over lanes is one vector
instruction per operation. Layout and text (`plant.template`) follow from a `Spec` alone; `plant.kernel` writes and compiles the text.
"""

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
PER_THRUSTER = ("speed", "acting", "static", "thrust")
SWITCHED = ("acting", "static", "thrust", "water", "wrench")  # worked out only in blocks where some lane has the effect
SYMMETRIC = tuple((i, j) for i in range(6) for j in range(i, 6))
MASS_ROWS = 10 + 21  # m, m r_G, inertia; M^-1
GROUPS = ("mass", "restoring", "displaced", "added", "linear", "quadratic", "lag", "shift", "jet")  # of rows, beside the effects' own
LOG = ("altitude", "wall_distance", "voltage", "tether_length", "t")
LOG_ROWS = len(LOG) + 6  # and the extra wrench

# What a function of the state may ask for by the name of its argument, and what it is called in the kernel.
AT_STAGE: Mapping[str, str] = {name: f"lv[{i} * W + l]" for i, name in enumerate(LOG)}
BODY_NAMES: Mapping[str, str] = {
    **{n: n for n in ("u", "v", "w", "ur", "vr", "wr", "vn", "ve", "vd")},
    **{n: f"m[(WATER + {i}) * W + l]" for i, n in enumerate(("cn", "ce", "cd"))},
    **{n: f"r_{n}" for n in "pqr"},
    **{n: f"m[xs + {i} * W + l]" for i, n in enumerate("xyz")},
    **{f"r{i}{j}": f"r{i}{j}" for i in (1, 2, 3) for j in (1, 2, 3)},
    **AT_STAGE,
}
THRUSTER_NAMES: Mapping[str, str] = {"n": "n", "T": "T", "ua": "ua", "cross": "cross", **AT_STAGE}
NAMES = tuple(dict.fromkeys((*BODY_NAMES, *THRUSTER_NAMES)))


@dataclass(frozen=True, slots=True)
class Hook:
    """One function of the state: effect, kind of hook, the function, its arguments."""

    effect: str
    kind: str
    function: Callable[..., Any]
    arguments: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Spec:
    """What a kernel holds: number of ``thrusters``; ``dense`` 6 x 6 added mass and drag or diagonals; ``advance``: thrust depends on
    the advance ratio; ``full``: every effect or none."""

    thrusters: int
    dense: bool
    advance: bool
    full: bool

    @property
    def state(self) -> bool:
        """Whether thrust depends on the motion."""
        return self.full or self.advance

    @property
    def name(self) -> str:
        """Short name, part of the file's name."""
        return f"{'full' if self.full else 'nominal'}_{self.thrusters}{'_dense' if self.dense else ''}{'_advance' if self.advance else ''}"


@dataclass(frozen=True, slots=True)
class Layout:
    """First row of each named group; rows of a thruster group are ``body_rows + i * stride + thruster_first``."""

    first: Mapping[str, int]
    body_rows: int
    stride: int
    thruster_first: Mapping[str, int]
    rows: int


@cache
def hooks(full: bool) -> tuple[Hook, ...]:
    """Functions of the state of every effect, in the order of their names; none for a nominal kernel."""
    found = []
    for name in effects.names() if full else ():
        module = effects.module(name)
        for kind in HOOKS:
            if function := getattr(module, kind, None):
                found.append(Hook(name, kind, function, tuple(inspect.signature(function).parameters)))
    return tuple(found)


@cache
def switches() -> Mapping[str, int]:
    """Effects that a block can go without, and the column of each in the kernel's argument ``acts``."""
    return MappingProxyType({name: i for i, name in enumerate(dict.fromkeys(h.effect for h in hooks(True) if h.kind in SWITCHED))})


@cache
def effect_rows(name: str) -> tuple[tuple[str, ...], bool]:
    """Names of the effect's own rows, and whether they stand once per thruster: those of a thruster's function do unless SHARED."""
    module = effects.module(name)
    each = any(hasattr(module, kind) for kind in PER_THRUSTER) and not getattr(module, "SHARED", False)
    return tuple(getattr(module, "ROWS", ())), each


@cache
def layout(spec: Spec) -> Layout:
    """Where each number of a lane stands."""
    matrix = 36 if spec.dense else 6
    sizes = {
        "mass": MASS_ROWS,  # first, so that a payload can replace them
        "restoring": 4,  # W - B, W r_G - B r_B
        "displaced": 4,  # rho V, rho V r_B: force of accelerating water
        "added": matrix,
        "linear": matrix,
        "quadratic": matrix,
        "lag": 4,  # tau, what is left of the past at the start, middle and end of a step
        "shift": 2,  # samples, samples per s
        "jet": spec.thrusters + 1,  # wake of each thruster, side
    }
    thruster, stride = {}, 8  # k_pos, k_neg, direction, moment
    for effect in dict.fromkeys(h.effect for h in hooks(spec.full)):
        names, per_thruster = effect_rows(effect)
        for row in names:
            if per_thruster:
                thruster[f"{effect}.{row}"] = stride
                stride += 1
            else:
                sizes[f"{effect}.{row}"] = 1
    first, place = {}, 0
    for name, size in sizes.items():
        first[name] = place
        place += size
    return Layout(first, place, stride, thruster, place + stride * spec.thrusters)
