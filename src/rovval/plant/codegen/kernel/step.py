"""A block's state from one step to the next: the new state, lanes that stop, and what is written out."""

from __future__ import annotations

import math

from rovval.plant.codegen.kernel.symbols import (  # isort: skip
    ALIVE, CODE, EULER, EXPLICIT, RATE_LIMIT_2, SPEED_LIMIT_2, STATE, THIRD, Array, Lanes, W, compiled_function, unrolled,
)  # fmt: skip
from rovval.plant.codegen.runtime import atan2


@compiled_function
def take_step(m: Array, stopped: Array, reason: Array, step: int) -> None:
    """The state after a step out of those at its stages, its quaternion made of unit length, for every lane that is alive and sane. Others stop:
    1 too fast, 2 turns too fast, 3 not finite."""
    for j in range(W):
        n0, n1, n2 = after_step(m, 0, j), after_step(m, 1, j), after_step(m, 2, j)
        n3, n4, n5, n6 = after_step(m, 3, j), after_step(m, 4, j), after_step(m, 5, j), after_step(m, 6, j)
        n7, n8, n9 = after_step(m, 7, j), after_step(m, 8, j), after_step(m, 9, j)
        n10, n11, n12 = after_step(m, 10, j), after_step(m, 11, j), after_step(m, 12, j)
        inverse = 1.0 / math.sqrt(n3 * n3 + n4 * n4 + n5 * n5 + n6 * n6)
        n3, n4, n5, n6 = n3 * inverse, n4 * inverse, n5 * inverse, n6 * inverse
        speed, rate = n7 * n7 + n8 * n8 + n9 * n9, n10 * n10 + n11 * n11 + n12 * n12
        far = abs(n0) + abs(n1) + abs(n2)
        code = 2.0 if (rate >= RATE_LIMIT_2) & (rate < math.inf) else 3.0
        code = 1.0 if (speed >= SPEED_LIMIT_2) & (speed < math.inf) else code
        code = 0.0 if (speed < SPEED_LIMIT_2) & (rate < RATE_LIMIT_2) & (far < 1e12) else code
        alive = m[ALIVE * W + j]
        m[CODE * W + j] = code * alive
        go = (code == 0.0) & (alive > 0.5)
        new = (n0, n1, n2, n3, n4, n5, n6, n7, n8, n9, n10, n11, n12)
        for c in unrolled(13):
            m[(STATE + c) * W + j] = new[c] if go else m[(STATE + c) * W + j]
    for j in range(W // 4):  # a sum that stays a vector instruction
        m[(CODE + 1) * W + j] = m[CODE * W + j] + m[CODE * W + W // 4 + j] + m[CODE * W + W // 2 + j] + m[CODE * W + 3 * W // 4 + j]
    some = 0.0
    for j in range(W // 4):
        some += m[(CODE + 1) * W + j]
    if some > 0.0:
        for j in range(W):
            if m[CODE * W + j] > 0.0:
                stopped[j], reason[j], m[ALIVE * W + j] = step + 1, int(m[CODE * W + j]), 0.0


def after_step(m: Array, c: int, j: int) -> Lanes:
    """Number ``c`` of the state after a step, as the plant's scheme has it."""
    return m[(STATE + 13 + c) * W + j] if EXPLICIT else runge_kutta(m, c, j)


def runge_kutta(m: Array, c: int, j: int) -> Lanes:
    """Number ``c`` of the state after a step of the classical fourth-order scheme, from its beginning X and what the stages left: Y1 = X + h/2 k1,
    Y2 = X + h/2 k2, Y3 = X + h k3, Y4 = X - h/2 k4, 13 rows each, one store a number. Then
    X + h/6 (k1 + 2 k2 + 2 k3 + k4) = X + ((Y1 - Y4) + (Y3 - X) + 2 (Y2 - X)) / 3."""
    return m[(STATE + c) * W + j] + THIRD * (
        ((m[(STATE + c + 13) * W + j] - m[(STATE + c + 52) * W + j]) + (m[(STATE + c + 39) * W + j] - m[(STATE + c) * W + j]))
        + 2.0 * (m[(STATE + c + 26) * W + j] - m[(STATE + c) * W + j])
    )


@compiled_function
def halt(m: Array, stopped: Array, reason: Array, limit: Array, step: int) -> None:
    """Lanes whose thruster speeds end here stop with their last state (reason 4); the others of the block go on."""
    for j in range(W):
        if step >= limit[j] and m[ALIVE * W + j] > 0.5:
            stopped[j], reason[j], m[ALIVE * W + j] = step + 1, 4, 0.0


@compiled_function
def record(m: Array, out: Array, sample: int, lane: int) -> None:
    """Velocity, position and Euler angles of the block's lanes into ``out`` (lanes, samples, 12), ``lane`` the first of them."""
    for j in range(W):
        qw, qx, qy, qz = m[(STATE + 3) * W + j], m[(STATE + 4) * W + j], m[(STATE + 5) * W + j], m[(STATE + 6) * W + j]
        r11, r21, r31 = 1.0 - 2.0 * (qy * qy + qz * qz), 2.0 * (qx * qy + qz * qw), 2.0 * (qx * qz - qy * qw)
        r32, r33 = 2.0 * (qy * qz + qx * qw), 1.0 - 2.0 * (qx * qx + qy * qy)
        m[EULER * W + j] = atan2(r32, r33)
        m[(EULER + 1) * W + j] = atan2(-r31, math.sqrt(r32 * r32 + r33 * r33))
        m[(EULER + 2) * W + j] = atan2(r21, r11)
    for j in range(W):
        for c in range(6):
            out[lane + j, sample, c] = m[(STATE + 7 + c) * W + j]
        for c in range(3):
            out[lane + j, sample, 6 + c] = m[(STATE + c) * W + j]
            out[lane + j, sample, 9 + c] = m[(EULER + c) * W + j]
