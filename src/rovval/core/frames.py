"""The only rotations. Body axes forward-starboard-down, world axes north-east-down (SNAME, Fossen 2021).

Angles are Euler zyx (roll ``phi``, pitch ``theta``, yaw ``psi``) in rad; quaternions are ``w x y z`` and rotate body vectors
into the world. Every function works on stacks: the last axis (or last two) holds the components.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Forward-left-up <-> forward-starboard-down, and east-north-up <-> north-east-down (REP-103). Both are their own inverse.
FLU_TO_FSD: Array = np.diag([1.0, -1.0, -1.0])
ENU_TO_NED: Array = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])
for _matrix in (FLU_TO_FSD, ENU_TO_NED):
    _matrix.setflags(write=False)


def wrap(angle: Array | float) -> Array:
    """Angle in (-pi, pi]."""
    return np.asarray(np.pi - np.mod(np.pi - np.asarray(angle, dtype=float), 2.0 * np.pi))


def skew(v: Array) -> Array:
    """S(v) with S(v) a = v x a (Fossen 2021, equation 2.10). Shape (..., 3) -> (..., 3, 3)."""
    v = np.asarray(v, dtype=float)
    zero = np.zeros(v.shape[:-1])
    rows = [
        [zero, -v[..., 2], v[..., 1]],
        [v[..., 2], zero, -v[..., 0]],
        [-v[..., 1], v[..., 0], zero],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def rotation_from_euler(euler: Array) -> Array:
    """Body-to-world matrix R (thesis 3.7; Fossen 2021, 2.31). Shape (..., 3) -> (..., 3, 3)."""
    return rotation_from_quaternion(quaternion_from_euler(euler))


def quaternion_from_euler(euler: Array) -> Array:
    """Unit quaternion w x y z of Euler zyx angles. Shape (..., 3) -> (..., 4)."""
    half = 0.5 * np.asarray(euler, dtype=float)
    (cr, cp, cy), (sr, sp, sy) = np.moveaxis(np.cos(half), -1, 0), np.moveaxis(np.sin(half), -1, 0)
    return np.stack(
        [
            cr * cp * cy + sr * sp * sy,
            sr * cp * cy - cr * sp * sy,
            cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy,
        ],
        axis=-1,
    )


def rotation_from_quaternion(q: Array) -> Array:
    """Body-to-world matrix of a unit quaternion (Fossen 2021, 2.72). Shape (..., 4) -> (..., 3, 3)."""
    w, x, y, z = np.moveaxis(np.asarray(q, dtype=float), -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def euler_from_quaternion(q: Array) -> Array:
    """Euler zyx angles of a unit quaternion; at pitch +-90 degrees roll and yaw share one rotation and roll takes it."""
    r = rotation_from_quaternion(q)
    theta = np.arcsin(np.clip(-r[..., 2, 0], -1.0, 1.0))
    phi = np.arctan2(r[..., 2, 1], r[..., 2, 2])
    psi = np.arctan2(r[..., 1, 0], r[..., 0, 0])
    return np.stack([phi, theta, psi], axis=-1)


def euler_rates(euler: Array, omega: Array) -> Array:
    """Euler angle rates of body rates p q r (thesis 3.9; Fossen 2021, 2.39). Singular at pitch +-90 degrees."""
    phi, theta = euler[..., 0], euler[..., 1]
    p, q, r = np.moveaxis(np.asarray(omega, dtype=float), -1, 0)
    turn = np.sin(phi) * q + np.cos(phi) * r
    return np.stack(
        [p + np.tan(theta) * turn, np.cos(phi) * q - np.sin(phi) * r, turn / np.cos(theta)], axis=-1
    )
