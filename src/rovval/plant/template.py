"""The plant's equations as the batch kernel has them, as text with places for the effects' functions.

Thesis 3.10 to 3.15 in the velocity relative to the water (Fossen 2021, 8.4), Runge-Kutta 4 over ``x y z, q_wxyz, u v w p q r``. Thruster
speeds are taken at the stage times: frozen over the step they make the whole scheme first order (measured). Lines that end in
``#full`` and the like are kept only in such kernels; ``<<name>>`` is replaced by generated lines.
"""

from __future__ import annotations

from rovval.plant import compose
from rovval.plant.compose import Spec, calls, layout

SPEED_LIMIT = 20.0  # m/s; no ROV comes near it (design: limits)
RATE_LIMIT = 30.0  # rad/s
ADVANCE_LIMIT = 1.0  # |J_a| beyond which the cubic K_T is held: open-water series end near there, and a cubic turns up again
NU_R = ("ur", "vr", "wr", "r_p", "r_q", "r_r")
FORCE = tuple("XYZKMN")
WATER = ("cn", "ce", "cd", "dn", "de", "dd", "fn", "fe", "fd")


def render(spec: Spec) -> str:
    """The kernel's source for ``spec``."""
    where, k = layout(spec), spec.thrusters
    numbers = {
        "W": compose.W, "THRUSTERS": k, "THS": (3 * k + 6) * compose.W, "BODY": where.body_rows,
        "STRIDE": where.stride, "ROWS": where.rows, "LOGS": compose.LOG_ROWS,
        "MASS": where.first["mass"],
        "RESTORING": where.first["restoring"], "DISPLACED": where.first["displaced"], "ADDED": where.first["added"],
        "LINEAR": where.first["linear"], "QUADRATIC": where.first["quadratic"], "LAG": where.first["lag"], "SHIFT": where.first["shift"],
        "JET": where.first["jet"], "PAYLOAD": compose.MASS_ROWS, "V2": SPEED_LIMIT**2, "W2": RATE_LIMIT**2, "JMAX": ADVANCE_LIMIT,
        **_state_rows(where.rows, k),
    }  # fmt: skip
    kept = "\n".join(_kept(TEXT, spec))
    generated = {
        "numbers": [f"{name} = {value!r}" for name, value in numbers.items()],
        "speed": calls(spec, "speed", ("n",), False, "(BODY + i * STRIDE)"),
        "at_rest": _at_rest(spec),
        "water": calls(spec, "water", WATER, True),
        "thrusters": _thrusters(spec),
        "side": _side(spec),
        "wrench": calls(spec, "wrench", FORCE, True),
        "added": _matvec("a", "ADDED", NU_R, spec.dense),
        "drag": _drag(spec.dense),
        "water_acceleration": _added_dot(spec.dense) if spec.full else [],
        "acceleration": _acceleration(),
        "geometry": [f"g_{c} = geo[{c}]" for c in range(16 * k)] if spec.full or spec.advance else [],
        "advance_state": _advance_state(),
    }
    lines = []
    for line in kept.splitlines():
        bare = line.strip()
        if bare.startswith("<<"):
            indent = line[: len(line) - len(line.lstrip())]
            lines += [indent + new for new in generated[bare[2:-2]]]
        else:
            lines.append(line)
    return "\n".join(lines) + "\n"


def _state_rows(first: int, k: int) -> dict[str, int]:
    """Rows of state and scratch, which follow the lane's numbers in the same array: LLVM then proves without checks at run time
    that what a loop writes is not what it reads."""
    sizes = {"X0": 13, "XS": 13, "ACC": 13, "SEEN": 3, "ENDS": 2 * k, "MEMORY": k, "NEXT": k, "ALIVE": 1}
    rows = {}
    for name, size in sizes.items():
        rows[name] = first
        first += size
    return {**rows, "TOTAL": first}


def _kept(text: str, spec: Spec) -> list[str]:
    """Lines without a mark, and those whose mark holds: ``#full`` ``#nominal`` ``#advance`` ``#state`` (thrust depends on motion) ``#rest``."""
    state = spec.full or spec.advance
    marks = {"full": spec.full, "nominal": not spec.full, "advance": spec.advance, "state": state, "rest": not state}
    kept = []
    for line in text.splitlines():
        code, _, mark = line.rpartition("  #")
        if mark in marks:
            if marks[mark]:
                kept.append(code)
        else:
            kept.append(line)
    return kept


def _at_rest(spec: Spec) -> list[str]:
    """Acting speed and thrust at rest in the water of every thruster at one stage time."""
    lines: list[str] = []
    state = spec.full or spec.advance
    for i in range(spec.thrusters):
        row = f"(BODY + {i} * STRIDE)"
        lines += [f"a = m[(ENDS + {i}) * W + l]", f"d = m[(ENDS + THRUSTERS + {i}) * W + l] - a", "n = a + d * f"]
        if spec.full:
            lines += [
                "slope = d * inv_dt * tau",
                f"n = n - slope + (m[(MEMORY + {i}) * W + l] - (a + d * f0) + slope) * left",
                f"m[(NEXT + {i}) * W + l] = n",
            ]
        lines += calls(spec, "acting", ("n",), False, row)
        lines += ["ahead, astern = 0.5 * (abs(n) + n), 0.5 * (abs(n) - n)"]
        lines += [f"T = m[{row} * W + l] * ahead * ahead - m[({row} + 1) * W + l] * astern * astern"]
        lines += calls(spec, "static", ("T",), False, row)
        if state:
            lines += [f"tv[{3 * i} * W + l] = T", f"tv[{3 * i + 1} * W + l] = n"]
            if spec.advance:
                lines += [f"tv[{3 * i + 2} * W + l] = n / (g_{16 * i + 15} * (n * n + 1e-12))"]
        else:
            lines += [f"{name} {'+=' if i else '='} T * m[({row} + {2 + c}) * W + l]" for c, name in enumerate(FORCE)]
    if not state:
        lines += [f"tv[{c} * W + l] = {name}" for c, name in enumerate(FORCE)]
    return lines


def _thrusters(spec: Spec) -> list[str]:
    """Wrench of all thrusters under way, or as it stands where thrust does not depend on the motion."""
    if not (spec.full or spec.advance):
        return [f"{name} = tv[{c} * W + l]" for c, name in enumerate(FORCE)]
    lines = [f"{name} = tv[{3 * spec.thrusters + c} * W + l]" if spec.full else f"{name} = 0.0" for c, name in enumerate(FORCE)]
    for i in range(spec.thrusters):
        row = f"(BODY + {i} * STRIDE)"
        lines += [
            f"T, n = tv[{3 * i} * W + l], tv[{3 * i + 1} * W + l]",
            f"vx, vy, vz = ur + r_q * g_{16 * i + 2} - r_r * g_{16 * i + 1}, vr + r_r * g_{16 * i + 0} - r_p * g_{16 * i + 2}, "
            f"wr + r_p * g_{16 * i + 1} - r_q * g_{16 * i + 0}",
            f"ua = m[({row} + 2) * W + l] * vx + m[({row} + 3) * W + l] * vy + m[({row} + 4) * W + l] * vz",
        ]
        if spec.advance:
            lines += [f"J = min(max(ua * tv[{3 * i + 2} * W + l], -JMAX), JMAX)"]
            for name, first in (("ahead", 0), ("astern", 3)):
                c1, c2, c3 = (f"g_{16 * i + 3 + first + c}" for c in range(3))
                lines += [f"{name} = 1.0 + J * ({c1} + J * ({c2} + J * {c3}))"]
            lines += ["T = T * (ahead if n > 0.0 else astern)"]
        if spec.full:
            lines += ["rest = vx * vx + vy * vy + vz * vz - ua * ua", "cross = math.sqrt(0.5 * (rest + abs(rest)))"]
        lines += calls(spec, "thrust", ("T",), False, row)
        lines += [f"{name} += T * m[({row} + {2 + c}) * W + l]" for c, name in enumerate(FORCE)]
    return lines


def _side(spec: Spec) -> list[str]:
    """Side wrench of all thrusters at one stage time, from their thrust at rest."""
    if not spec.full:
        return []
    lines = [f"{name} = 0.0" for name in FORCE]
    for i in range(spec.thrusters):
        lines += [f"S = abs(tv[{3 * i} * W + l]) * m[(JET + THRUSTERS) * W + l]", *(f"{name} += S * g_{16 * i + 9 + c}" for c, name in enumerate(FORCE))]
    return lines + [f"tv[{3 * spec.thrusters + c} * W + l] = {name}" for c, name in enumerate(FORCE)]


def _entry(name: str, i: int, j: int) -> str:
    return f"m[({name} + {6 * i + j}) * W + l]"


def _matvec(out: str, name: str, vector: tuple[str, ...], dense: bool) -> list[str]:
    if not dense:
        return [f"{out}{i} = m[({name} + {i}) * W + l] * {vector[i]}" for i in range(6)]
    return [f"{out}{i} = " + " + ".join(f"{_entry(name, i, j)} * {vector[j]}" for j in range(6)) for i in range(6)]


def _drag(dense: bool) -> list[str]:
    if not dense:
        return [f"d{i} = (m[(LINEAR + {i}) * W + l] + m[(QUADRATIC + {i}) * W + l] * abs({n})) * {n}" for i, n in enumerate(NU_R)]
    squares = tuple(f"s{j}" for j in range(6))
    first = [f"s{j} = abs({n}) * {n}" for j, n in enumerate(NU_R)]
    both = zip(_matvec("d", "LINEAR", NU_R, True), _matvec("d", "QUADRATIC", squares, True), strict=True)
    return first + [f"{a} + {b.partition(' = ')[2]}" for a, b in both]


def _added_dot(dense: bool) -> list[str]:
    """M_A times the acceleration of the water in the body frame, on the right-hand side."""
    if dense:
        return [f"{name} += " + " + ".join(f"{_entry('ADDED', i, j)} * {w}" for j, w in enumerate(("wx", "wy", "wz"))) for i, name in enumerate(FORCE)]
    return [f"{name} += m[(ADDED + {i}) * W + l] * {w}" for i, (name, w) in enumerate(zip(FORCE, ("wx", "wy", "wz"), strict=False))]


def _acceleration() -> list[str]:
    """M^-1 times force, the inverse symmetric."""
    place = {pair: 10 + n for n, pair in enumerate(compose.SYMMETRIC)}
    return [
        f"k{7 + i} = " + " + ".join(f"m[(MASS + {place[min(i, j), max(i, j)]}) * W + l] * {FORCE[j]}" for j in range(6)) for i in range(6)
    ]


def _advance_state() -> list[str]:
    """Runge-Kutta: the weighted sum, and the state at the next stage."""
    lines = []
    for c in range(13):
        lines += [f"m[(ACC + {c}) * W + l] += weight * k{c}", f"m[(XS + {c}) * W + l] = m[(X0 + {c}) * W + l] + reach * k{c}"]
    return lines


TEXT = '''"""Batch kernel, generated by rovval.plant.template: do not edit."""

import math

import numpy as np
from numba import njit

from rovval.plant.compiled import OPTIONS, _clip, _cos, _exp, _positive, _sin, _sqrt, aligned, atan2, load_log

<<numbers>>


@njit(**OPTIONS)
def logged(speed, t, start, step, m, end):
    """Logged thruster speeds (rev/s) at one end of a step, each lane at its own place in the log."""
    last = speed.shape[0] - 1
    for l in range(W):
        j = min(max(start[l] + step, 0), last)
        x = j - (m[SHIFT * W + l] + m[(SHIFT + 1) * W + l] * t[j])  #full
        x = min(max(x, 0.0), float(last))  #full
        j = min(int(x), max(last - 1, 0))  #full
        part = x - j  #full
        after = min(j + 1, last)  #full
        for i in range(THRUSTERS):
            n = speed[j, i]
            n = n + (speed[after, i] - n) * part  #full
            <<speed>>
            m[(ENDS + end * THRUSTERS + i) * W + l] = n


@njit(**OPTIONS)
def warm(speed, t, start, dt, hold, m):
    """Lagged speed of each thruster at the window's first sample, from the log's first sample or 40 time constants before."""
    longest, back = 0.0, 0
    for l in range(W):
        longest = max(longest, m[LAG * W + l])
    if longest > 0.0:
        for l in range(W):
            back = max(back, min(start[l], int(40.0 * longest / dt) + 1))
    logged(speed, t, start, -back, m, 0)
    for c in range(THRUSTERS * W):
        m[MEMORY * W + c] = m[ENDS * W + c]
    for step in range(-back, 0):
        logged(speed, t, start, step + 1, m, 1)
        for l in range(W):
            if start[l] + step < 0:
                continue
            tau = m[LAG * W + l]
            left = math.exp(-dt / tau) if tau > 0.0 else 0.0
            for i in range(THRUSTERS):
                a = m[(ENDS + i) * W + l]
                b = a if hold else m[(ENDS + THRUSTERS + i) * W + l]
                slope = (b - a) / dt * tau
                m[(MEMORY + i) * W + l] = b - slope + (m[(MEMORY + i) * W + l] - a + slope) * left
        for c in range(THRUSTERS * W):
            m[ENDS * W + c] = m[(ENDS + THRUSTERS) * W + c]
    for l in range(W):
        if start[l] == 0 or m[LAG * W + l] == 0.0:
            for i in range(THRUSTERS):
                m[(MEMORY + i) * W + l] = m[(ENDS + i) * W + l]


@njit(**OPTIONS)
def settle(m, stopped, reason, limit, least, step):
    """Take the new state (in ACC, its quaternion made of unit length) of every lane that is alive and sane."""
    for l in range(W):
        qw, qx, qy, qz = m[(ACC + 3) * W + l], m[(ACC + 4) * W + l], m[(ACC + 5) * W + l], m[(ACC + 6) * W + l]
        inverse = 1.0 / math.sqrt(qw * qw + qx * qx + qy * qy + qz * qz)
        m[(ACC + 3) * W + l], m[(ACC + 4) * W + l] = qw * inverse, qx * inverse
        m[(ACC + 5) * W + l], m[(ACC + 6) * W + l] = qy * inverse, qz * inverse
        u, v, w = m[(ACC + 7) * W + l], m[(ACC + 8) * W + l], m[(ACC + 9) * W + l]
        a, b, c = m[(ACC + 10) * W + l], m[(ACC + 11) * W + l], m[(ACC + 12) * W + l]
        far = abs(m[ACC * W + l]) + abs(m[(ACC + 1) * W + l]) + abs(m[(ACC + 2) * W + l])
        sane = (u * u + v * v + w * w < V2) & (a * a + b * b + c * c < W2) & (far < 1e12)
        m[XS * W + l] = m[ALIVE * W + l] if sane else 0.0
    for l in range(W // 4):  # a sum that stays a vector instruction
        m[(XS + 1) * W + l] = m[XS * W + l] + m[XS * W + W // 4 + l] + m[XS * W + W // 2 + l] + m[XS * W + 3 * W // 4 + l]
    alive = 0.0
    for l in range(W // 4):
        alive += m[(XS + 1) * W + l]
    if alive == float(W) and step < least:
        for c in range(13 * W):
            m[X0 * W + c] = m[ACC * W + c]
    else:
        stop(m, stopped, reason, limit, step)


@njit(**OPTIONS)
def stop(m, stopped, reason, limit, step):
    """Some lane of the block has stopped: it keeps its last state, with the step and the reason; the others go on."""
    for l in range(W):
        if step >= limit[l]:
            m[XS * W + l] = 0.0
        if m[XS * W + l] != m[ALIVE * W + l]:
            speed = m[(ACC + 7) * W + l] ** 2 + m[(ACC + 8) * W + l] ** 2 + m[(ACC + 9) * W + l] ** 2
            rate = m[(ACC + 10) * W + l] ** 2 + m[(ACC + 11) * W + l] ** 2 + m[(ACC + 12) * W + l] ** 2
            stopped[l] = step + 1
            reason[l] = 3
            if rate >= W2 and rate < math.inf:
                reason[l] = 2
            if speed >= V2 and speed < math.inf:
                reason[l] = 1
            if step >= limit[l]:
                reason[l] = 4
        m[ALIVE * W + l] = m[XS * W + l]
        if m[ALIVE * W + l] > 0.5:
            for c in range(13):
                m[(X0 + c) * W + l] = m[(ACC + c) * W + l]


@njit(**OPTIONS)
def record(m, out, sample, lane):
    """Velocity, position and Euler angles of the block's lanes into ``out`` (lanes, samples, 12)."""
    for l in range(W):
        qw, qx, qy, qz = m[(X0 + 3) * W + l], m[(X0 + 4) * W + l], m[(X0 + 5) * W + l], m[(X0 + 6) * W + l]
        r11, r21, r31 = 1.0 - 2.0 * (qy * qy + qz * qz), 2.0 * (qx * qy + qz * qw), 2.0 * (qx * qz - qy * qw)
        r32, r33 = 2.0 * (qy * qz + qx * qw), 1.0 - 2.0 * (qx * qx + qy * qy)
        m[SEEN * W + l] = atan2(r32, r33)
        m[(SEEN + 1) * W + l] = atan2(-r31, math.sqrt(r32 * r32 + r33 * r33))
        m[(SEEN + 2) * W + l] = atan2(r21, r11)
    for l in range(W):
        for c in range(6):
            out[lane + l, sample, c] = m[(X0 + 7 + c) * W + l]
        for c in range(3):
            out[lane + l, sample, 6 + c] = m[(X0 + c) * W + l]
            out[lane + l, sample, 9 + c] = m[(SEEN + c) * W + l]


@njit(**OPTIONS)
def run(first, last, numbers, late, onset, states, start, limit, which, gain, speed, log, t, extra, geo, pairs,
        weights, dt, hold, steps, substeps, out, stopped, reason):
    """Blocks ``first`` to ``last`` of W lanes each: time runs inside the block, so that its numbers stay in the cache."""
    h, inv_dt = dt / substeps, 1.0 / dt
    m, th = aligned(TOTAL * W), aligned(3 * THS)
    la, lg = aligned(2 * LOGS * W), aligned(3 * LOGS * W)
    <<geometry>>
    for b in range(first, last):
        for c in range(3 * THS):
            th[c] = 0.0
        for c in range(ROWS * W):
            m[c] = numbers[b, c]
        for c in range(13 * W):
            m[X0 * W + c] = states[b, c]
        use_extra, use_wake, use_side, pending, least = False, False, False, False, steps
        for l in range(W):
            m[ALIVE * W + l] = 1.0
            least = min(least, limit[b, l])
            use_extra = use_extra or which[b, l] >= 0
            for i in range(THRUSTERS):
                use_wake = use_wake or m[(JET + i) * W + l] != 0.0
            use_side = use_side or m[(JET + THRUSTERS) * W + l] != 0.0
            pending = pending or onset[b, l] < math.inf
        for c in range(2 * LOGS * W):
            la[c] = 0.0
        warm(speed, t, start[b], dt, hold, m)  #full
        record(m, out, 0, b * W)
        for step in range(steps):
            if step == 0 or hold:
                logged(speed, t, start[b], step, m, 0)
            else:
                for c in range(THRUSTERS * W):
                    m[ENDS * W + c] = m[(ENDS + THRUSTERS) * W + c]
            if hold:
                for c in range(THRUSTERS * W):
                    m[(ENDS + THRUSTERS) * W + c] = m[ENDS * W + c]
            else:
                logged(speed, t, start[b], step + 1, m, 1)
            load_log(log, t, extra, gain[b], which[b], start[b], step, dt, la, use_extra, W, LOGS)  #full
            for sub in range(substeps):
                f0, f1 = sub / substeps, (sub + 1) / substeps
                for s in range(3):  #full
                    f = f0 + (f1 - f0) * 0.5 * s  #full
                    for c in range(LOGS * W):  #full
                        lg[s * LOGS * W + c] = la[c] + (la[LOGS * W + c] - la[c]) * f  #full
                if pending:  #full
                    for l in range(W):  #full
                        if lg[4 * W + l] >= onset[b, l]:  #full
                            for c in range(PAYLOAD):  #full
                                m[(MASS + c) * W + l] = late[b, c * W + l]  #full
                again = 0
                if not hold and step + sub > 0:  # a step begins where the last one ended
                    again = 1
                    for c in range(THS):
                        th[c] = th[2 * THS + c]
                for s in range(again, 3):
                    f = f0 + (f1 - f0) * 0.5 * s
                    tv, lv = th[s * THS : (s + 1) * THS], lg[s * LOGS * W : (s + 1) * LOGS * W]
                    for l in range(W):
                        tau, left = m[LAG * W + l], m[(LAG + 1 + s) * W + l]  #full
                        <<at_rest>>
                    if use_wake:  #full
                        for c in range(pairs.shape[0]):  #full
                            row, other, first_row = 3 * pairs[c, 1] * W, 3 * pairs[c, 0] * W, (BODY + pairs[c, 1] * STRIDE) * W  #full
                            wa, ws, wake = weights[c, 0], weights[c, 1], (JET + pairs[c, 1]) * W  #full
                            for l in range(W):  #full
                                n, up = tv[row + W + l], tv[other + W + l]  #full
                                jet = (wa if up > 0.0 else ws) * min(abs(up), abs(n))  #full
                                own = 0.5 * (m[first_row + l] * (n + abs(n)) + m[first_row + W + l] * (n - abs(n)))  #full
                                tv[row + l] -= m[wake + l] * jet * own  #full
                    if use_side:  #full
                        for l in range(W):  #full
                            <<side>>
                for c in range(THRUSTERS * W):  #full
                    m[MEMORY * W + c] = m[NEXT * W + c]  #full
                for c in range(13 * W):
                    m[XS * W + c] = m[X0 * W + c]
                for c in range(13 * W):
                    m[ACC * W + c] = m[X0 * W + c]
                for stage in range(4):
                    s = (stage + 1) // 2
                    tv, lv = th[s * THS : (s + 1) * THS], lg[s * LOGS * W : (s + 1) * LOGS * W]
                    weight = h / 6.0 if stage == 0 or stage == 3 else h / 3.0
                    reach = 0.5 * h if stage < 2 else h
                    for l in range(W):
                        qw, qx, qy, qz = m[(XS + 3) * W + l], m[(XS + 4) * W + l], m[(XS + 5) * W + l], m[(XS + 6) * W + l]
                        u, v, w = m[(XS + 7) * W + l], m[(XS + 8) * W + l], m[(XS + 9) * W + l]
                        r_p, r_q, r_r = m[(XS + 10) * W + l], m[(XS + 11) * W + l], m[(XS + 12) * W + l]
                        r11, r12, r13 = 1.0 - 2.0 * (qy * qy + qz * qz), 2.0 * (qx * qy - qz * qw), 2.0 * (qx * qz + qy * qw)
                        r21, r22, r23 = 2.0 * (qx * qy + qz * qw), 1.0 - 2.0 * (qx * qx + qz * qz), 2.0 * (qy * qz - qx * qw)
                        r31, r32, r33 = 2.0 * (qx * qz - qy * qw), 2.0 * (qy * qz + qx * qw), 1.0 - 2.0 * (qx * qx + qy * qy)
                        vn, ve, vd = r11 * u + r12 * v + r13 * w, r21 * u + r22 * v + r23 * w, r31 * u + r32 * v + r33 * w
                        k0, k1, k2 = vn, ve, vd
                        k3 = -0.5 * (qx * r_p + qy * r_q + qz * r_r)
                        k4 = 0.5 * (qw * r_p + qy * r_r - qz * r_q)
                        k5 = 0.5 * (qw * r_q + qz * r_p - qx * r_r)
                        k6 = 0.5 * (qw * r_r + qx * r_q - qy * r_p)
                        ur, vr, wr = u, v, w  #nominal
                        cn, ce, cd, dn, de, dd, fn, fe, fd = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0  #full
                        <<water>>
                        cx, cy, cz = r11 * cn + r21 * ce + r31 * cd, r12 * cn + r22 * ce + r32 * cd, r13 * cn + r23 * ce + r33 * cd  #full
                        ur, vr, wr = u - cx, v - cy, w - cz  #full
                        <<thrusters>>
                        mass, c1, c2, c3 = m[MASS * W + l], m[(MASS + 1) * W + l], m[(MASS + 2) * W + l], m[(MASS + 3) * W + l]
                        i11, i12, i13 = m[(MASS + 4) * W + l], m[(MASS + 5) * W + l], m[(MASS + 6) * W + l]
                        i22, i23, i33 = m[(MASS + 7) * W + l], m[(MASS + 8) * W + l], m[(MASS + 9) * W + l]
                        l1, l2, l3 = mass * u + r_q * c3 - r_r * c2, mass * v + r_r * c1 - r_p * c3, mass * w + r_p * c2 - r_q * c1
                        h1 = c2 * w - c3 * v + i11 * r_p + i12 * r_q + i13 * r_r
                        h2 = c3 * u - c1 * w + i12 * r_p + i22 * r_q + i23 * r_r
                        h3 = c1 * v - c2 * u + i13 * r_p + i23 * r_q + i33 * r_r
                        <<added>>
                        K -= v * l3 - w * l2 + vr * a2 - wr * a1
                        M -= w * l1 - u * l3 + wr * a0 - ur * a2
                        N -= u * l2 - v * l1 + ur * a1 - vr * a0
                        <<drag>>
                        net = m[RESTORING * W + l]
                        g1, g2, g3 = m[(RESTORING + 1) * W + l], m[(RESTORING + 2) * W + l], m[(RESTORING + 3) * W + l]
                        X += net * r31 - d0 - (r_q * (l3 + a2) - r_r * (l2 + a1))
                        Y += net * r32 - d1 - (r_r * (l1 + a0) - r_p * (l3 + a2))
                        Z += net * r33 - d2 - (r_p * (l2 + a1) - r_q * (l1 + a0))
                        K += g2 * r33 - g3 * r32 - d3 - (r_q * (h3 + a5) - r_r * (h2 + a4))
                        M += g3 * r31 - g1 * r33 - d4 - (r_r * (h1 + a3) - r_p * (h3 + a5))
                        N += g1 * r32 - g2 * r31 - d5 - (r_p * (h2 + a4) - r_q * (h1 + a3))
                        wx = r11 * dn + r21 * de + r31 * dd - (r_q * cz - r_r * cy)  #full
                        wy = r12 * dn + r22 * de + r32 * dd - (r_r * cx - r_p * cz)  #full
                        wz = r13 * dn + r23 * de + r33 * dd - (r_p * cy - r_q * cx)  #full
                        <<water_acceleration>>
                        fx, fy, fz = r11 * fn + r21 * fe + r31 * fd, r12 * fn + r22 * fe + r32 * fd, r13 * fn + r23 * fe + r33 * fd  #full
                        X += m[DISPLACED * W + l] * fx + lv[5 * W + l]  #full
                        Y += m[DISPLACED * W + l] * fy + lv[6 * W + l]  #full
                        Z += m[DISPLACED * W + l] * fz + lv[7 * W + l]  #full
                        K += m[(DISPLACED + 2) * W + l] * fz - m[(DISPLACED + 3) * W + l] * fy + lv[8 * W + l]  #full
                        M += m[(DISPLACED + 3) * W + l] * fx - m[(DISPLACED + 1) * W + l] * fz + lv[9 * W + l]  #full
                        N += m[(DISPLACED + 1) * W + l] * fy - m[(DISPLACED + 2) * W + l] * fx + lv[10 * W + l]  #full
                        <<wrench>>
                        <<acceleration>>
                        <<advance_state>>
                settle(m, stopped[b], reason[b], limit[b], least, step)
            record(m, out, step + 1, b * W)
'''
