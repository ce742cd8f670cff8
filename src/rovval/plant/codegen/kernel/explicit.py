"""One step of a physics engine to which added mass is a force like any other (`rovval.plant.platforms.uuv`).

The engine knows the rigid body alone. Added mass enters as the force -M_A a of a low-pass filtered relative acceleration of the steps before, and the
step is semi-implicit Euler: new velocity from the forces at its beginning, new position from the new velocity.
"""

from __future__ import annotations

from rovval.plant.codegen.kernel.body import Six, net_wrench, quaternion_rate
from rovval.plant.codegen.kernel.matrix import product, symmetric_product
from rovval.plant.codegen.kernel.state import attitude, over_ground, rates, rotation, through_water, velocity

from rovval.plant.codegen.kernel.symbols import (  # isort: skip
    ADDED, BEFORE, FILTERED, FULL, MASS, SETTLING, SHARE, STATE, Array, Lanes, W, compiled_function, unrolled,
)  # fmt: skip


def explicit_step(m: Array, tv: Array, h: float, inverse_h: float) -> None:
    """State after a step of ``h`` (s) into the rows after its own; ``inverse_h`` is 1 / h, and 0 in a lane's first step, which has none before it: there
    the filter has settled, which is where its own steps take it under forces that stay."""
    if inverse_h == 0.0:
        for _ in range(SETTLING):
            settle(m, tv)
    for j in range(W):
        qw, qx, qy, qz = attitude(m, STATE * W, j)
        u, v, w = velocity(m, STATE * W, j)
        r_p, r_q, r_r = rates(m, STATE * W, j)
        r11, r12, r13, r21, r22, r23, r31, r32, r33 = rotation(qw, qx, qy, qz)
        if FULL:
            ur, vr, wr = through_water(m, u, v, w, j)
        else:
            ur, vr, wr = u, v, w
        if inverse_h > 0.0:
            take_acceleration(m, j, inverse_h, ur, vr, wr, r_p, r_q, r_r)
        remember(m, j, ur, vr, wr, r_p, r_q, r_r)
        X, Y, Z, K, M, N = net_wrench(m, tv, j, u, v, w, r_p, r_q, r_r, ur, vr, wr, r31, r32, r33)
        X, Y, Z, K, M, N = without_added_mass(m, j, X, Y, Z, K, M, N)
        n7 = u + h * symmetric_product(m, MASS + 10, 0, j, (X, Y, Z, K, M, N))
        n8 = v + h * symmetric_product(m, MASS + 10, 1, j, (X, Y, Z, K, M, N))
        n9 = w + h * symmetric_product(m, MASS + 10, 2, j, (X, Y, Z, K, M, N))
        n10 = r_p + h * symmetric_product(m, MASS + 10, 3, j, (X, Y, Z, K, M, N))
        n11 = r_q + h * symmetric_product(m, MASS + 10, 4, j, (X, Y, Z, K, M, N))
        n12 = r_r + h * symmetric_product(m, MASS + 10, 5, j, (X, Y, Z, K, M, N))
        vn, ve, vd = over_ground(n7, n8, n9, r11, r12, r13, r21, r22, r23, r31, r32, r33)
        k3, k4, k5, k6 = quaternion_rate(qw, qx, qy, qz, n10, n11, n12)
        n0, n1, n2 = m[STATE * W + j] + h * vn, m[(STATE + 1) * W + j] + h * ve, m[(STATE + 2) * W + j] + h * vd
        n3, n4, n5, n6 = qw + 0.5 * h * k3, qx + 0.5 * h * k4, qy + 0.5 * h * k5, qz + 0.5 * h * k6
        new = (n0, n1, n2, n3, n4, n5, n6, n7, n8, n9, n10, n11, n12)
        for c in unrolled(13):
            m[(STATE + 13 + c) * W + j] = new[c]


@compiled_function
def settle(m: Array, tv: Array) -> None:
    """One step of the filter towards the acceleration that body and added mass have together under the forces at hand."""
    for j in range(W):
        qw, qx, qy, qz = attitude(m, STATE * W, j)
        u, v, w = velocity(m, STATE * W, j)
        r_p, r_q, r_r = rates(m, STATE * W, j)
        _, _, _, _, _, _, r31, r32, r33 = rotation(qw, qx, qy, qz)
        if FULL:
            ur, vr, wr = through_water(m, u, v, w, j)
        else:
            ur, vr, wr = u, v, w
        X, Y, Z, K, M, N = net_wrench(m, tv, j, u, v, w, r_p, r_q, r_r, ur, vr, wr, r31, r32, r33)
        X, Y, Z, K, M, N = without_added_mass(m, j, X, Y, Z, K, M, N)
        for c in unrolled(6):
            m[(FILTERED + c) * W + j] += SHARE * (symmetric_product(m, MASS + 10, c, j, (X, Y, Z, K, M, N)) - m[(FILTERED + c) * W + j])


def take_acceleration(
    m: Array, j: int, inverse_h: float, ur: Lanes, vr: Lanes, wr: Lanes, r_p: Lanes, r_q: Lanes, r_r: Lanes
) -> None:
    """Rate of the relative velocity since the step before, of which each step takes a share into the filter's memory."""
    now = (ur, vr, wr, r_p, r_q, r_r)
    for c in unrolled(6):
        m[(FILTERED + c) * W + j] += SHARE * ((now[c] - m[(BEFORE + c) * W + j]) * inverse_h - m[(FILTERED + c) * W + j])


def remember(m: Array, j: int, ur: Lanes, vr: Lanes, wr: Lanes, r_p: Lanes, r_q: Lanes, r_r: Lanes) -> None:
    """The relative velocity, for the next step."""
    now = (ur, vr, wr, r_p, r_q, r_r)
    for c in unrolled(6):
        m[(BEFORE + c) * W + j] = now[c]


def without_added_mass(m: Array, j: int, X: Lanes, Y: Lanes, Z: Lanes, K: Lanes, M: Lanes, N: Lanes) -> Six:
    """The wrench less M_A times the filtered acceleration."""
    a1, a2, a3 = m[FILTERED * W + j], m[(FILTERED + 1) * W + j], m[(FILTERED + 2) * W + j]
    a4, a5, a6 = m[(FILTERED + 3) * W + j], m[(FILTERED + 4) * W + j], m[(FILTERED + 5) * W + j]
    X = X - product(m, ADDED, 0, j, (a1, a2, a3, a4, a5, a6))
    Y = Y - product(m, ADDED, 1, j, (a1, a2, a3, a4, a5, a6))
    Z = Z - product(m, ADDED, 2, j, (a1, a2, a3, a4, a5, a6))
    K = K - product(m, ADDED, 3, j, (a1, a2, a3, a4, a5, a6))
    M = M - product(m, ADDED, 4, j, (a1, a2, a3, a4, a5, a6))
    N = N - product(m, ADDED, 5, j, (a1, a2, a3, a4, a5, a6))
    return X, Y, Z, K, M, N
