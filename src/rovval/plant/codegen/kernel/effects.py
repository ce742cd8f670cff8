"""The effects' functions of the state, each a loop over lanes of its own, passed over where no lane of the block has it.

What they ask for of the state and the log is first copied to rows of its own (`motion_of_stage`). So these loops are functions by themselves, compiled
sooner than as a part of the loop over time, and LLVM need not check in them that what they write is not what they read.

What they leave behind is the water's velocity in the body frame (rows CURRENT) and one wrench (rows EXTRA), all zeros where nothing acts, so that
the rigid body's own loop is the nominal one to the last bit. What the flow takes from a thruster is such a wrench too.
"""

from __future__ import annotations

import math

from rovval.plant.codegen.kernel.matrix import plus_translation, product
from rovval.plant.codegen.kernel.state import attitude, over_ground, rates, rotation, through_water, velocity

from rovval.plant.codegen.kernel.symbols import (  # isort: skip
    ADDED, ADVANCE, ADVANCE_LIMIT, BODY, CURRENT, DISPLACED, EXPLICIT, EXTRA, FLOW, FULL, LOG_COUNT, LOGGED, MASS, MOTION, PAYLOAD_ROWS, STRIDE, THRUSTERS,
    WATER, Array, Lanes, W, any_at_work, any_reads_log, at_work, compiled_function, effect_value, effects_of, in_turn, pruned, spread, unrolled,
)  # fmt: skip
from rovval.plant.codegen.kernel.thrust import add_wrench, with_force


def loops_needed(acts: Array, b: int, use_extra: bool, pending: bool) -> tuple[bool, bool, bool, bool, bool, bool]:
    """Which loops block ``b`` needs: effects on speed and thrust at rest, on the water, of cross flow, of flow, on the state, and the log."""
    use_rest = any_at_work(acts, b, "acting", "static")
    use_water = any_at_work(acts, b, "water")
    use_cross = any_at_work(acts, b, "thrust", asks="cross")
    use_flow = ADVANCE or any_at_work(acts, b, "thrust")
    use_state = use_water or use_flow or any_at_work(acts, b, "wrench")
    use_log = use_extra or pending or any_reads_log(acts, b)
    return use_rest, use_water, use_cross, use_flow, use_state, use_log


def effects_on_state(
    m: Array, tv: Array, lv: Array, geo: Array, acts: Array, b: int, xs: int, use_state: bool, use_water: bool, use_cross: bool, use_flow: bool
) -> None:
    """Everything between the state of a stage and the rigid body's own loop."""
    if FULL:
        if use_state:
            clear(m, EXTRA, 6)
            motion_of_stage(m, lv, xs)
        if use_water:
            clear(m, WATER, 9)
            water(m, acts, b)
            force_of_water(m)
        if use_cross:
            cross_flow_past_thrusters(m, tv, geo)
        if use_flow and not use_cross:
            axial_flow_past_thrusters(m, tv, geo)
        if use_state:
            wrenches(m, acts, b)
    elif FLOW:
        clear(m, EXTRA, 6)
        motion_of_stage(m, lv, xs)
        axial_flow_past_thrusters(m, tv, geo)


def clear(m: Array, row: int, count: int) -> None:
    """Zeros in ``count`` rows."""
    for c in range(count * W):
        m[row * W + c] = 0.0


def motion_of_stage(m: Array, lv: Array, xs: int) -> None:
    """What effects may ask for at this stage: the state, the rotation and the velocity over ground (rows MOTION), the log (rows LOGGED)."""
    for c in range(13 * W):
        m[MOTION * W + c] = m[xs + c]
    if FULL:
        for c in range(LOG_COUNT * W):
            m[LOGGED * W + c] = lv[c]
        put_rotation(m, xs)


def put_rotation(m: Array, xs: int) -> None:
    """Rotation and velocity over ground into rows MOTION, after the state."""
    for j in range(W):
        qw, qx, qy, qz = attitude(m, xs, j)
        u, v, w = velocity(m, xs, j)
        r11, r12, r13, r21, r22, r23, r31, r32, r33 = rotation(qw, qx, qy, qz)
        vn, ve, vd = over_ground(u, v, w, r11, r12, r13, r21, r22, r23, r31, r32, r33)
        found = (r11, r12, r13, r21, r22, r23, r31, r32, r33, vn, ve, vd)
        for c in unrolled(12):
            m[(MOTION + 13 + c) * W + j] = found[c]


def rotation_of_stage(m: Array, j: int) -> tuple[Lanes, Lanes, Lanes, Lanes, Lanes, Lanes, Lanes, Lanes, Lanes]:
    """Rotation matrix from body to world, row by row."""
    return (
        m[(MOTION + 13) * W + j], m[(MOTION + 14) * W + j], m[(MOTION + 15) * W + j], m[(MOTION + 16) * W + j], m[(MOTION + 17) * W + j],
        m[(MOTION + 18) * W + j], m[(MOTION + 19) * W + j], m[(MOTION + 20) * W + j], m[(MOTION + 21) * W + j],
    )  # fmt: skip


def over_ground_of_stage(m: Array, j: int) -> tuple[Lanes, Lanes, Lanes]:
    """Velocity over ground, north east down."""
    return m[(MOTION + 22) * W + j], m[(MOTION + 23) * W + j], m[(MOTION + 24) * W + j]


@compiled_function
def water(m: Array, acts: Array, b: int) -> None:
    """Velocity of the water, its change along the vehicle's path and at a fixed point, all effects on it together (rows WATER)."""
    for effect in effects_of("water"):
        if at_work(acts, b, effect):
            for j in pruned(range(W)):
                u, v, w = velocity(m, MOTION * W, j)
                r_p, r_q, r_r = rates(m, MOTION * W, j)
                r11, r12, r13, r21, r22, r23, r31, r32, r33 = rotation_of_stage(m, j)
                vn, ve, vd = over_ground_of_stage(m, j)
                change = effect_value(
                    "water", effect, m, j, u=u, v=v, w=w, vn=vn, ve=ve, vd=vd, p=r_p, q=r_q, r=r_r,
                    x=m[MOTION * W + j], y=m[(MOTION + 1) * W + j], z=m[(MOTION + 2) * W + j],
                    r11=r11, r12=r12, r13=r13, r21=r21, r22=r22, r23=r23, r31=r31, r32=r32, r33=r33,
                )  # fmt: skip
                for c in unrolled(9):
                    m[(WATER + c) * W + j] += change[c]


@compiled_function
def force_of_water(m: Array) -> None:
    """Water's velocity in the body frame (rows CURRENT); its pressure gradient on the displaced volume, the added mass of its acceleration, and what
    it changes of C_A(nu_r) nu_r, as a wrench (rows EXTRA). Fossen 2021, 10.3: M_A d(nu_c)/dt + C_A, with d(nu_c)/dt = R^T dv/dt - omega x nu_c."""
    for j in range(W):
        u, v, w = velocity(m, MOTION * W, j)
        r_p, r_q, r_r = rates(m, MOTION * W, j)
        r11, r12, r13, r21, r22, r23, r31, r32, r33 = rotation_of_stage(m, j)
        cn, ce, cd, dn, de, dd, fn, fe, fd = (
            m[(WATER + 0) * W + j], m[(WATER + 1) * W + j], m[(WATER + 2) * W + j], m[(WATER + 3) * W + j], m[(WATER + 4) * W + j],
            m[(WATER + 5) * W + j], m[(WATER + 6) * W + j], m[(WATER + 7) * W + j], m[(WATER + 8) * W + j],
        )  # fmt: skip
        cx = r11 * cn + r21 * ce + r31 * cd
        cy = r12 * cn + r22 * ce + r32 * cd
        cz = r13 * cn + r23 * ce + r33 * cd
        dx = r11 * dn + r21 * de + r31 * dd
        dy = r12 * dn + r22 * de + r32 * dd
        dz = r13 * dn + r23 * de + r33 * dd
        fx = r11 * fn + r21 * fe + r31 * fd
        fy = r12 * fn + r22 * fe + r32 * fd
        fz = r13 * fn + r23 * fe + r33 * fd
        m[(CURRENT + 0) * W + j] = cx
        m[(CURRENT + 1) * W + j] = cy
        m[(CURRENT + 2) * W + j] = cz
        ur, vr, wr = u - cx, v - cy, w - cz
        wx, wy, wz = dx - (r_q * cz - r_r * cy), dy - (r_r * cx - r_p * cz), dz - (r_p * cy - r_q * cx)
        if EXPLICIT:  # the filtered acceleration is that relative to the water: the water's own is in it
            wx, wy, wz = 0.0, 0.0, 0.0
        a0 = product(m, ADDED, 0, j, (ur, vr, wr, r_p, r_q, r_r))
        a1 = product(m, ADDED, 1, j, (ur, vr, wr, r_p, r_q, r_r))
        a2 = product(m, ADDED, 2, j, (ur, vr, wr, r_p, r_q, r_r))
        m[(EXTRA + 0) * W + j] += plus_translation(m[DISPLACED * W + j] * fx, m, ADDED, 0, j, wx, wy, wz)
        m[(EXTRA + 1) * W + j] += plus_translation(m[DISPLACED * W + j] * fy, m, ADDED, 1, j, wx, wy, wz)
        m[(EXTRA + 2) * W + j] += plus_translation(m[DISPLACED * W + j] * fz, m, ADDED, 2, j, wx, wy, wz)
        m[(EXTRA + 3) * W + j] += plus_translation(
            m[(DISPLACED + 2) * W + j] * fz - m[(DISPLACED + 3) * W + j] * fy + cy * a2 - cz * a1, m, ADDED, 3, j, wx, wy, wz
        )
        m[(EXTRA + 4) * W + j] += plus_translation(
            m[(DISPLACED + 3) * W + j] * fx - m[(DISPLACED + 1) * W + j] * fz + cz * a0 - cx * a2, m, ADDED, 4, j, wx, wy, wz
        )
        m[(EXTRA + 5) * W + j] += plus_translation(
            m[(DISPLACED + 1) * W + j] * fy - m[(DISPLACED + 2) * W + j] * fx + cx * a1 - cy * a0, m, ADDED, 5, j, wx, wy, wz
        )


@compiled_function
def axial_flow_past_thrusters(m: Array, tv: Array, geo: Array) -> None:
    """As `flow_past_thrusters`, where no lane of the block asks for the cross flow."""
    flow_past_thrusters(m, tv, spread(geo, 16 * THRUSTERS), False)


@compiled_function
def cross_flow_past_thrusters(m: Array, tv: Array, geo: Array) -> None:
    """As `flow_past_thrusters`, cross flow and all."""
    flow_past_thrusters(m, tv, spread(geo, 16 * THRUSTERS), True)


def flow_past_thrusters(m: Array, tv: Array, g: tuple[float, ...], cross_flow: bool) -> None:
    """What the flow past the thrusters changes of their thrust at rest, as a wrench (rows EXTRA): K_T(J_a) / K_T(0) by the advance ratio
    J_a = u_a / (n D), a cubic for each sense (``g``, after the place), then the effects'."""
    for j in range(W):
        u, v, w = velocity(m, MOTION * W, j)
        r_p, r_q, r_r = rates(m, MOTION * W, j)
        if FULL:
            ur, vr, wr = through_water(m, u, v, w, j)
        else:
            ur, vr, wr = u, v, w
        X = Y = Z = K = M = N = 0.0
        for i in unrolled(THRUSTERS):
            rest, n = tv[3 * i * W + j], tv[(3 * i + 1) * W + j]
            vx, vy, vz = (
                ur + r_q * g[16 * i + 2] - r_r * g[16 * i + 1],
                vr + r_r * g[16 * i + 0] - r_p * g[16 * i + 2],
                wr + r_p * g[16 * i + 1] - r_q * g[16 * i + 0],
            )
            ua = m[(BODY + i * STRIDE + 2) * W + j] * vx + m[(BODY + i * STRIDE + 3) * W + j] * vy + m[(BODY + i * STRIDE + 4) * W + j] * vz
            T = rest
            if ADVANCE:
                J = min(max(ua * tv[(3 * i + 2) * W + j], -ADVANCE_LIMIT), ADVANCE_LIMIT)
                ahead = 1.0 + J * (g[16 * i + 3] + J * (g[16 * i + 4] + J * g[16 * i + 5]))
                astern = 1.0 + J * (g[16 * i + 6] + J * (g[16 * i + 7] + J * g[16 * i + 8]))
                T = T * (ahead if n > 0.0 else astern)
            if cross_flow:
                aside = vx * vx + vy * vy + vz * vz - ua * ua
                cross = math.sqrt(0.5 * (aside + abs(aside)))
                T = in_turn("thrust", T, m, i, j, n=n, ua=ua, cross=cross)
            else:
                T = in_turn("thrust", T, m, i, j, skip="cross", n=n, ua=ua)
            change = T - rest
            X, Y, Z, K, M, N = with_force(m, i, j, change, X, Y, Z, K, M, N)
        add_wrench(m, EXTRA, j, X, Y, Z, K, M, N)


@compiled_function
def wrenches(m: Array, acts: Array, b: int) -> None:
    """Forces and moments of all effects that have one (rows EXTRA)."""
    for effect in effects_of("wrench"):
        if at_work(acts, b, effect):
            for j in pruned(range(W)):
                u, v, w = velocity(m, MOTION * W, j)
                r_p, r_q, r_r = rates(m, MOTION * W, j)
                r11, r12, r13, r21, r22, r23, r31, r32, r33 = rotation_of_stage(m, j)
                vn, ve, vd = over_ground_of_stage(m, j)
                ur, vr, wr = through_water(m, u, v, w, j)
                force = effect_value(
                    "wrench", effect, m, j, u=u, v=v, w=w, ur=ur, vr=vr, wr=wr, vn=vn, ve=ve, vd=vd, p=r_p, q=r_q, r=r_r,
                    cn=m[WATER * W + j], ce=m[(WATER + 1) * W + j], cd=m[(WATER + 2) * W + j],
                    x=m[MOTION * W + j], y=m[(MOTION + 1) * W + j], z=m[(MOTION + 2) * W + j],
                    r11=r11, r12=r12, r13=r13, r21=r21, r22=r22, r23=r23, r31=r31, r32=r32, r33=r33,
                )  # fmt: skip
                for c in unrolled(6):
                    m[(EXTRA + c) * W + j] += force[c]


def take_payload(m: Array, late: Array, onset: Array, b: int, time: int, lg: Array) -> None:
    """Mass numbers of the lanes whose payload is there at this time (index of its row in ``lg``)."""
    for j in range(W):
        if lg[time + j] >= onset[b, j]:
            for c in range(PAYLOAD_ROWS):
                m[(MASS + c) * W + j] = late[b, c * W + j]
