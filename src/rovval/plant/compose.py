"""The text of the batch kernel, put together from the plant's equations and from every effect's functions of the state.

A lane's numbers stand in one block ``p`` of ROWS x W doubles, W lanes side by side, so that one loop over lanes is one vector
instruction per operation. Layout and text follow from a `Spec` alone; `plant.kernel` writes the text to a file and compiles it.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from rovval import effects

W = 32  # lanes of a block: at least 16 trips, or LLVM leaves the loop scalar (measured); state and numbers stay in L1
HOOKS = ("speed", "acting", "static", "thrust", "water", "wrench")
PER_THRUSTER = ("speed", "acting", "static", "thrust")
SYMMETRIC = tuple((i, j) for i in range(6) for j in range(i, 6))
MASS_ROWS = 10 + 21  # m, m r_G, inertia; M^-1

# What a function of the state may ask for by the name of its argument.
BODY_NAMES: Mapping[str, str] = {
    **{n: f"xs[{7 + i} * W + l]" for i, n in enumerate("uvwpqr")},
    **{n: f"sc[{9 + i} * W + l]" for i, n in enumerate(("ur", "vr", "wr"))},
    **{n: f"sc[{15 + i} * W + l]" for i, n in enumerate(("vn", "ve", "vd"))},
    **{n: f"sc[{18 + i} * W + l]" for i, n in enumerate(("cn", "ce", "cd"))},
    **{n: f"xs[{i} * W + l]" for i, n in enumerate("xyz")},
    **{f"r{i + 1}{j + 1}": f"sc[{3 * i + j} * W + l]" for i in range(3) for j in range(3)},
    "t": "lg[(4 * 3 + s) * W + l]",
    **{n: f"lg[({c} * 3 + s) * W + l]" for c, n in enumerate(("altitude", "wall_distance", "voltage", "tether_length"))},
}
THRUSTER_NAMES = ("n", "T", "ua", "cross", "t", "voltage")
NAMES = (*BODY_NAMES, *THRUSTER_NAMES)


@dataclass(frozen=True, slots=True)
class Hook:
    """One function of the state: effect, kind of hook, the function, its arguments and which of them are rows of its own."""

    effect: str
    kind: str
    function: Callable[..., Any]
    arguments: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Spec:
    """What a kernel holds: ``dense`` 6 x 6 added mass and drag or diagonals, ``advance`` a thrust that depends on the advance
    ratio, ``full`` every effect or none."""

    dense: bool
    advance: bool
    full: bool

    @property
    def name(self) -> str:
        """Short name, part of the file's name."""
        return f"{'full' if self.full else 'nominal'}{'_dense' if self.dense else ''}{'_advance' if self.advance else ''}"


@dataclass(frozen=True, slots=True)
class Layout:
    """First row of each named group; rows of a thruster group are ``first + i * stride``."""

    first: Mapping[str, int]
    body_rows: int
    thruster_stride: int
    thruster_first: Mapping[str, int]

    def rows(self, thrusters: int) -> int:
        """Rows of a lane of a vehicle with that many thrusters."""
        return self.body_rows + self.thruster_stride * thrusters


def hooks(spec: Spec) -> tuple[Hook, ...]:
    """Functions of the state of every effect, in the order of their names; none for a nominal kernel."""
    if not spec.full:
        return ()
    found = []
    for name in effects.names():
        module = effects.module(name)
        for kind in HOOKS:
            if function := getattr(module, kind, None):
                found.append(Hook(name, kind, function, tuple(inspect.signature(function).parameters)))
    return tuple(found)


def effect_rows(name: str) -> tuple[tuple[str, ...], bool]:
    """Names of the effect's own rows, and whether they stand once per thruster."""
    module = effects.module(name)
    return tuple(getattr(module, "ROWS", ())), any(hasattr(module, kind) for kind in PER_THRUSTER)


def layout(spec: Spec) -> Layout:
    """Where each number of a lane stands."""
    first: dict[str, int] = {}
    place = 0

    def group(name: str, size: int) -> None:
        nonlocal place
        first[name] = place
        place += size

    group("mass", MASS_ROWS)  # first, so that a payload can replace them
    group("restoring", 4)  # W - B, W r_G - B r_B
    group("displaced", 4)  # rho V, rho V r_B: force of accelerating water
    for name in ("added", "linear", "quadratic"):
        group(name, 36 if spec.dense else 6)
    group("lag", 4)  # tau, exp(-0), exp(-h/2 tau), exp(-h/tau)
    group("shift", 2)  # samples, samples per s
    group("jet", 2)  # wake, side
    thruster: dict[str, int] = {"thruster": 0}
    stride = 8
    for hook_effect in dict.fromkeys(h.effect for h in hooks(spec)):
        names, per_thruster = effect_rows(hook_effect)
        for row in names:
            if per_thruster:
                thruster[f"{hook_effect}.{row}"] = stride
                stride += 1
            else:
                group(f"{hook_effect}.{row}", 1)
    return Layout(first, place, stride, thruster)


def text(spec: Spec) -> str:
    """Source of the kernel's module."""
    from rovval.plant import template

    where, found = layout(spec), hooks(spec)

    def calls(kind: str, into: Callable[[Hook, str], Iterable[str]], names: Mapping[str, str], indent: int) -> str:
        lines: list[str] = []
        for hook in (h for h in found if h.kind == kind):
            own, per_thruster = effect_rows(hook.effect)
            values = []
            for argument in hook.arguments:
                if argument in own and per_thruster:
                    values.append(f"p[tb + {where.thruster_first[f'{hook.effect}.{argument}']} * W + l]")
                elif argument in own:
                    values.append(f"p[{where.first[f'{hook.effect}.{argument}']} * W + l]")
                else:
                    values.append(names[argument])
            lines += into(hook, f"{hook.kind}_{hook.effect}({', '.join(values)})")
        return "\n".join(" " * indent + line for line in lines)

    six = "X Y Z K M N".split()
    nine = "cn ce cd dn de dd fn fe fd".split()
    thruster = {"n": "n", "T": "T", "ua": "ua", "cross": "cross", "t": "lg[(4 * 3 + s) * W + l]", "voltage": "lg[(2 * 3 + s) * W + l]"}
    fills = {
        "imports": "\n".join(
            f"from rovval.effects.{h.effect} import {h.kind} as _{h.kind}_{h.effect}\n{h.kind}_{h.effect} = inlined(_{h.kind}_{h.effect})" for h in found
        ),
        "speed": calls("speed", lambda h, c: [f"n = {c}"], thruster, 20),
        "acting": calls("acting", lambda h, c: [f"n = {c}"], thruster, 16),
        "static": calls("static", lambda h, c: [f"T = {c}"], thruster, 16),
        "thrust": calls("thrust", lambda h, c: [f"T = {c}"], thruster, 12),
        "water": calls("water", lambda h, c: [f"{', '.join(n + '_' for n in nine)} = {c}", *(f"{n} += {n}_" for n in nine)], {**BODY_NAMES, "vn": "vn", "ve": "ve", "vd": "vd"}, 8),
        "wrench": calls("wrench", lambda h, c: [f"{', '.join(n + '_' for n in six)} = {c}", *(f"{n} += {n}_" for n in six)], BODY_NAMES, 8),
    }
    return template.render(spec, where, fills)
