"""The state of a stage as loops over lanes read it: rows from ``xs`` on hold x y z, q_wxyz, u v w p q r."""

from __future__ import annotations

from rovval.plant.codegen.kernel.symbols import CURRENT, Array, Lanes, W

Three = tuple[Lanes, Lanes, Lanes]


def attitude(m: Array, xs: int, j: int) -> tuple[Lanes, Lanes, Lanes, Lanes]:
    """Unit quaternion from body to world."""
    return m[xs + 3 * W + j], m[xs + 4 * W + j], m[xs + 5 * W + j], m[xs + 6 * W + j]


def velocity(m: Array, xs: int, j: int) -> Three:
    """Velocity over ground in the body frame, m/s."""
    return m[xs + 7 * W + j], m[xs + 8 * W + j], m[xs + 9 * W + j]


def rates(m: Array, xs: int, j: int) -> Three:
    """Angular velocity in the body frame, rad/s."""
    return m[xs + 10 * W + j], m[xs + 11 * W + j], m[xs + 12 * W + j]


def rotation(
    qw: Lanes, qx: Lanes, qy: Lanes, qz: Lanes
) -> tuple[Lanes, Lanes, Lanes, Lanes, Lanes, Lanes, Lanes, Lanes, Lanes]:
    """Rotation matrix from body to world, row by row (thesis 3.7, of a unit quaternion: Fossen 2021, section 2.2)."""
    x2, y2, z2 = qx + qx, qy + qy, qz + qz
    yy, xx = 1.0 - qy * y2, 1.0 - qx * x2
    xy, xz, yz = qx * y2, qx * z2, qy * z2
    r11, r12, r13 = yy - qz * z2, xy - qw * z2, xz + qw * y2
    r21, r22, r23 = xy + qw * z2, xx - qz * z2, yz - qw * x2
    r31, r32, r33 = xz - qw * y2, yz + qw * x2, xx - qy * y2
    return r11, r12, r13, r21, r22, r23, r31, r32, r33


def over_ground(
    u: Lanes, v: Lanes, w: Lanes, r11: Lanes, r12: Lanes, r13: Lanes, r21: Lanes, r22: Lanes, r23: Lanes, r31: Lanes, r32: Lanes, r33: Lanes
) -> Three:
    """Velocity over ground, north east down: the position's rate (thesis 3.6)."""
    vn = r11 * u + r12 * v + r13 * w
    ve = r21 * u + r22 * v + r23 * w
    vd = r31 * u + r32 * v + r33 * w
    return vn, ve, vd


def through_water(m: Array, u: Lanes, v: Lanes, w: Lanes, j: int) -> Three:
    """Velocity relative to the water in the body frame (Fossen 2021, 8.4)."""
    cx, cy, cz = m[CURRENT * W + j], m[(CURRENT + 1) * W + j], m[(CURRENT + 2) * W + j]
    ur, vr, wr = u - cx, v - cy, w - cz
    return ur, vr, wr
