"""Residuals of the windows and their sensitivity to every parameter of the library and to the windows' initial states.

One batched simulation per block of windows: nominal, each initial state, each effect parameter one step away. What later stages
need is kept as inner products per window (`Products`), after the initial state is marginalised with its measurement error.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rovval.data import Array
from rovval.diagnose.stretches import ANGLES, VELOCITY_CHANNELS, Stretches, difference, predicted

LANES = 20_000  # lanes a call, to bound memory (about 200 MB)
STEP = 0.25  # finite-difference step as a share of a parameter's typical size
STATE_STEP = (0.02, 0.02, 0.02, 0.01, 0.01, 0.01, 0.01, 0.01, 0.02)  # m/s, rad/s, rad, m: about twice the noise of good sensors


@dataclass(frozen=True, slots=True)
class Linear:
    """At one parameter point: residual measured - simulated ``r`` (m, n, c), sensitivities of the prediction to parameters
    ``S`` (m, n, c, k) of ``columns`` and to initial states ``J`` (m, n, c, s). Windows whose simulation stopped have ``valid`` False."""

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
        out[part] = predicted(stretches, motion.nu, motion.eta)
        fine[part] = motion.stopped < 0
    return out, fine


def linearise(stretches: Stretches, beta: Array, columns: tuple[int, ...]) -> Linear:
    """Residual and sensitivities about ``beta`` (k,) for every window."""
    windows, slots = stretches.count, stretches.plant.slots
    states = _state_steps(stretches)
    lanes = [(0, 0.0, -1)]  # kind, step, index: nominal first
    lanes += [(1, step, i) for i, step in states]
    for column in columns:
        parameter = slots[column].parameter
        step = STEP * parameter.typical
        up = step if beta[column] + step <= parameter.high else -step
        lanes.append((2, up, column))
        if parameter.low <= beta[column] - up <= parameter.high:
            lanes.append((2, -up, column))
    b, nu, eta = _perturbed(stretches, beta, lanes)
    which = np.tile(np.arange(windows), len(lanes))
    out, fine = simulate_windows(stretches, b, nu, eta, which)
    shape = (len(lanes), windows, stretches.steps + 1, len(stretches.channels))
    out, fine = out.reshape(shape), fine.reshape(len(lanes), windows)
    nominal = out[0]
    J = np.zeros((*nominal.shape, len(states)))
    S = np.zeros((*nominal.shape, len(columns)))
    place = {column: i for i, column in enumerate(columns)}
    pairs: dict[int, list[tuple[float, int]]] = {}
    for lane, (kind, step, index) in enumerate(lanes):
        if kind == 1:
            J[..., lane - 1] = difference(stretches, out[lane], nominal) / step
        elif kind == 2:
            pairs.setdefault(index, []).append((step, lane))
    for column, steps in pairs.items():
        if len(steps) == 2:
            (up, a), (down, c) = steps
            S[..., place[column]] = difference(stretches, out[a], out[c]) / (up - down)
        else:
            S[..., place[column]] = difference(stretches, out[steps[0][1]], nominal) / steps[0][0]
    r = np.where(stretches.ok, difference(stretches, stretches.y, nominal), 0.0)
    return Linear(r, S, J, columns, fine.all(axis=0))


def residual(stretches: Stretches, beta: Array) -> tuple[Array, np.ndarray]:
    """Measured - simulated (m, n, c) at ``beta`` (k,), and which windows did not stop."""
    which = np.arange(stretches.count)
    out, fine = simulate_windows(stretches, np.tile(beta, (stretches.count, 1)), stretches.nu0, stretches.eta0, which)
    return np.where(stretches.ok, difference(stretches, stretches.y, out), 0.0), fine


def _state_steps(stretches: Stretches) -> list[tuple[int, float]]:
    """Initial states that are marginalised: six velocities, roll, pitch, and depth where it is a residual channel."""
    chosen = list(enumerate(STATE_STEP[:8]))
    if "z" in stretches.channels:
        chosen.append((8, STATE_STEP[8]))
    if "psi" in stretches.channels:
        chosen.append((9, STATE_STEP[7]))
    return chosen


def _perturbed(stretches: Stretches, beta: Array, lanes: list[tuple[int, float, int]]) -> tuple[Array, Array, Array]:
    """Parameters and start states of every lane of every window, lanes outermost."""
    m, count = stretches.count, len(lanes)
    b = np.tile(beta, (count, m, 1))
    nu, eta = np.tile(stretches.nu0, (count, 1, 1)), np.tile(stretches.eta0, (count, 1, 1))
    column_of_state = {6: 3, 7: 4, 8: 2, 9: 5}
    for lane, (kind, step, index) in enumerate(lanes):
        if kind == 2:
            b[lane, :, index] += step
        elif kind == 1 and index < 6:
            nu[lane, :, index] += step
        elif kind == 1:
            eta[lane, :, column_of_state[index]] += step
    return b.reshape(count * m, -1), nu.reshape(count * m, 6), eta.reshape(count * m, 6)


def state_spread(stretches: Stretches) -> Array:
    """Standard error of each marginalised initial state (s,): the channel's noise, or a stated value where it was not measured."""
    noise = dict(zip(stretches.channels, stretches.noise, strict=True))
    run = stretches.run
    spread = []
    for index, _ in _state_steps(stretches):
        name = (*VELOCITY_CHANNELS, "phi", "theta", "z", "psi")[index]
        if run.measured(name):
            least = 0.01 if name in ANGLES else 0.005
            spread.append(max(noise.get(name, 0.0), least))
        else:
            spread.append(0.3)  # not logged: any small start is possible (m/s, rad/s, rad)
    return np.array(spread)
