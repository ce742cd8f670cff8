"""The log's velocities went through a low-pass filter."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rovval.effects.delay import delayed
from rovval.effects.effect import Effect, Parameter, Tolerance
from rovval.effects.lanes import Array
from rovval.effects.log import Log

EFFECT = Effect(
    name="velocity_filter_lag",
    title="Low-pass of the velocity log",
    place="sensor",
    equation="tau dy/dt = v(t - dead) - y on u v w, exact for a v that is linear between samples. The filter begins a window at the measured velocity; the "
    "true one there is simulated from it for tau and dead. A filter of higher order is nearly one of first order behind a dead time.",
    symbols={
        "y": "logged velocity u v w; m/s",
        "v": "true velocity over ground u v w, body axes; m/s",
        "tau": "time constant; s",
        "dead": "dead time; s",
        "t": "time since the run's start; s",
    },
    parameters=(
        Parameter("tau", "s", 0.0, 3.0, 0.0, 0.2, "0.1 to 1 s (chosen)", tolerance=Tolerance(0.05, "s: half a sample at 10 Hz", calibrated=False)),
        # No tolerance: the time offset of the velocity log has it.
        Parameter("dead", "s", 0.0, 1.5, 0.0, 0.1, "of a filter of second order, about a quarter of its mean delay; averaging and telemetry"),
    ),
    signature="u v w late and rounded, p q r and attitude not",
    confused_with=("thrust_lag", "time_offset", "added_mass"),
    separates="an accelerometer; the gyros, which are not filtered",
    literature=(
        "Ziegler and Nichols 1942: dead time and first-order lag for a lag of higher order",
        "Klein and Morelli 2006: data compatibility of flight measurements",
    ),
    refines=("dead",),
    far=(3.0,),  # a lag of half a second is no multiple of a short one (chosen)
    stage="filter",
)
LATE = {("tau", "dead"): (0, 1, 2)}  # by their sum it is late for a motion that changes slowly, and it writes u v w (`plant.sensor_delay`)


def observe(log: Log, p: Mapping[str, Array]) -> Log:
    """Velocities after the filter, which starts at the measured ones."""
    tau, true = p["tau"][:, None], delayed(log.nu[..., :3], p["dead"] / log.dt)
    on = tau > 0
    decay = np.where(on, np.exp(-log.dt / np.where(on, tau, 1.0)), 0.0)
    seen = true.copy()
    seen[:, log.first] = np.where(on, log.nu0[:, :3], seen[:, log.first])
    for j in range(log.first + 1, seen.shape[1]):
        before, now = true[:, j - 1], true[:, j]
        slope = (now - before) / log.dt * tau
        seen[:, j] = now - slope + (seen[:, j - 1] - before + slope) * decay
    return replace(log, nu=np.concatenate([seen, log.nu[..., 3:]], axis=-1))


def unobserve(nu: Array, eta: Array, p: Mapping[str, Array]) -> tuple[Array, Array]:
    """What was measured: the plant simulates what the filter has not let through yet."""
    return nu, eta
