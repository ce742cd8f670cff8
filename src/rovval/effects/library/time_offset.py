"""Thrusters, navigation, its velocity log, its attitude and its depth sensor are stamped by clocks, or after processing, that are apart."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rovval.core.frames import euler_from_quaternion, smooth_quaternions
from rovval.effects.delay import delayed
from rovval.effects.effect import Effect, Parameter, Tolerance
from rovval.effects.lanes import Array, Lanes
from rovval.effects.log import Log

CLOCKS = Tolerance(0.05, "s: half a sample at 10 Hz", calibrated=False)

EFFECT = Effect(
    name="time_offset",
    title="Time offset",
    place="sensor",
    equation="n_acting(t) = n_logged(t - tau), linear between samples, held at the log's ends. Positive: navigation is stamped late. "
    "time_offset[velocity]: u v w logged = u v w (t - delay), late against thrusters and all other navigation; "
    "time_offset[attitude]: so are phi theta psi and p q r, the attitude sensor's (AHRS); time_offset[depth]: so is z. A window begins at the "
    "measured state; the true one there is simulated from it, forward or back, and that of depth goes on at its rate.",
    symbols={
        "n_acting, n_logged": "shaft speeds that act and that are logged; rev/s",
        "u v w, p q r": "velocities and rates, body axes; m/s, rad/s",
        "phi theta psi, z": "attitude (rad) and depth (m), north-east-down",
        "tau, delay": "offset of the stamps; s",
        "t": "time since the run's start; s",
    },
    parameters=(
        Parameter("tau", "s", -2.0, 2.0, 0.0, 0.2, "+-0.5 s (chosen)", tolerance=CLOCKS, error="delay"),
        Parameter("delay", "s", -1.5, 1.5, 0.0, 0.2, "+-0.5 s (chosen)", target="velocity", tolerance=CLOCKS, error="delay"),
        Parameter("delay", "s", -1.5, 1.5, 0.0, 0.2, "+-0.5 s (chosen)", target="attitude", tolerance=CLOCKS, error="delay"),
        # No tolerance: half a sample of it moves a depth by less than its check is held to see.
        Parameter("delay", "s", -1.5, 1.5, 0.0, 0.2, "+-0.5 s (chosen)", target="depth", needs="w", error="delay"),
    ),
    signature="the answer comes early or late by the same time on every axis; [velocity]: u v w late, p q r and attitude not; "
    "[attitude]: the reverse; [depth]: depth late in a dive",
    confused_with=("thrust_lag", "clock_drift", "velocity_filter_lag", "added_mass"),
    separates="an offset delays without smoothing; it can be negative; position and depth show a delay of velocities or attitude alone, a measured "
    "heave velocity one of depth: without it a late depth is any force that lifts",
    literature=(
        "Knapp and Carter 1976: time delay by generalised correlation",
        "Furgale 2013: temporal calibration of several sensors",
        "Klein and Morelli 2006: data compatibility of flight measurements",
    ),
    far=(-4.0, -2.0, 2.0, 4.0),  # commands that came a second late and step from one level to the next show no useful slope (chosen)
    stage="delay",
)
FULL_KERNEL = True
# Parameters by whose sum a sensor is late, and what it writes of u v w p q r x y z phi theta psi (`plant.sensor_delay`).
LATE = {("delay[velocity]",): (0, 1, 2), ("delay[attitude]",): (3, 4, 5, 9, 10, 11), ("delay[depth]",): (8,)}


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """Shift the thruster log."""
    return replace(lanes, shift=lanes.shift + p["tau"])


def observe(log: Log, p: Mapping[str, Array]) -> Log:
    """Velocities of the velocity log, attitude and rates of the attitude sensor, and depth, of their ``delay`` ago."""
    nu, eta = log.nu.copy(), log.eta.copy()
    for parameter, columns in (("delay[velocity]", nu[..., :3]), ("delay[attitude]", nu[..., 3:]), ("delay[depth]", eta[..., 2:3])):
        lanes = np.flatnonzero(p[parameter])
        columns[lanes] = delayed(columns[lanes], p[parameter][lanes] / log.dt)
    lanes = np.flatnonzero(p["delay[attitude]"])
    if len(lanes):
        q = delayed(smooth_quaternions(eta[lanes, :, 3:]), p["delay[attitude]"][lanes] / log.dt)
        q /= np.sqrt(np.einsum("...i,...i->...", q, q))[..., None]
        eta[lanes, :, 3:] = euler_from_quaternion(q)
    return replace(log, nu=nu, eta=eta)


def unobserve(nu: Array, eta: Array, p: Mapping[str, Array]) -> tuple[Array, Array]:
    """What was measured: the plant simulates what has not been logged yet."""
    return nu, eta
