"""Thrusters, navigation and its velocity log are stamped by clocks, or after processing, that are apart."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from rovval.effects import Effect, Parameter
from rovval.effects._lanes import Array, Lanes

if TYPE_CHECKING:
    from rovval.plant.sensors import Log

EFFECT = Effect(
    name="time_offset",
    title="Time offset",
    place="sensor",
    equation="n_acting(t) = n_logged(t - tau), linear between samples, held at the log's ends (diagnosis.md S1). Positive: navigation is "
    "stamped late. time_offset[velocity]: u v w logged = u v w (t - delay), late against thrusters and all other navigation. A window begins "
    "at the measured velocity; the true one there is that plus the delay times the model's acceleration.",
    parameters=(
        Parameter("tau", "s", -2.0, 2.0, 0.0, 0.1, "+-0.5 s (diagnosis.md S1)"),
        Parameter("delay", "s", -1.5, 1.5, 0.0, 0.2, "+-0.5 s (diagnosis.md S1)", target="velocity"),
    ),
    signature="the answer comes early or late by the same time on every axis; [velocity]: u v w late, p q r and attitude not",
    confused_with=("thrust_lag", "clock_drift", "velocity_filter_lag", "added_mass"),
    separates="an offset delays without smoothing; it can be negative; position and depth show a delay of the velocities alone",
)
SETTLES = "delay"  # the plant adds the delay times the first acceleration to the first true velocity (`plant.model`)


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """Shift the thruster log."""
    return replace(lanes, shift=lanes.shift + p["tau"])


def observe(log: Log, p: Mapping[str, Array]) -> Log:
    """Velocities of ``delay`` ago: linear from the measured first one to the true first one, then between samples; one that is early
    goes on along its last slope."""
    if not p["delay"].any():
        return log
    v, last = log.nu[..., :3], log.nu.shape[1] - 1
    late = p["delay"][:, None] / log.dt
    sample = np.arange(last + 1)
    x = sample - late
    low = np.clip(x.astype(np.int64), 0, max(last - 1, 0))
    before, after = (np.take_along_axis(v, i[..., None], axis=1) for i in (low, np.minimum(low + 1, last)))
    seen = before + (after - before) * (x - low)[..., None]
    rising = (sample / np.where(late > 0, late, 1.0))[..., None]
    first = log.nu0[:, None, :3]
    seen = np.where((x < 0)[..., None], first + (v[:, :1] - first) * rising, seen)
    return replace(log, nu=np.concatenate([np.where(late[..., None] != 0, seen, v), log.nu[..., 3:]], axis=-1))


def unobserve(nu: Array, eta: Array, p: Mapping[str, Array]) -> tuple[Array, Array]:
    """The measured velocity; the plant adds what has not been logged yet."""
    return nu, eta
