"""Thrusters, navigation, its velocity log, its attitude and its depth sensor are stamped by clocks, or after processing, that are apart."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from rovval.effects import Effect, Parameter
from rovval.effects._lanes import Array, Lanes
from rovval.frames import euler_rates, rotation_from_euler, wrap

if TYPE_CHECKING:
    from rovval.plant.sensors import Log

EFFECT = Effect(
    name="time_offset",
    title="Time offset",
    place="sensor",
    equation="n_acting(t) = n_logged(t - tau), linear between samples, held at the log's ends (diagnosis.md S1). Positive: navigation is "
    "stamped late. time_offset[velocity]: u v w logged = u v w (t - delay), late against thrusters and all other navigation. "
    "time_offset[attitude]: so are phi theta psi and p q r, the attitude sensor's (AHRS); time_offset[depth]: so is z. A window begins at the "
    "measured state; the true one there is that plus the delay times the model's acceleration and the measured turn and dive rates.",
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
# The plant adds each delay times the first acceleration to the first true velocities (`plant.model`).
SETTLES = {"delay[velocity]": slice(0, 3), "delay[attitude]": slice(3, 6)}


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """Shift the thruster log."""
    return replace(lanes, shift=lanes.shift + p["tau"])


def observe(log: Log, p: Mapping[str, Array]) -> Log:
    """Velocities of the velocity log, attitude and rates of the attitude sensor, and depth, of their ``delay`` ago."""
    for parameter, part in SETTLES.items():
        if p[parameter].any():
            nu = log.nu.copy()
            nu[..., part] = _late(nu[..., part], log.nu0[:, part], p[parameter] / log.dt)
            log = replace(log, nu=nu)
    if p["delay[attitude]"].any():
        eta = log.eta.copy()
        eta[..., 3:] = wrap(_late(np.unwrap(eta[..., 3:], axis=1), log.eta0[:, 3:], p["delay[attitude]"] / log.dt, wrap))
        log = replace(log, eta=eta)
    if p["delay[depth]"].any():
        eta = log.eta.copy()
        eta[..., 2:3] = _late(eta[..., 2:3], log.eta0[:, 2:3], p["delay[depth]"] / log.dt)
        log = replace(log, eta=eta)
    return log


def unobserve(nu: Array, eta: Array, p: Mapping[str, Array]) -> tuple[Array, Array]:
    """The measured velocities, to which the plant adds what has not been logged yet, and the measured attitude and depth taken on at their rates."""
    turned = p["delay[attitude]"][:, None] * euler_rates(eta[:, 3:], nu[:, 3:])
    dived = p["delay[depth]"] * np.einsum("bj,bj->b", rotation_from_euler(eta[:, 3:])[:, 2], nu[:, :3])
    return nu, np.concatenate([eta[:, :2], eta[:, 2:3] + dived[:, None], eta[:, 3:] + turned], axis=-1)


def _late(true: Array, measured: Array, late: Array, gap: Callable[[Array], Array] = np.asarray) -> Array:
    """Values (B, n, c) of ``late`` (B,) samples ago: linear from the ``measured`` first one (B, c) to the true first one, then between
    samples; one that is early goes on along its last slope. ``gap`` makes a difference one of angles."""
    last = true.shape[1] - 1
    sample = np.arange(last + 1)
    seen = true.copy()
    for delay in np.unique(late[late != 0]):  # a diagnosis asks for few delays in many lanes
        lanes = np.flatnonzero(late == delay)
        x = sample - delay
        low = np.clip(x.astype(np.int64), 0, max(last - 1, 0))
        before, after = true[lanes][:, low], true[lanes][:, np.minimum(low + 1, last)]
        seen[lanes] = before + (after - before) * (x - low)[:, None]
        early = np.flatnonzero(x < 0)
        first = true[lanes, :1]
        seen[np.ix_(lanes, early)] = first + gap(measured[lanes, None] - first) * (1.0 - sample[early] / delay)[:, None]
    return seen
