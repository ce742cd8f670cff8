"""The same plant in plain NumPy, one array a quantity: what the compiled kernel is tested against, lane by lane.

Written from the equations (`motion`, `inputs`), not from the kernel. It shares the lowering of the effects and their functions of the state, and
nothing of the integration.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rovval.core.frames import euler_from_quaternion, quaternion_from_euler
from rovval.effects.log import Log
from rovval.plant import sensor_delay as late
from rovval.plant import sensors
from rovval.plant.codegen.layout import RATE_LIMIT, SPEED_LIMIT
from rovval.plant.inputs import Inputs, Prepared, prepare
from rovval.plant.lowering import Lowered, lower, nothing_left, rigid_body, steps_before_nothing, with_payload
from rovval.plant.model import Motion, Plant
from rovval.plant.platforms import load
from rovval.plant.reference.inputs import at_stages, warm
from rovval.plant.reference.motion import derivative, engine_step
from rovval.plant.reference.state import Run

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


def simulate(
    plant: Plant, inputs: Inputs, start: Indices, steps: int, nu0: Array, eta0: Array, beta: Array,
    extra: Indices | None = None, extra_gain: Array | None = None,
) -> Motion:  # fmt: skip
    """As `Plant.simulate`."""
    size = len(start)
    which = np.full(size, -1) if extra is None else extra
    gain = np.ones(size) if extra_gain is None else extra_gain
    lowered = lower(plant.nominal, plant.slots, plant.index, plant.null, beta)
    nu, eta = sensors.unobserve(plant.vehicle, plant.index, plant.null, beta, nu0, eta0)
    prepared = prepare(inputs, plant.vehicle)
    before, early = np.empty((size, 0, 12)), 0
    if delays := sensors.delays(plant.index, plant.null, beta):

        def run(some: Indices, begin: Indices, state: Array, many: int) -> tuple[Array, Indices]:
            mine, to = lowered.take(some), (which[some], gain[some])
            there_nu, there_eta, ended = _integrate(plant, mine, inputs, prepared, begin, *to, state[:, :6], state[:, 6:], many)
            return np.concatenate([there_nu, there_eta], axis=-1), ended

        first, before, early = late.true_start(late.Clock(run, inputs.dt, len(inputs.speed)), start, np.concatenate([nu, eta], axis=1), delays)
        nu, eta = first[:, :6], first[:, 6:]
    true_nu, true_eta, stopped = _integrate(plant, lowered, inputs, prepared, start, which, gain, nu, eta, steps + early)
    true_nu, true_eta = np.concatenate([before[..., :6], true_nu], axis=1), np.concatenate([before[..., 6:], true_eta], axis=1)
    m = before.shape[1]
    seen = sensors.observe(plant.vehicle, plant.index, plant.null, beta, Log(true_nu, true_eta, inputs.dt, nu0, eta0, m))
    stopped = np.where(stopped > steps, -1, stopped)
    window = slice(m, m + steps + 1)
    return Motion(seen.nu[:, window], seen.eta[:, window], stopped, tuple(f"lane {b}" for b in np.flatnonzero(stopped >= 0)))


def _integrate(
    plant: Plant, lowered: Lowered, inputs: Inputs, prepared: Prepared, start: Indices, which: Indices, gain: Array,
    nu0: Array, eta0: Array, steps: int,
) -> tuple[Array, Array, Indices]:  # fmt: skip
    lanes = lowered.lanes
    mass = rigid_body(lanes.mass, lanes.mass[:, None] * lanes.centre_of_gravity, lanes.inertia)
    run = Run(plant, lowered, inputs, prepared, start, which, gain, lanes, mass, np.zeros((len(start), 1)), np.zeros((len(start), 6)))
    run.memory = warm(run)
    state = np.concatenate([eta0[:, :3], quaternion_from_euler(eta0[:, 3:]), nu0], axis=1)
    states, stopped = [state], np.full(len(start), -1)
    limit = np.minimum(prepared.steps_before_gap(start, inputs.hold), steps_before_nothing(nothing_left(lowered.lanes), prepared.t[start], inputs.dt))
    substeps, engine = plant.steps(inputs.dt), load(plant.model).engine
    h = inputs.dt / substeps
    for step in range(steps):
        for sub in range(substeps):
            f0, f1 = sub / substeps, (sub + 1) / substeps
            _take_payload(run, step, f0)
            stages = at_stages(run, step, f0, f1, h)
            new = _runge_kutta(run, state, stages, h) if engine is None else engine_step(run, state, stages[0], h)
            speed, rate = (new[:, 7:10] ** 2).sum(axis=1), (new[:, 10:] ** 2).sum(axis=1)
            sane = (speed < SPEED_LIMIT**2) & (rate < RATE_LIMIT**2) & (np.abs(new[:, :3]).sum(axis=1) < 1e12) & (step < limit)
            stopped = np.where((stopped < 0) & ~sane, step + 1, stopped)
            state = np.where((stopped < 0)[:, None], new, state)
        states.append(state)
    all_states = np.stack(states, axis=1)
    eta = np.concatenate([all_states[..., :3], euler_from_quaternion(all_states[..., 3:7])], axis=-1)
    return all_states[..., 7:], eta, stopped


def _runge_kutta(run: Run, x: Array, stages: list[dict[str, Array]], h: float) -> Array:
    k1 = derivative(run, x, stages[0])
    k2 = derivative(run, x + 0.5 * h * k1, stages[1])
    k3 = derivative(run, x + 0.5 * h * k2, stages[1])
    k4 = derivative(run, x + h * k3, stages[2])
    new = x + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
    quaternion = new[:, 3:7] / np.linalg.norm(new[:, 3:7], axis=1, keepdims=True)
    return np.concatenate([new[:, :3], quaternion, new[:, 7:]], axis=1)


def _take_payload(run: Run, step: int, f0: float) -> None:
    lanes = run.lowered.lanes
    if lanes.payload_mass.any():
        loaded = with_payload(lanes)
        now = run.prepared.t[run.start] + step * run.inputs.dt + f0 * run.inputs.dt
        on = (lanes.payload_mass != 0) & (now >= lanes.payload_onset)
        before = rigid_body(lanes.mass, lanes.mass[:, None] * lanes.centre_of_gravity, lanes.inertia)
        after = rigid_body(loaded.mass, loaded.mass[:, None] * loaded.centre_of_gravity, loaded.inertia)
        run.mass = np.where(on[:, None, None], after, before)
