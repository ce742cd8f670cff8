"""Where each number of a lane stands in a block: rows that `Plant` hands over (`rovval.plant.lowering`), then rows of the kernel's own.

A block is ROWS x W doubles, W lanes side by side. `rovval.plant.codegen.kernel.symbols` says what each row holds.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

from rovval.plant.codegen.spec import LOG, Spec, effect_rows, hooks

SYMMETRIC = tuple((i, j) for i in range(6) for j in range(i, 6))
MASS_ROWS = 1 + 3 + 6 + len(SYMMETRIC)  # m, m r_G, inertia; M^-1
LOG_ROWS = len(LOG) + 6  # and the extra wrench
GROUPS = ("mass", "restoring", "displaced", "added", "linear", "quadratic", "lag", "shift", "jet")  # of rows, beside the effects' own

SPEED_LIMIT = 20.0  # m/s; no ROV comes near it (design: limits)
RATE_LIMIT = 30.0  # rad/s
SETTLING = 100  # steps after which a filter that takes 0.3 of its input has settled to the last bit: 0.7^100 = 3e-16
ADVANCE_LIMIT = 1.0  # |J_a| beyond which the cubic K_T is held: open-water series end near there, and a cubic turns up again


@dataclass(frozen=True, slots=True)
class Layout:
    """First row of each named group; rows of a thruster group are ``body_rows + i * stride + thruster_first``."""

    first: Mapping[str, int]
    body_rows: int
    stride: int
    thruster_first: Mapping[str, int]
    rows: int


@cache
def layout(spec: Spec) -> Layout:
    """Where each number that `Plant` hands over stands."""
    matrix = 36 if spec.dense else 6
    sizes = {
        "mass": MASS_ROWS,  # first, so that a payload can replace them
        "restoring": 4,
        "displaced": 4,
        "added": matrix,
        "linear": matrix,
        "quadratic": matrix,
        "lag": 4,
        "shift": 2,
        "jet": spec.thrusters + 1,
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


def constants(spec: Spec) -> dict[str, float]:
    """What stands for each name in capitals of the kernel: choices, first rows, sizes, limits. State and scratch follow the lane's own numbers in one
    array: LLVM then proves with few checks at run time that what a loop writes is not what it reads."""
    where, k = layout(spec), spec.thrusters
    numbers: dict[str, float] = {"FULL": spec.full, "DENSE": spec.dense, "ADVANCE": spec.advance, "FLOW": spec.flow}
    numbers |= {"EXPLICIT": spec.explicit, "LAGGED": spec.full or spec.explicit, "SHARE": spec.share, "SETTLING": SETTLING}
    numbers |= {name.upper(): where.first[name] for name in GROUPS}
    numbers |= {
        "W": spec.lanes, "THRUSTERS": k, "BODY": where.body_rows, "STRIDE": where.stride, "INPUT_ROWS": where.rows, "LOG_ROWS": LOG_ROWS,
        "LOG_COUNT": len(LOG), "TIME": LOG.index("t"), "WRENCH": len(LOG),
        "THRUST_ROWS": 3 * k + 6 if spec.flow else 6, "PAYLOAD_ROWS": MASS_ROWS,
        "SPEED_LIMIT_2": SPEED_LIMIT**2, "RATE_LIMIT_2": RATE_LIMIT**2, "ADVANCE_LIMIT": ADVANCE_LIMIT, "THIRD": 1.0 / 3.0,
    }  # fmt: skip
    place = where.rows
    sizes = {"STATE": 5 * 13, "EULER": 3, "ENDS": 2 * k, "MEMORY": k, "NEXT": k, "ALIVE": 1, "CODE": 2, "CURRENT": 3, "WATER": 9, "EXTRA": 6}
    sizes |= {"MOTION": (13 if spec.flow else 0) + (9 + 3 if spec.full else 0), "LOGGED": len(LOG) if spec.full else 0}
    sizes |= dict.fromkeys(("FILTERED", "BEFORE"), 6 if spec.explicit else 0)
    for name, size in sizes.items():
        numbers[name] = place
        place += size
    return numbers | {"ROWS": place}
