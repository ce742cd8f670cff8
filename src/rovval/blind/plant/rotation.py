"""Unit quaternions ``w x y z`` that turn body vectors into the world, in plain floats (the right-hand side calls them).

Equations: Fossen 2021, section 2.2.2 (unit quaternions); Euler angles are zyx.
"""

from __future__ import annotations

import math

Matrix = tuple[float, float, float, float, float, float, float, float, float]


def matrix(w: float, x: float, y: float, z: float) -> Matrix:
    """Rotation matrix body to world, row by row, of a quaternion of any length but zero."""
    s = 2.0 / (w * w + x * x + y * y + z * z)
    return (
        1.0 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y),
        s * (x * y + w * z), 1.0 - s * (x * x + z * z), s * (y * z - w * x),
        s * (x * z - w * y), s * (y * z + w * x), 1.0 - s * (x * x + y * y),
    )  # fmt: skip


def euler(w: float, x: float, y: float, z: float) -> tuple[float, float, float]:
    """Roll, pitch, yaw (rad) of a quaternion; yaw in -pi to pi."""
    r = matrix(w, x, y, z)
    return math.atan2(r[7], r[8]), math.asin(max(-1.0, min(1.0, -r[6]))), math.atan2(r[3], r[0])


def quaternion(phi: float, theta: float, psi: float) -> tuple[float, float, float, float]:
    """Quaternion of Euler zyx angles (rad)."""
    a, b, c = math.cos(phi / 2), math.cos(theta / 2), math.cos(psi / 2)
    d, e, f = math.sin(phi / 2), math.sin(theta / 2), math.sin(psi / 2)
    return a * b * c + d * e * f, d * b * c - a * e * f, a * e * c + d * b * f, a * b * f - d * e * c


def to_body(r: Matrix, x: float, y: float, z: float) -> tuple[float, float, float]:
    """World vector seen from the body."""
    return r[0] * x + r[3] * y + r[6] * z, r[1] * x + r[4] * y + r[7] * z, r[2] * x + r[5] * y + r[8] * z


def to_world(r: Matrix, x: float, y: float, z: float) -> tuple[float, float, float]:
    """Body vector seen from the world."""
    return r[0] * x + r[1] * y + r[2] * z, r[3] * x + r[4] * y + r[5] * z, r[6] * x + r[7] * y + r[8] * z


def wrap(angle: float) -> float:
    """Angle brought into -pi to pi."""
    return math.remainder(angle, math.tau)
