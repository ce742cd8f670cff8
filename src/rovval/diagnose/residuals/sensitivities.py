"""Residuals of the windows, and their sensitivities to parameters and initial states by finite differences.

The perturbed simulations of a block of windows are one batched call of the plant; each one is a lane of it.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rovval.core.data import Array
from rovval.core.large_arrays import columns_first
from rovval.diagnose.residuals.normal_equations import Linearisation
from rovval.diagnose.residuals.nuisances import drifting_channels, initial_states
from rovval.diagnose.residuals.perturbations import STEP, DisplacedColumn, Perturbation, coarse_differences, perturbations
from rovval.diagnose.windows.attitude import tilted, tumbling
from rovval.diagnose.windows.windows import Windows, channel_difference, predicted_channels

AT_ONCE = 8_000  # lanes that are simulated before their differences are taken: some 0.1 GB
LANES = 2_000  # lanes a call: 20 MB, which stay with the process; larger arrays go back to the system each time (measured: a tenth slower)


def simulate_windows(windows: Windows, beta: Array, nu0: Array, eta0: Array, which: np.ndarray) -> tuple[Array, np.ndarray]:
    """Simulate b lanes: parameters ``beta`` (b, k), initial velocities ``nu0`` and poses ``eta0`` (b, 6), windows ``which`` (b,).

    Returns the predicted channels (b, n, c), and which lanes ran to their end (b,); one that stopped holds its last state.
    """
    out = np.empty((len(which), windows.steps + 1, len(windows.channels)))
    fine = np.empty(len(which), dtype=bool)
    for begin in range(0, len(which), LANES):
        block = slice(begin, begin + LANES)
        motion = windows.plant.simulate(
            windows.actuation.inputs, windows.start[which[block]], windows.steps, nu0[block], eta0[block], beta[block]
        )
        predicted_channels(windows, which[block], motion.nu, motion.eta, out[block])
        fine[block] = motion.stopped < 0
    return out, fine


def linearise(
    windows: Windows, beta: Array, columns: tuple[int, ...], directions: Sequence[DisplacedColumn] = (), coarse: tuple[int, ...] = (),
    starts: bool = True, share: float = STEP,
) -> Linearisation:  # fmt: skip
    """Residuals of every window and their sensitivities about ``beta`` (k,).

    Args:
        windows: windows of one run.
        beta: parameters of the plant.
        columns: slots, by central differences.
        directions: displaced columns, last.
        coarse: slots, behind ``columns``, by one-sided differences (`coarse_differences`).
        starts: whether sensitivities to the windows' initial states are taken.
        share: of their typical size, by which ``columns`` are moved.
    """
    states, drifting, m = initial_states(windows) if starts else [], drifting_channels(windows), windows.count
    lanes = perturbations(windows, beta, states, columns, directions, share)
    lanes += coarse_differences(windows, beta, coarse, len(lanes))
    ids = (*columns, *coarse, *(d.id for d in directions))
    shape = (m, windows.steps + 1, len(windows.channels))
    pushed = 0 if windows.disturbance_response is None else windows.disturbance_response.shape[-1]
    r, J, valid = np.zeros(shape), columns_first(*shape, columns=len(states) + len(drifting) + pushed), np.zeros(m, dtype=bool)
    S = columns_first(*shape, columns=len(ids))
    for i, channel in enumerate(drifting):
        J[..., channel, len(states) + i] = 1.0
    place = {column: i for i, column in enumerate(ids)}
    if windows.disturbance_response is not None:
        J[..., len(states) + len(drifting) :] = windows.disturbance_response
    each = max(1, AT_ONCE // len(lanes))
    for begin in range(0, m, each):
        which = np.arange(begin, min(begin + each, m))
        here = slice(begin, begin + each)
        out, ran = _simulated(windows, lanes, which)
        valid[which] = ran[0]
        for i, lane in enumerate(lanes):
            if lane.step and (lane.state >= 0 or lane.column >= 0):
                derivative = J[here, ..., lane.state] if lane.state >= 0 else S[here, ..., place[lane.column]]
                channel_difference(windows, out[i], out[lane.against], derivative)
                derivative /= lane.step
                if not (alike := ran[0] & ran[i] & ran[lane.against]).all():
                    derivative[~alike] = 0.0
        r[which] = np.where(windows.ok[which], channel_difference(windows, windows.y[which], out[0]), 0.0)
    J[~valid] = 0.0
    return Linearisation(r, S, J, ids, valid)


def _simulated(windows: Windows, lanes: Sequence[Perturbation], which: np.ndarray) -> tuple[Array, np.ndarray]:
    """Every perturbation of the windows ``which``: predicted channels (lanes, windows, n, c), and which ran to their end (lanes, windows)."""
    b = np.repeat(np.stack([lane.beta for lane in lanes]), len(which), axis=0)
    nu = np.concatenate([windows.nu0[which] + lane.nu for lane in lanes])
    eta = np.concatenate([_displaced(windows, windows.eta0[which], lane.eta) for lane in lanes])
    out, fine = simulate_windows(windows, b, nu, eta, np.tile(which, len(lanes)))
    return out.reshape(len(lanes), len(which), *out.shape[1:]), fine.reshape(len(lanes), len(which))


def _displaced(windows: Windows, eta: Array, by: Array) -> Array:
    """Initial poses (m, 6) displaced ``by`` (6,), m and rad: where a run tumbles roll and pitch stand for a tilt about two level axes."""
    if not (by[3:5].any() and tumbling(windows.run)):
        return np.asarray(eta + by)
    return np.asarray(tilted(eta, by[3], by[4]) + np.concatenate([by[:3], np.zeros(2), by[5:]]))


def residual(windows: Windows, beta: Array) -> tuple[Array, np.ndarray]:
    """Residuals (m, n, c) at ``beta`` (k,), measured minus simulated, and which windows (m,) ran to their end."""
    which = np.arange(windows.count)
    out, fine = simulate_windows(windows, np.tile(beta, (windows.count, 1)), windows.nu0, windows.eta0, which)
    return np.where(windows.ok, channel_difference(windows, windows.y, out), 0.0), fine
