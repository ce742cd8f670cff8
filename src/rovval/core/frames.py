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

EULER_RANGE = 1.0  # rad of pitch up to which rates and differences of Euler angles are those of the vehicle to within a factor of two: 1 / cos(1) = 1.9


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
    w, x, y, z = np.moveaxis(np.asarray(q, dtype=float), -1, 0)  # the five elements of `rotation_from_quaternion` that it takes
    theta = np.arcsin(np.clip(-2 * (x * z - y * w), -1.0, 1.0))
    phi = np.arctan2(2 * (y * z + x * w), 1 - 2 * (x * x + y * y))
    psi = np.arctan2(2 * (x * y + z * w), 1 - 2 * (y * y + z * z))
    return np.stack([phi, theta, psi], axis=-1)


def euler_rates(euler: Array, omega: Array) -> Array:
    """Euler angle rates of body rates p q r (thesis 3.9; Fossen 2021, 2.39). Singular at pitch +-90 degrees."""
    phi, theta = euler[..., 0], euler[..., 1]
    p, q, r = np.moveaxis(np.asarray(omega, dtype=float), -1, 0)
    turn = np.sin(phi) * q + np.cos(phi) * r
    return np.stack(
        [p + np.tan(theta) * turn, np.cos(phi) * q - np.sin(phi) * r, turn / np.cos(theta)], axis=-1
    )


def tumbles(theta: Array) -> bool:
    """Whether a motion of pitch angles ``theta`` (rad; NaN where unknown) leaves the range in which differences of Euler angles mean a turn."""
    return bool((np.abs(theta) > EULER_RANGE).any())


def rotation_vector(q: Array) -> Array:
    """Axis times angle (rad, at most pi) of a unit quaternion (Sola 2017). Shape (..., 4) -> (..., 3)."""
    w, axis = np.abs(q[..., :1]), q[..., 1:] * np.where(q[..., :1] < 0, -1.0, 1.0)
    sine = np.linalg.norm(axis, axis=-1, keepdims=True)
    return np.asarray(axis * np.where(sine > 1e-12, 2.0 * np.arctan2(sine, w) / np.maximum(sine, 1e-12), 2.0))


def turned(euler: Array, by: Array) -> Array:
    """Euler angles (..., 3) of the attitude ``euler`` (..., 3) turned ``by`` a rotation vector (..., 3) in its own body axes: what `attitude_difference`
    of the two gives back."""
    p, half = quaternion_from_euler(euler), 0.5 * np.linalg.norm(by, axis=-1, keepdims=True)
    c, v = np.cos(half), 0.5 * np.sinc(half / np.pi) * by
    w = p[..., :1] * c - (p[..., 1:] * v).sum(axis=-1, keepdims=True)
    return euler_from_quaternion(np.concatenate([w, p[..., :1] * v + c * p[..., 1:] + np.cross(p[..., 1:], v)], axis=-1))


def attitude_difference(a: Array, b: Array) -> Array:
    """The turn from attitude ``b`` to ``a``, both Euler angles (..., 3), as a rotation vector (..., 3) in the body axes of ``b``, rad.

    Of a vehicle that is nearly level: the differences of roll, pitch and yaw. It is regular at every pitch.
    """
    p, q = quaternion_from_euler(b), quaternion_from_euler(a)
    w = p[..., :1] * q[..., :1] + (p[..., 1:] * q[..., 1:]).sum(axis=-1, keepdims=True)
    vector = p[..., :1] * q[..., 1:] - q[..., :1] * p[..., 1:] - np.cross(p[..., 1:], q[..., 1:])
    return rotation_vector(np.concatenate([w, vector], axis=-1))


def tilt_difference(a: Array, b: Array) -> Array:
    """The shortest turn that brings the vertical of attitude ``b`` to that of ``a``, both Euler angles (..., 3), whatever their headings, as a rotation
    vector (..., 3) in the body axes of ``b``, rad. Of a vehicle that is nearly level: the differences of roll and pitch, and 0."""
    down_a, down_b = _down(a), _down(b)
    axis = np.cross(down_a, down_b)
    sine, cosine = np.linalg.norm(axis, axis=-1, keepdims=True), (down_a * down_b).sum(axis=-1, keepdims=True)
    return np.asarray(axis * np.where(sine > 1e-12, np.arctan2(sine, cosine) / np.maximum(sine, 1e-12), 1.0))


def _down(euler: Array) -> Array:
    """Body components (..., 3) of the unit vector that points down (Fossen 2021, 2.31, third row)."""
    phi, theta = euler[..., 0], euler[..., 1]
    return np.stack([-np.sin(theta), np.sin(phi) * np.cos(theta), np.cos(phi) * np.cos(theta)], axis=-1)


def smooth_quaternions(euler: Array) -> Array:
    """Unit quaternions (..., n, 4) of series of Euler angles (..., n, 3), of the two signs that mean one attitude the one nearer to the sample before, so
    that they can be averaged and interpolated. NaN where an angle is."""
    q = quaternion_from_euler(euler)
    turned_over = np.einsum("...i,...i->...", q[..., 1:, :], q[..., :-1, :]) < 0.0
    if not turned_over.any():
        return q
    sign = np.where(np.cumsum(turned_over, axis=-1) % 2, -1.0, 1.0)
    return np.concatenate([q[..., :1, :], q[..., 1:, :] * sign[..., None]], axis=-2)
