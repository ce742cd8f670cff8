"""The law of a thruster's motor, thesis equation 2.4: V = (R_m / K_m) T + (K_E / sqrt(K_T)) sqrt(T), odd in T."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rovval.core.errors import BadInput

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class MotorLaw:
    """``resistive`` R_m / K_m in V/N and ``back_emf`` K_E / sqrt(K_T) in V/sqrt(N): equation 2.4 holds no more than these two. The fit's
    ``rms`` and ``largest`` error in V, over ``n`` points between ``lowest`` and ``highest`` thrust in N."""

    resistive: float
    back_emf: float
    rms: float
    largest: float
    n: int
    lowest: float
    highest: float

    def voltage(self, thrust: Array) -> Array:
        """V of T (N), odd in T."""
        size = np.abs(thrust)
        return np.asarray(np.sign(thrust) * (self.resistive * size + self.back_emf * np.sqrt(size)))

    def thrust(self, voltage: Array) -> Array:
        """T of V: the positive root of the quadratic in sqrt(T)."""
        size = np.abs(voltage)
        a, b = self.resistive, self.back_emf
        root = size / b if a == 0 else 2.0 * size / (b + np.sqrt(b * b + 4.0 * a * size))
        return np.asarray(np.sign(voltage) * root**2)

    def __str__(self) -> str:
        bound = [name for name, value in (("R_m/K_m", self.resistive), ("K_E/sqrt(K_T)", self.back_emf)) if value == 0]
        note = f"; {' and '.join(bound)} at its bound of 0: not identified by these points" if bound else ""
        return (
            f"V = {self.resistive:.4g} T + {self.back_emf:.4g} sqrt(T) (thesis 2.4), {self.n} points from {self.lowest:g} to {self.highest:g} N: "
            f"rms error {self.rms:.3f} V, largest {self.largest:.3f} V{note}"
        )


def fit(voltage: Array, thrust: Array) -> MotorLaw:
    """Least squares of equation 2.4 over points with thrust; both coefficients held at zero or above, as physics has them."""
    from scipy.optimize import nnls

    voltage, thrust = np.asarray(voltage, dtype=float), np.asarray(thrust, dtype=float)
    used = np.isfinite(voltage) & np.isfinite(thrust) & (thrust != 0)
    if used.sum() < 3:
        raise BadInput(f"{int(used.sum())} points with thrust: equation 2.4 needs 3 or more")
    v, size = voltage[used] * np.sign(thrust[used]), np.abs(thrust[used])
    (resistive, back_emf), _ = nnls(np.stack([size, np.sqrt(size)], axis=1), v)
    error = resistive * size + back_emf * np.sqrt(size) - v
    return MotorLaw(
        float(resistive), float(back_emf), float(np.sqrt(np.mean(error**2))), float(np.abs(error).max()), len(v),
        float(thrust[used].min()), float(thrust[used].max()),
    )  # fmt: skip
