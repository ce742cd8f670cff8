"""The equations of motion of one stage (thesis 3.10 to 3.15 in the velocity relative to the water, Fossen 2021, 8.4), and the stage after it.

M nu_dot + C_RB(nu) nu + C_A(nu_r) nu_r + D(nu_r) nu_r + g(eta) = tau, M = M_RB + M_A, and eta_dot = J(eta) nu with the attitude as a quaternion.
The Coriolis terms come from the momentum of body and added mass together (Kirchhoff; Fossen 2021, 3.57): linear s, angular t, force omega x s, moment
omega x t + nu x s. Weight and buoyancy are g(eta) (thesis 3.14).
"""

from __future__ import annotations

from rovval.plant.codegen.kernel.matrix import plus_product, product, symmetric_product
from rovval.plant.codegen.kernel.state import attitude, over_ground, rates, rotation, through_water, velocity

from rovval.plant.codegen.kernel.symbols import (  # isort: skip
    ADDED, DENSE, EXTRA, FLOW, FULL, LINEAR, MASS, QUADRATIC, RESTORING, STATE, THRUSTERS, Array, Lanes, W, unrolled,
)  # fmt: skip

Six = tuple[Lanes, Lanes, Lanes, Lanes, Lanes, Lanes]


def equations_of_motion(m: Array, tv: Array, xs: int, xn: int, reach: float, half: float) -> None:
    """Rate of the state in rows ``xs``, and the state ``reach`` seconds along it from the step's beginning into rows ``xn``."""
    for j in range(W):
        qw, qx, qy, qz = attitude(m, xs, j)
        u, v, w = velocity(m, xs, j)
        r_p, r_q, r_r = rates(m, xs, j)
        r11, r12, r13, r21, r22, r23, r31, r32, r33 = rotation(qw, qx, qy, qz)
        vn, ve, vd = over_ground(u, v, w, r11, r12, r13, r21, r22, r23, r31, r32, r33)
        if FULL:
            ur, vr, wr = through_water(m, u, v, w, j)
        else:
            ur, vr, wr = u, v, w
        k0, k1, k2 = vn, ve, vd
        k3, k4, k5, k6 = quaternion_rate(qw, qx, qy, qz, r_p, r_q, r_r)
        X, Y, Z, K, M, N = net_wrench(m, tv, j, u, v, w, r_p, r_q, r_r, ur, vr, wr, r31, r32, r33)
        k7 = symmetric_product(m, MASS + 10, 0, j, (X, Y, Z, K, M, N))
        k8 = symmetric_product(m, MASS + 10, 1, j, (X, Y, Z, K, M, N))
        k9 = symmetric_product(m, MASS + 10, 2, j, (X, Y, Z, K, M, N))
        k10 = symmetric_product(m, MASS + 10, 3, j, (X, Y, Z, K, M, N))
        k11 = symmetric_product(m, MASS + 10, 4, j, (X, Y, Z, K, M, N))
        k12 = symmetric_product(m, MASS + 10, 5, j, (X, Y, Z, K, M, N))
        rate = (k0, k1, k2, k3, k4, k5, k6, k7, k8, k9, k10, k11, k12)
        for c in unrolled(13):
            m[xn + c * W + j] = m[(STATE + c) * W + j] + (half if 3 <= c < 7 else reach) * rate[c]


def net_wrench(
    m: Array, tv: Array, j: int, u: Lanes, v: Lanes, w: Lanes, r_p: Lanes, r_q: Lanes, r_r: Lanes, ur: Lanes, vr: Lanes, wr: Lanes,
    r31: Lanes, r32: Lanes, r33: Lanes,
) -> Six:  # fmt: skip
    """All that accelerates the body: thrust and effects less drag, weight and buoyancy, Coriolis terms."""
    s1, s2, s3, t1, t2, t3 = momentum(m, j, u, v, w, r_p, r_q, r_r, ur, vr, wr)
    X, Y, Z, K, M, N = applied(m, tv, j)
    net = m[RESTORING * W + j]
    g1, g2, g3 = m[(RESTORING + 1) * W + j], m[(RESTORING + 2) * W + j], m[(RESTORING + 3) * W + j]
    X, Y, Z, K, M, N = without_drag(m, j, X, Y, Z, K, M, N, ur, vr, wr, r_p, r_q, r_r)
    X = X + net * r31 - r_q * s3 + r_r * s2
    Y = Y + net * r32 - r_r * s1 + r_p * s3
    Z = Z + net * r33 - r_p * s2 + r_q * s1
    K = K + g2 * r33 - g3 * r32 - r_q * t3 + r_r * t2 - v * s3 + w * s2
    M = M + g3 * r31 - g1 * r33 - r_r * t1 + r_p * t3 - w * s1 + u * s3
    N = N + g1 * r32 - g2 * r31 - r_p * t2 + r_q * t1 - u * s2 + v * s1
    return X, Y, Z, K, M, N


def quaternion_rate(qw: Lanes, qx: Lanes, qy: Lanes, qz: Lanes, r_p: Lanes, r_q: Lanes, r_r: Lanes) -> tuple[Lanes, Lanes, Lanes, Lanes]:
    """Twice the rate of the unit quaternion (Fossen 2021, section 2.2); the factor of one half is in ``half``."""
    k3 = -(qx * r_p + qy * r_q + qz * r_r)
    k4 = qw * r_p + qy * r_r - qz * r_q
    k5 = qw * r_q + qz * r_p - qx * r_r
    k6 = qw * r_r + qx * r_q - qy * r_p
    return k3, k4, k5, k6


def momentum(
    m: Array, j: int, u: Lanes, v: Lanes, w: Lanes, r_p: Lanes, r_q: Lanes, r_r: Lanes, ur: Lanes, vr: Lanes, wr: Lanes
) -> Six:
    """Linear (s) and angular (t) momentum of the body at nu and of the added mass at nu_r."""
    mass, c1, c2, c3 = m[MASS * W + j], m[(MASS + 1) * W + j], m[(MASS + 2) * W + j], m[(MASS + 3) * W + j]
    i11, i12, i13 = m[(MASS + 4) * W + j], m[(MASS + 5) * W + j], m[(MASS + 6) * W + j]
    i22, i23, i33 = m[(MASS + 7) * W + j], m[(MASS + 8) * W + j], m[(MASS + 9) * W + j]
    l1, l2, l3 = mass * u + r_q * c3 - r_r * c2, mass * v + r_r * c1 - r_p * c3, mass * w + r_p * c2 - r_q * c1
    h1 = c2 * w - c3 * v + i11 * r_p + i12 * r_q + i13 * r_r
    h2 = c3 * u - c1 * w + i12 * r_p + i22 * r_q + i23 * r_r
    h3 = c1 * v - c2 * u + i13 * r_p + i23 * r_q + i33 * r_r
    s1 = plus_product(l1, m, ADDED, 0, j, (ur, vr, wr, r_p, r_q, r_r))
    s2 = plus_product(l2, m, ADDED, 1, j, (ur, vr, wr, r_p, r_q, r_r))
    s3 = plus_product(l3, m, ADDED, 2, j, (ur, vr, wr, r_p, r_q, r_r))
    t1 = plus_product(h1, m, ADDED, 3, j, (ur, vr, wr, r_p, r_q, r_r))
    t2 = plus_product(h2, m, ADDED, 4, j, (ur, vr, wr, r_p, r_q, r_r))
    t3 = plus_product(h3, m, ADDED, 5, j, (ur, vr, wr, r_p, r_q, r_r))
    return s1, s2, s3, t1, t2, t3


def applied(m: Array, tv: Array, j: int) -> Six:
    """Wrench of the thrusters at rest, and of all that acts on the state."""
    if FLOW:
        X = tv[(3 * THRUSTERS + 0) * W + j] + m[(EXTRA + 0) * W + j]
        Y = tv[(3 * THRUSTERS + 1) * W + j] + m[(EXTRA + 1) * W + j]
        Z = tv[(3 * THRUSTERS + 2) * W + j] + m[(EXTRA + 2) * W + j]
        K = tv[(3 * THRUSTERS + 3) * W + j] + m[(EXTRA + 3) * W + j]
        M = tv[(3 * THRUSTERS + 4) * W + j] + m[(EXTRA + 4) * W + j]
        N = tv[(3 * THRUSTERS + 5) * W + j] + m[(EXTRA + 5) * W + j]
    else:
        X = tv[0 * W + j]
        Y = tv[1 * W + j]
        Z = tv[2 * W + j]
        K = tv[3 * W + j]
        M = tv[4 * W + j]
        N = tv[5 * W + j]
    return X, Y, Z, K, M, N


def without_drag(
    m: Array, j: int, X: Lanes, Y: Lanes, Z: Lanes, K: Lanes, M: Lanes, N: Lanes,
    ur: Lanes, vr: Lanes, wr: Lanes, r_p: Lanes, r_q: Lanes, r_r: Lanes,
) -> Six:  # fmt: skip
    """The wrench less D_l nu_r + D_q |nu_r| nu_r (thesis 3.13; Fossen 2021, section 6.4)."""
    if DENSE:
        e0, e1, e2 = abs(ur) * ur, abs(vr) * vr, abs(wr) * wr
        e3, e4, e5 = abs(r_p) * r_p, abs(r_q) * r_q, abs(r_r) * r_r
        X -= plus_product(product(m, LINEAR, 0, j, (ur, vr, wr, r_p, r_q, r_r)), m, QUADRATIC, 0, j, (e0, e1, e2, e3, e4, e5))
        Y -= plus_product(product(m, LINEAR, 1, j, (ur, vr, wr, r_p, r_q, r_r)), m, QUADRATIC, 1, j, (e0, e1, e2, e3, e4, e5))
        Z -= plus_product(product(m, LINEAR, 2, j, (ur, vr, wr, r_p, r_q, r_r)), m, QUADRATIC, 2, j, (e0, e1, e2, e3, e4, e5))
        K -= plus_product(product(m, LINEAR, 3, j, (ur, vr, wr, r_p, r_q, r_r)), m, QUADRATIC, 3, j, (e0, e1, e2, e3, e4, e5))
        M -= plus_product(product(m, LINEAR, 4, j, (ur, vr, wr, r_p, r_q, r_r)), m, QUADRATIC, 4, j, (e0, e1, e2, e3, e4, e5))
        N -= plus_product(product(m, LINEAR, 5, j, (ur, vr, wr, r_p, r_q, r_r)), m, QUADRATIC, 5, j, (e0, e1, e2, e3, e4, e5))
    else:
        X -= (m[(LINEAR + 0) * W + j] + m[(QUADRATIC + 0) * W + j] * abs(ur)) * ur
        Y -= (m[(LINEAR + 1) * W + j] + m[(QUADRATIC + 1) * W + j] * abs(vr)) * vr
        Z -= (m[(LINEAR + 2) * W + j] + m[(QUADRATIC + 2) * W + j] * abs(wr)) * wr
        K -= (m[(LINEAR + 3) * W + j] + m[(QUADRATIC + 3) * W + j] * abs(r_p)) * r_p
        M -= (m[(LINEAR + 4) * W + j] + m[(QUADRATIC + 4) * W + j] * abs(r_q)) * r_q
        N -= (m[(LINEAR + 5) * W + j] + m[(QUADRATIC + 5) * W + j] * abs(r_r)) * r_r
    return X, Y, Z, K, M, N
