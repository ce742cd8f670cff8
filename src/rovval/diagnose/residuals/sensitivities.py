"""Residuals of the windows and their sensitivity to every parameter of the library and to the windows' initial states.

One batched simulation of all `lanes` per block of windows. What later stages need is kept as inner products per window (`Products`), after the
initial state is marginalised with its measurement error.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.residuals.perturbations import Direction, Lane, lanes_of, one_sided, state_steps
from rovval.diagnose.windows.noise import ANGLES
from rovval.diagnose.windows.shooting import VELOCITY_CHANNELS, Stretches, difference, predicted

AT_ONCE = 60  # windows that are simulated before their slopes are taken: ten minutes of log, some 0.3 GB
LANES = 2_000  # lanes a call: 20 MB, which stay with the process; larger arrays go back to the system each time (measured: a tenth slower)
UNLOGGED = 0.3  # m/s, rad/s, rad: start of what was neither logged nor follows from the pose: anything slow is possible (chosen)
FROM_SLOPE = 0.01  # m/s, rad/s: least error of a start taken as the slope of the logged pose over a second (chosen)
POSE_SLOPE = {"u": "x", "v": "y", "w": "z", "p": "phi", "q": "theta", "r": "psi"}
ATTITUDE_DRIFT = 0.004  # rad: slow error of an AHRS within a window, 0.2 degrees (MTi class data sheets)


@dataclass(frozen=True, slots=True)
class Linear:
    """At one parameter point: residual measured - simulated ``r`` (m, n, c), sensitivities of the prediction to parameters ``S`` (m, n, c, k)
    of ``columns`` and to nuisances ``J`` (m, n, c, s): initial states, then disturbances once these are known. A simulation that stops
    (`plant`) holds its last state: a window where that happens at the point itself has ``valid`` (m,) False and no slopes, so that it costs what it
    errs; where it happens a step away, that slope is nothing in that window."""

    r: Array
    S: Array
    J: Array
    columns: tuple[int, ...]
    valid: np.ndarray


def simulate_windows(stretches: Stretches, beta: Array, nu0: Array, eta0: Array, which: np.ndarray) -> tuple[Array, np.ndarray]:
    """Predicted channels (b, n, c) of lanes: parameters ``beta`` (b, k), start states (b, 6), windows ``which`` (b,)."""
    out = np.empty((len(which), stretches.steps + 1, len(stretches.channels)))
    fine = np.empty(len(which), dtype=bool)
    for begin in range(0, len(which), LANES):
        part = slice(begin, begin + LANES)
        motion = stretches.plant.simulate(
            stretches.driven.inputs, stretches.start[which[part]], stretches.steps, nu0[part], eta0[part], beta[part]
        )
        predicted(stretches, motion.nu, motion.eta, out[part])
        fine[part] = motion.stopped < 0
    return out, fine


def linearise(
    stretches: Stretches, beta: Array, columns: tuple[int, ...], directions: Sequence[Direction] = (), coarse: tuple[int, ...] = (),
    starts: bool = True,
) -> Linear:  # fmt: skip
    """Residual and sensitivities about ``beta`` (k,) for every window; columns ``coarse``, behind the others, by one-sided differences; without
    ``starts`` nothing about the windows' initial states."""
    states, drifting, m = state_steps(stretches) if starts else [], _drifting(stretches), stretches.count
    lanes = lanes_of(stretches, beta, states, columns, directions) + one_sided(stretches, beta, coarse)
    ids = (*columns, *(d.id for d in directions), *coarse)
    shape = (m, stretches.steps + 1, len(stretches.channels))
    r, J, valid = np.zeros(shape), np.zeros((*shape, len(states) + len(drifting))), np.zeros(m, dtype=bool)
    S = np.moveaxis(np.zeros((len(ids), *shape)), 0, -1)  # a column in one piece, as it is made
    for i, channel in enumerate(drifting):
        J[..., channel, len(states) + i] = 1.0
    place = {column: i for i, column in enumerate(ids)}
    for begin in range(0, m, AT_ONCE):
        which = np.arange(begin, min(begin + AT_ONCE, m))
        out, ran = _simulated(stretches, lanes, which)
        valid[which] = ran[0]
        for i, lane in enumerate(lanes):
            if lane.step and (lane.state >= 0 or lane.column >= 0):
                slope = difference(stretches, out[i], out[lane.against]) / lane.step
                slope[~(ran[0] & ran[i] & ran[lane.against])] = 0.0
                if lane.state >= 0:
                    J[which, ..., lane.state] = slope
                else:
                    S[which, ..., place[lane.column]] = slope
        r[which] = np.where(stretches.ok[which], difference(stretches, stretches.y[which], out[0]), 0.0)
    if stretches.pushed is not None:
        J = np.concatenate([J, stretches.pushed], axis=-1)
    J[~valid] = 0.0
    return Linear(r, S, J, ids, valid)


def _simulated(stretches: Stretches, lanes: Sequence[Lane], which: np.ndarray) -> tuple[Array, np.ndarray]:
    """Every lane of the windows ``which``: predicted channels (lanes, windows, n, c), and which did not stop (lanes, windows)."""
    b = np.repeat(np.stack([lane.beta for lane in lanes]), len(which), axis=0)
    nu = np.concatenate([stretches.nu0[which] + lane.nu for lane in lanes])
    eta = np.concatenate([stretches.eta0[which] + lane.eta for lane in lanes])
    out, fine = simulate_windows(stretches, b, nu, eta, np.tile(which, len(lanes)))
    return out.reshape(len(lanes), len(which), *out.shape[1:]), fine.reshape(len(lanes), len(which))


def residual(stretches: Stretches, beta: Array) -> tuple[Array, np.ndarray]:
    """Measured - simulated (m, n, c) at ``beta`` (k,), and which windows did not stop."""
    which = np.arange(stretches.count)
    out, fine = simulate_windows(stretches, np.tile(beta, (stretches.count, 1)), stretches.nu0, stretches.eta0, which)
    return np.where(stretches.ok, difference(stretches, stretches.y, out), 0.0), fine


def _drifting(stretches: Stretches) -> list[int]:
    """Channels whose sensor drifts slowly beside its white noise: roll and pitch of an AHRS."""
    return [i for i, c in enumerate(stretches.channels) if c in ("phi", "theta")]


def spread(stretches: Stretches) -> Array:
    """Standard error of each nuisance of a window (s,): start states and sensors' drift, then disturbances, whose answers are scaled to it."""
    pushed = 0 if stretches.pushed is None else stretches.pushed.shape[-1]
    return np.concatenate([state_spread(stretches), np.ones(pushed)])


def state_spread(stretches: Stretches) -> Array:
    """Standard error of what a window's start adds (s,): start states (the channel's noise, or a stated value where it was not measured),
    then the attitude sensors' drift."""
    noise = dict(zip(stretches.channels, stretches.noise, strict=True))
    run = stretches.run
    found = []
    for index, _ in state_steps(stretches):
        name = (*VELOCITY_CHANNELS, "phi", "theta", "z", "psi")[index]
        if run.measured(name):
            least = 0.01 if name in ANGLES else 0.005
            found.append(max(noise.get(name, 0.0), least))
        else:
            pose = POSE_SLOPE.get(name, "")
            found.append(max(3.0 * noise.get(pose, 0.0), FROM_SLOPE) if run.measured(pose) else UNLOGGED)
    return np.array([*found, *[ATTITUDE_DRIFT] * len(_drifting(stretches))])
