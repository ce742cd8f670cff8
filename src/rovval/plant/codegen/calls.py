"""An effect's function of the state as lines of the kernel, and what of the state its loop over lanes needs."""

from __future__ import annotations

from collections.abc import Iterable

from rovval.plant.codegen import spec as compose
from rovval.plant.codegen.inline import inline
from rovval.plant.codegen.spec import Hook, Layout, Spec

FORCE = tuple("XYZKMN")

# What a loop over lanes may need of the state: names, what they need in turn, and their line; in an order in which they can stand.
STATE: tuple[tuple[str, str, str], ...] = (
    ("qw qx qy qz", "", "qw, qx, qy, qz = m[xs + 3 * W + l], m[xs + 4 * W + l], m[xs + 5 * W + l], m[xs + 6 * W + l]"),
    ("u v w", "", "u, v, w = m[xs + 7 * W + l], m[xs + 8 * W + l], m[xs + 9 * W + l]"),
    ("r_p r_q r_r", "", "r_p, r_q, r_r = m[xs + 10 * W + l], m[xs + 11 * W + l], m[xs + 12 * W + l]"),
    ("x2 y2 z2", "qx qy qz", "x2, y2, z2 = qx + qx, qy + qy, qz + qz"),
    ("yy xx", "qx qy x2 y2", "yy, xx = 1.0 - qy * y2, 1.0 - qx * x2"),
    ("xy xz yz", "qx qy y2 z2", "xy, xz, yz = qx * y2, qx * z2, qy * z2"),
    ("r11 r12 r13", "yy qz qw z2 y2 xy xz", "r11, r12, r13 = yy - qz * z2, xy - qw * z2, xz + qw * y2"),
    ("r21 r22 r23", "xx qz qw z2 x2 xy yz", "r21, r22, r23 = xy + qw * z2, xx - qz * z2, yz - qw * x2"),
    ("r31 r32 r33", "xx qw x2 y2 qy xz yz", "r31, r32, r33 = xz - qw * y2, yz + qw * x2, xx - qy * y2"),
    ("vn", "r11 r12 r13 u v w", "vn = r11 * u + r12 * v + r13 * w"),
    ("ve", "r21 r22 r23 u v w", "ve = r21 * u + r22 * v + r23 * w"),
    ("vd", "r31 r32 r33 u v w", "vd = r31 * u + r32 * v + r33 * w"),
    ("cx cy cz", "", "cx, cy, cz = m[CURRENT * W + l], m[(CURRENT + 1) * W + l], m[(CURRENT + 2) * W + l]"),
    ("ur vr wr", "u v w cx cy cz", "ur, vr, wr = u - cx, v - cy, w - cz"),
)  # fmt: skip


def state(wanted: Iterable[str]) -> list[str]:
    """Lines that define the names wanted of the state, and no others."""
    need, lines = set(wanted), []
    for names, after, line in reversed(STATE):
        if need & set(names.split()):
            need |= set(after.split())
            lines.append(line)
    return lines[::-1]


def _row_of(where: Layout, hook: Hook, argument: str, thruster: str) -> str:
    """Text of one of the effect's own rows; ``thruster`` is the text of the thruster's first row."""
    key = f"{hook.effect}.{argument}"
    if key in where.thruster_first:
        return f"m[({thruster} + {where.thruster_first[key]}) * W + l]"
    return f"m[{where.first[key]} * W + l]"


def call(spec: Spec, hook: Hook, prefix: str, thruster: str = "") -> tuple[list[str], list[str]]:
    """One effect's function: its lines, and the expressions that it returns."""
    own, names = compose.effect_rows(hook.effect)[0], compose.THRUSTER_NAMES if hook.kind in compose.PER_THRUSTER else compose.BODY_NAMES
    unknown = [a for a in hook.arguments if a not in own and a not in names]
    if unknown:
        raise ValueError(f"effects/{hook.effect}.py: {hook.kind}() asks for {', '.join(unknown)}, known: {', '.join((*own, *names))}")
    texts = {a: _row_of(compose.layout(spec), hook, a, thruster) if a in own else names[a] for a in hook.arguments}
    return inline(hook.function, prefix, texts)


def chain(spec: Spec, kind: str, name: str, thruster: str, without: str = "") -> list[str]:
    """Lines in which every effect of a kind in turn replaces ``name``; effects that ask for ``without`` are left out."""
    lines: list[str] = []
    for number, hook in enumerate(h for h in compose.hooks(spec.full) if h.kind == kind and without not in h.arguments):
        before, (value,) = call(spec, hook, f"{kind[0]}{number}", thruster)
        lines += [f"# {hook.effect}", *before, f"{name} = {value}"]
    return lines
