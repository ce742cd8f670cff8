"""Thrusters, navigation, its velocity log, its attitude and its depth sensor are stamped by clocks, or after processing, that are apart."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rovval.core.frames import wrap
from rovval.effects.delay import delayed
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes
from rovval.effects.log import Log

EFFECT = Effect(
    name="time_offset",
    title="Time offset",
    place="sensor",
    equation="n_acting(t) = n_logged(t - tau), linear between samples, held at the log's ends (diagnosis.md S1). Positive: navigation is "
    "stamped late. time_offset[velocity]: u v w logged = u v w (t - delay), late against thrusters and all other navigation. "
    "time_offset[attitude]: so are phi theta psi and p q r, the attitude sensor's (AHRS); time_offset[depth]: so is z. A window begins at the "
    "measured state; the true one there is simulated from it, forward or back (`plant.late`), and that of depth goes on at its rate.",
    parameters=(
        Parameter("tau", "s", -2.0, 2.0, 0.0, 0.1, "+-0.5 s (diagnosis.md S1)"),
        Parameter("delay", "s", -1.5, 1.5, 0.0, 0.2, "+-0.5 s (diagnosis.md S1)", target="velocity"),
        Parameter("delay", "s", -1.5, 1.5, 0.0, 0.2, "+-0.5 s (diagnosis.md S1)", target="attitude"),
        Parameter("delay", "s", -1.5, 1.5, 0.0, 0.2, "+-0.5 s (diagnosis.md S1)", target="depth", needs="w"),
    ),
    signature="the answer comes early or late by the same time on every axis; [velocity]: u v w late, p q r and attitude not; "
    "[attitude]: the reverse; [depth]: depth late in a dive",
    confused_with=("thrust_lag", "clock_drift", "velocity_filter_lag", "added_mass"),
    separates="an offset delays without smoothing; it can be negative; position and depth show a delay of velocities or attitude alone, a measured "
    "heave velocity one of depth: without it a late depth is any force that lifts",
)
# Parameters by whose sum a sensor is late, and what it writes of u v w p q r x y z phi theta psi (`plant.late`).
LATE = {("delay[velocity]",): (0, 1, 2), ("delay[attitude]",): (3, 4, 5, 9, 10, 11), ("delay[depth]",): (8,)}


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """Shift the thruster log."""
    return replace(lanes, shift=lanes.shift + p["tau"])


def observe(log: Log, p: Mapping[str, Array]) -> Log:
    """Velocities of the velocity log, attitude and rates of the attitude sensor, and depth, of their ``delay`` ago."""
    for (parameter,), columns in LATE.items():
        if p[parameter].any():
            state = np.concatenate([log.nu, log.eta], axis=-1)
            state[..., 9:] = np.unwrap(state[..., 9:], axis=1)
            state[..., columns] = delayed(state[..., columns], p[parameter] / log.dt)
            log = replace(log, nu=state[..., :6], eta=np.concatenate([state[..., 6:9], wrap(state[..., 9:])], axis=-1))
    return log


def unobserve(nu: Array, eta: Array, p: Mapping[str, Array]) -> tuple[Array, Array]:
    """What was measured: the plant simulates what has not been logged yet."""
    return nu, eta
