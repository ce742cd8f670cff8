"""Motor and drive of a thruster: a speed loop with integral action, a load that grows with the square of speed, limited slew.

    n' = S tanh(((c - n)/tau + x - droop n|n|/(tau n_max)) / S),   x' = (c - n) / (10 tau^2)

with c the set-point and n the shaft speed in rpm. Form and numbers are chosen; the log records n, so only its shape matters.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from rovval.blind.plant.scales import Scales
from rovval.blind.plant.spec import Array

TAU_WORK_S = 0.25  # chosen: hydraulic or large electric thruster
TAU_SMALL_S = 0.08  # slow pole of the published BlueROV2 thruster, 0.076 s (von Benzon 2022)
DROOP = 0.10  # chosen: share of full speed that the load costs an open loop


class Drive(Protocol):
    """Anything that can turn the shafts."""

    def derivative(self, command: Array, y: Array, out: Array, at: int, many: int) -> None:
        """Write the rates of speed and integral of every unit into ``out``."""


@dataclass(frozen=True, slots=True)
class Motor:
    """Time constants (s) of each unit, the speed limit (rpm) and the slew limit (rpm/s)."""

    tau: Array
    limit: float
    slew: float

    def derivative(self, command: Array, y: Array, out: Array, at: int, many: int) -> None:
        """Write n' and x' of every unit into ``out``."""
        n, x = y[at : at + many], y[at + many : at + 2 * many]
        gap = command - n
        want = gap / self.tau + x - (DROOP / self.limit) * n * np.abs(n) / self.tau
        out[at : at + many] = self.slew * np.tanh(want / self.slew)
        out[at + many : at + 2 * many] = gap / (10.0 * self.tau**2)


def motor(scale: Scales, many: int, rng: np.random.Generator) -> Motor:
    """The drive of one vehicle; units differ by a tenth."""
    tau = TAU_WORK_S if scale.work_class else TAU_SMALL_S
    spread = 1.0 + 0.1 * np.clip(rng.standard_normal(many), -2.0, 2.0)
    return Motor(tau * spread, scale.rpm_limit, 2.0 * scale.rpm_limit / (4.0 * tau))
