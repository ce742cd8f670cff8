"""The effects' functions of the state as lines of the kernel: each is a loop over lanes of its own, passed over where no lane has it.

What the passes leave behind is the water's velocity in the body frame (rows CURRENT) and one wrench (rows EXTRA), all zeros where nothing
acts, so that the rigid body's own loop is the nominal one to the last bit. What flow takes from a thruster is such a wrench too.
"""

from __future__ import annotations

from rovval.plant.codegen.calls import FORCE, call, chain, state
from rovval.plant.codegen.spec import BODY_NAMES, Hook, Spec, hooks, switches


def switch_lines(spec: Spec) -> list[str]:
    """Which passes a block needs."""
    if not spec.full:
        return []

    def any_of(*kinds: str, asks: str = "") -> str:
        found = dict.fromkeys(h.effect for h in hooks(True) if h.kind in kinds and (not asks or asks in h.arguments))
        return " or ".join(f"acts[b, {switches()[name]}]" for name in found) or "False"

    return [
        f"use_rest = {any_of('acting', 'static')}",
        f"use_water = {any_of('water')}",
        f"use_cross = {any_of('thrust', asks='cross')}",
        f"use_flow = {'True' if spec.advance else any_of('thrust')}",
        f"use_state = use_water or use_flow or {any_of('wrench')}",
        "use_log = use_extra or pending or use_rest or use_state",
    ]


def passes(spec: Spec) -> list[str]:
    """Everything between the state of a stage and the rigid body's own loop."""
    if not spec.state:
        return []
    lines = _when("use_state", _zero("EXTRA", 6)) if spec.full else _zero("EXTRA", 6)
    if spec.full:
        water = _zero("WATER", 9)
        for number, hook in enumerate(h for h in hooks(True) if h.kind == "water"):
            water += _alone(spec, hook, f"w{number}", [f"m[(WATER + {c}) * W + l]" for c in range(9)])
        lines += _when("use_water", water + _lanes(_in_water(spec)))
    if spec.full:
        lines += _when("use_cross", _lanes(_flow(spec, True))) + _when("use_flow and not use_cross", _lanes(_flow(spec, False)))
    else:
        lines += _lanes(_flow(spec, False))
    for number, hook in enumerate(h for h in hooks(spec.full) if h.kind == "wrench"):
        lines += _alone(spec, hook, f"f{number}", [f"m[(EXTRA + {c}) * W + l]" for c in range(6)])
    return lines


def _alone(spec: Spec, hook: Hook, prefix: str, into: list[str]) -> list[str]:
    before, values = call(spec, hook, prefix)
    add = [f"{row} += {value}" for row, value in zip(into, values, strict=True) if value != "0.0"]
    asked = {BODY_NAMES[a] for a in hook.arguments if a in BODY_NAMES}
    return [f"# {hook.effect}", *_when(f"acts[b, {switches()[hook.effect]}]", _lanes([*state(asked), *before, *add]))]


def _in_water(spec: Spec) -> list[str]:
    """Water's velocity, its pressure and the added mass of its acceleration in the body frame, and what it changes of C_A nu_r."""
    names = ("cn", "ce", "cd", "dn", "de", "dd", "fn", "fe", "fd")
    lines = [*state(("r11", "r21", "r31", "u", "r_p")), f"{', '.join(names)} = " + ", ".join(f"m[(WATER + {c}) * W + l]" for c in range(9))]
    for out, world in zip(("c", "d", "f"), ("c", "d", "f"), strict=True):
        lines += [f"{out}{axis} = r1{i} * {world}n + r2{i} * {world}e + r3{i} * {world}d" for i, axis in enumerate("xyz", 1)]
    lines += [f"m[(CURRENT + {c}) * W + l] = c{axis}" for c, axis in enumerate("xyz")]
    lines += ["ur, vr, wr = u - cx, v - cy, w - cz"]
    lines += ["wx, wy, wz = dx - (r_q * cz - r_r * cy), dy - (r_r * cx - r_p * cz), dz - (r_p * cy - r_q * cx)"]
    relative = ("ur", "vr", "wr", "r_p", "r_q", "r_r")
    lines += [f"a{i} = " + _product(spec, "ADDED", i, relative, 3) for i in range(3)]
    pressed = (
        "m[DISPLACED * W + l] * fx", "m[DISPLACED * W + l] * fy", "m[DISPLACED * W + l] * fz",
        "m[(DISPLACED + 2) * W + l] * fz - m[(DISPLACED + 3) * W + l] * fy + cy * a2 - cz * a1",
        "m[(DISPLACED + 3) * W + l] * fx - m[(DISPLACED + 1) * W + l] * fz + cz * a0 - cx * a2",
        "m[(DISPLACED + 1) * W + l] * fy - m[(DISPLACED + 2) * W + l] * fx + cx * a1 - cy * a0",
    )  # fmt: skip
    for c, term in enumerate(pressed):
        added = _product(spec, "ADDED", c, ("wx", "wy", "wz"), 3)
        lines.append(f"m[(EXTRA + {c}) * W + l] += {term}{' + ' + added if added else ''}")
    return lines


def _product(spec: Spec, name: str, row: int, vector: tuple[str, ...], diagonal: int) -> str:
    """One row of a 6 x 6 matrix, dense or diagonal (then empty from row ``diagonal`` on), times a vector."""
    if not spec.dense:
        return f"m[({name} + {row}) * W + l] * {vector[row]}" if row < diagonal else ""
    return " + ".join(f"m[({name} + {6 * row + j}) * W + l] * {v}" for j, v in enumerate(vector))


def _flow(spec: Spec, cross: bool) -> list[str]:
    """What flow past the thrusters changes of their thrust at rest, as a wrench."""
    lines = [*(state(("ur", "r_p")) if spec.full else state(("u", "r_p"))), *([] if spec.full else ["ur, vr, wr = u, v, w"])]
    lines += [f"{name} = 0.0" for name in FORCE]
    for i in range(spec.thrusters):
        row = f"(BODY + {i} * STRIDE)"
        lines += [
            f"rest, n = tv[{3 * i} * W + l], tv[{3 * i + 1} * W + l]",
            f"vx, vy, vz = ur + r_q * g_{16 * i + 2} - r_r * g_{16 * i + 1}, vr + r_r * g_{16 * i + 0} - r_p * g_{16 * i + 2}, "
            f"wr + r_p * g_{16 * i + 1} - r_q * g_{16 * i + 0}",
            f"ua = m[({row} + 2) * W + l] * vx + m[({row} + 3) * W + l] * vy + m[({row} + 4) * W + l] * vz",
            "T = rest",
        ]
        if spec.advance:
            lines += [f"J = min(max(ua * tv[{3 * i + 2} * W + l], -JMAX), JMAX)"]
            for name, first in (("ahead", 0), ("astern", 3)):
                c1, c2, c3 = (f"g_{16 * i + 3 + first + c}" for c in range(3))
                lines += [f"{name} = 1.0 + J * ({c1} + J * ({c2} + J * {c3}))"]
            lines += ["T = T * (ahead if n > 0.0 else astern)"]
        if cross:
            lines += ["aside = vx * vx + vy * vy + vz * vz - ua * ua", "cross = math.sqrt(0.5 * (aside + abs(aside)))"]
        lines += chain(spec, "thrust", "T", row, "" if cross else "cross")
        lines += ["change = T - rest", *(f"{name} += change * m[({row} + {2 + c}) * W + l]" for c, name in enumerate(FORCE))]
    return lines + [f"m[(EXTRA + {c}) * W + l] += {name}" for c, name in enumerate(FORCE)]


def _zero(rows: str, count: int) -> list[str]:
    return [f"for c in range({count} * W):", f"    m[{rows} * W + c] = 0.0"]


def _lanes(lines: list[str]) -> list[str]:
    return ["for l in range(W):", *("    " + line for line in lines)]


def _when(condition: str, lines: list[str]) -> list[str]:
    return [f"if {condition}:", *("    " + line for line in lines)]
