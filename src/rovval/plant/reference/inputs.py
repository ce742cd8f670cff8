"""The NumPy twin's way from the log to the thrust at rest at the stage times of a step: delays, lags, what acts on speed and thrust."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from rovval.plant.codegen.spec import LOGGED
from rovval.plant.reference.state import Run, chain

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


def warm(run: Run) -> Array:
    """Lagged speed at the window's start, from the log's first sample."""
    tau, dt = run.lanes.lag, run.inputs.dt
    back = int(min(run.start.max(), int(40 * tau.max() / dt) + 1)) if tau.max() > 0 else 0
    memory = np.asarray(_logged_speed(run, np.maximum(run.start - back, 0)))
    for step in range(-back, 0):
        a = _logged_speed(run, np.maximum(run.start + step, 0))
        b = _logged_speed(run, np.maximum(run.start + step + 1, 0))
        b = a if run.inputs.hold else b
        held = (run.start + step < 0)[:, None]
        memory = np.where(held, memory, _lagged(tau, memory, a, b, (b - a) / dt, dt))
    return memory


def at_stages(run: Run, step: int, f0: float, f1: float, h: float) -> list[dict[str, Array]]:
    """Log, acting speed and thrust at rest at the start, middle and end of a substep."""
    dt, last = run.inputs.dt, len(run.prepared.t) - 1
    now, after = np.minimum(run.start + step, last), np.minimum(run.start + step + 1, last)
    a, b = _ends(run, step)
    slope = (b - a) / dt
    begin, memory, stages = a + slope * (f0 * dt), run.memory, []
    for part in (0.0, 0.5, 1.0):
        f = f0 + (f1 - f0) * part
        names = {c: run.prepared.log[now, i] + (run.prepared.log[after, i] - run.prepared.log[now, i]) * f for i, c in enumerate(LOGGED)}
        names["t"] = run.prepared.t[run.start] + (step + f) * dt
        n = _lagged(run.lanes.lag, memory, begin, a + slope * (f * dt), slope, part * h)
        if part == 0.0:
            n = np.where((run.lanes.lag > 0)[:, None], memory, begin)
        if part == 1.0:
            run.memory = n
        n = chain(run, "acting", n, names)
        names["n"], names["T"] = n, _thrust_at_rest(run, n, names)
        wrench = np.zeros((len(run.start), 6))
        if run.inputs.extra is not None:
            bank = run.prepared.extra[np.maximum(run.which, 0)]
            rows = np.arange(len(run.start))
            value = bank[rows, now] + (bank[rows, after] - bank[rows, now]) * f
            wrench = np.where((run.which >= 0)[:, None], run.gain[:, None] * value, 0.0)
        names["extra"] = wrench
        stages.append(names)
    return stages


def _logged_speed(run: Run, samples: Indices) -> Array:
    """Speed (B, k) at the samples, after time offset and drift, and what acts before the lag."""
    speed, t, dt = run.prepared.speed, run.prepared.t, run.inputs.dt
    last = len(speed) - 1
    samples = np.clip(samples, 0, last)
    x = np.clip(samples - (run.lanes.shift / dt + run.lanes.drift / dt * t[samples]), 0, last)
    low = np.minimum(x.astype(np.int64), max(last - 1, 0))
    part = (x - low)[:, None]
    n = speed[low] + (speed[np.minimum(low + 1, last)] - speed[low]) * part
    return chain(run, "speed", n, {})


def _ends(run: Run, step: int) -> tuple[Array, Array]:
    a = _logged_speed(run, run.start + step)
    return a, a if run.inputs.hold else _logged_speed(run, np.minimum(run.start + step + 1, len(run.prepared.speed) - 1))


def _lagged(tau: Array, memory: Array, a: Array, now: Array, slope: Array, elapsed: float) -> Array:
    """Exact answer of tau dn/dt = u - n to u running linearly from ``a`` to ``now``; u itself where tau is 0."""
    tau = tau[:, None]
    left = np.where(tau > 0, np.exp(-elapsed / np.where(tau > 0, tau, 1.0)), 0.0)
    return now - slope * tau + (memory - a + slope * tau) * left


def _thrust_at_rest(run: Run, n: Array, names: Mapping[str, Array]) -> Array:
    lanes = run.lanes
    thrust = np.where(n > 0, lanes.k_pos, lanes.k_neg) * n * np.abs(n)
    thrust = chain(run, "static", thrust, {**names, "n": n})
    for (j, i), (ahead, astern) in zip(run.jets.pairs, run.jets.weights, strict=True):
        jet = np.where(n[:, j] > 0, ahead, astern) * np.minimum(np.abs(n[:, j]), np.abs(n[:, i]))
        gain = np.where(n[:, i] > 0, lanes.k_pos[:, i], lanes.k_neg[:, i])
        thrust[:, i] -= lanes.wake[:, i] * jet * gain * n[:, i]
    return thrust
