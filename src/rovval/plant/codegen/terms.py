"""Lines of the kernel that depend on the number of thrusters, or on whether matrices are dense: thrust at rest, drag, inertia."""

from __future__ import annotations

from rovval.plant.codegen import spec as compose
from rovval.plant.codegen.calls import FORCE, chain
from rovval.plant.codegen.spec import Spec

NU_R = ("ur", "vr", "wr", "r_p", "r_q", "r_r")


def wrench_at_rest(spec: Spec) -> list[str]:
    """Thrust of every thruster at one stage time, and its wrench, where thrust does not depend on the motion."""
    lines: list[str] = []
    for i in range(spec.thrusters):
        lines += thrust_at_rest(spec, str(i), False)
        lines += [f"{name} {'+=' if i else '='} T * m[(BODY + {i} * STRIDE + {2 + c}) * W + l]" for c, name in enumerate(FORCE)]
    return lines + [f"tv[{c} * W + l] = {name}" for c, name in enumerate(FORCE)]


def thrust_at_rest(spec: Spec, i: str, effects: bool) -> list[str]:
    """Acting speed and thrust at rest in the water of thruster ``i`` at one stage time."""
    row = f"(BODY + {i} * STRIDE)"
    lines = [f"a = m[(ENDS + {i}) * W + l]", f"d = m[(ENDS + THRUSTERS + {i}) * W + l] - a", "n = a + d * f"]
    if spec.full:
        lines += [
            "slope = d * inv_dt * tau",
            f"n = n - slope + (m[(MEMORY + {i}) * W + l] - (a + d * f0) + slope) * left",
            f"m[(NEXT + {i}) * W + l] = n",
        ]
    lines += chain(spec, "acting", "n", row) if effects else []
    lines += ["ahead, astern = 0.5 * (abs(n) + n), 0.5 * (abs(n) - n)"]
    lines += [f"T = m[{row} * W + l] * ahead * ahead - m[({row} + 1) * W + l] * astern * astern"]
    lines += chain(spec, "static", "T", row) if effects else []
    if spec.state:
        lines += [f"tv[3 * {i} * W + l] = T", f"tv[(3 * {i} + 1) * W + l] = n"]
    if spec.advance:
        lines += [f"tv[(3 * {i} + 2) * W + l] = n / (geo[16 * {i} + 15] * (n * n + 1e-12))"]
    return lines


def wrench_of_thrust(spec: Spec) -> list[str]:
    """Wrench of the thrusts at rest at one stage time."""
    lines: list[str] = []
    for i in range(spec.thrusters):
        lines += [f"T = tv[{3 * i} * W + l]"]
        lines += [f"{name} {'+=' if i else '='} T * m[(BODY + {i} * STRIDE + {2 + c}) * W + l]" for c, name in enumerate(FORCE)]
    return lines + [f"tv[(3 * THRUSTERS + {c}) * W + l] = {name}" for c, name in enumerate(FORCE)]


def side(spec: Spec) -> list[str]:
    """Side wrench of all thrusters at one stage time, from their thrust at rest."""
    lines = [f"{name} = 0.0" for name in FORCE]
    for i in range(spec.thrusters):
        lines += [f"S = abs(tv[{3 * i} * W + l]) * m[(JET + THRUSTERS) * W + l]", *(f"{name} += S * g_{16 * i + 9 + c}" for c, name in enumerate(FORCE))]
    return lines + [f"tv[(3 * THRUSTERS + {c}) * W + l] += {name}" for c, name in enumerate(FORCE)]


def force(spec: Spec) -> list[str]:
    """The wrench with which a stage begins: thrust at rest, and what the passes left."""
    if not spec.state:
        return [f"{name} = tv[{c} * W + l]" for c, name in enumerate(FORCE)]
    return [f"{name} = tv[(3 * THRUSTERS + {c}) * W + l] + m[(EXTRA + {c}) * W + l]" for c, name in enumerate(FORCE)]


def momentum(dense: bool) -> list[str]:
    """Linear s1 s2 s3 and angular t1 t2 t3 momentum of body and added mass."""
    sums = [("s1", "l1"), ("s2", "l2"), ("s3", "l3"), ("t1", "h1"), ("t2", "h2"), ("t3", "h3")]
    return [f"{total} = {body} + {_row('ADDED', i, dense, NU_R)}" for i, (total, body) in enumerate(sums)]


def drag(dense: bool) -> list[str]:
    """Drag of every axis, taken from the force: one multiply-add after another."""
    if not dense:
        return [f"{f} -= (m[(LINEAR + {i}) * W + l] + m[(QUADRATIC + {i}) * W + l] * abs({n})) * {n}" for i, (f, n) in enumerate(zip(FORCE, NU_R, strict=True))]
    squares = tuple(f"e{j}" for j in range(6))
    lines = [f"{e} = abs({n}) * {n}" for e, n in zip(squares, NU_R, strict=True)]
    return lines + [f"{f} -= {_row('LINEAR', i, True, NU_R)} + {_row('QUADRATIC', i, True, squares)}" for i, f in enumerate(FORCE)]


def acceleration() -> list[str]:
    """M^-1 times force, the inverse symmetric."""
    place = {pair: 10 + n for n, pair in enumerate(compose.SYMMETRIC)}
    return [
        f"k{7 + i} = " + " + ".join(f"m[(MASS + {place[min(i, j), max(i, j)]}) * W + l] * {FORCE[j]}" for j in range(6)) for i in range(6)
    ]


def stage_state() -> list[str]:
    """Runge-Kutta: the state at the next stage. The quaternion's k lack their factor of one half."""
    return [f"m[xn + {c} * W + l] = m[(X0 + {c}) * W + l] + {'half' if 3 <= c < 7 else 'reach'} * k{c}" for c in range(13)]


def new_state() -> list[str]:
    """Runge-Kutta: the state after the step, from that at its beginning and at the four stages (Y1 to Y4, see the text of the kernel)."""
    y = [[f"m[(X0 + {13 * stage + c}) * W + l]" for stage in range(5)] for c in range(13)]
    return [f"n{c} = {a} + THIRD * ((({b} - {e}) + ({d} - {a})) + 2.0 * ({g} - {a}))" for c, (a, b, g, d, e) in enumerate(y)]


def take_state() -> list[str]:
    """The new state of the lanes that keep going."""
    return [f"m[(X0 + {c}) * W + l] = n{c} if go else m[(X0 + {c}) * W + l]" for c in range(13)]


def _row(name: str, i: int, dense: bool, vector: tuple[str, ...]) -> str:
    """Row ``i`` of a 6 x 6 matrix, dense or diagonal, times a vector."""
    if not dense:
        return f"m[({name} + {i}) * W + l] * {vector[i]}"
    return " + ".join(f"m[({name} + {6 * i + j}) * W + l] * {v}" for j, v in enumerate(vector))
