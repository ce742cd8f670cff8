"""The log's velocities went through a low-pass filter."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from rovval.effects import Effect, Parameter
from rovval.effects._lanes import Array

if TYPE_CHECKING:
    from rovval.plant.sensors import Log

EFFECT = Effect(
    name="velocity_filter_lag",
    title="Low-pass of the velocity log",
    place="sensor",
    equation="tau dy/dt = v - y on u v w, exact for a v that is linear between samples (diagnosis.md S8). The filter begins a window at the "
    "measured velocity; the true one there is that plus tau times the model's acceleration.",
    parameters=(Parameter("tau", "s", 0.0, 3.0, 0.0, 0.2, "0.1 to 1 s (diagnosis.md S8)"),),
    signature="u v w late and rounded, p q r and attitude not",
    confused_with=("thrust_lag", "time_offset", "added_mass"),
    separates="an accelerometer; the gyros, which are not filtered",
)
SETTLES = {"tau": slice(0, 3)}  # the plant adds tau times the first acceleration to the first true velocity (`plant.model`)


def observe(log: Log, p: Mapping[str, Array]) -> Log:
    """Velocities after the filter, which starts at the measured ones."""
    tau = p["tau"][:, None]
    on = tau > 0
    decay = np.where(on, np.exp(-log.dt / np.where(on, tau, 1.0)), 0.0)
    seen = np.empty_like(log.nu[..., :3])
    seen[:, 0] = np.where(on, log.nu0[:, :3], log.nu[:, 0, :3])
    for j in range(1, seen.shape[1]):
        before, now = log.nu[:, j - 1, :3], log.nu[:, j, :3]
        slope = (now - before) / log.dt * tau
        seen[:, j] = now - slope + (seen[:, j - 1] - before + slope) * decay
    return replace(log, nu=np.concatenate([seen, log.nu[..., 3:]], axis=-1))


def unobserve(nu: Array, eta: Array, p: Mapping[str, Array]) -> tuple[Array, Array]:
    """The measured velocity; the plant adds what the filter has not let through yet."""
    return nu, eta
