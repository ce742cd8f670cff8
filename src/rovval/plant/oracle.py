"""The same plant in plain NumPy, one array a quantity: what the compiled kernel is tested against, lane by lane.

Written from the equations with matrices and cross products (thesis 3.10 to 3.15, 2.1 to 2.3; Fossen 2021, 3.50, 6.42, 8.4), not from
the kernel's text. It shares the lowering of the effects and their functions of the state, and nothing of the integration.
"""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rovval import effects
from rovval.effects._lanes import Lanes
from rovval.frames import euler_from_quaternion, quaternion_from_euler, rotation_from_quaternion
from rovval.plant import geometry, sensors
from rovval.plant.compose import PER_THRUSTER
from rovval.plant.inputs import Inputs, Prepared, prepare
from rovval.plant.lower import Lowered, lower, rigid_body, with_payload
from rovval.plant.model import Motion, Plant
from rovval.plant.template import ADVANCE_LIMIT, RATE_LIMIT, SPEED_LIMIT

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
LOG = ("altitude", "wall_distance", "voltage", "tether_length")


@dataclass
class _Run:
    """What stays the same through one run: the plant, its lowered lanes, the log."""

    plant: Plant
    lowered: Lowered
    inputs: Inputs
    prepared: Prepared
    start: Indices
    which: Indices
    gain: Array
    lanes: Lanes
    mass: Array  # (B, 6, 6) M_RB
    memory: Array  # (B, k) lagged speed

    def __post_init__(self) -> None:
        vehicle = self.plant.vehicle
        self.place = np.array([t.position for t in vehicle.thruster])
        self.hand = np.array([t.handedness for t in vehicle.thruster], dtype=float)
        self.jets, self.side = geometry.jets(vehicle), geometry.hull_side(vehicle)


def simulate(
    plant: Plant, inputs: Inputs, start: Indices, steps: int, nu0: Array, eta0: Array, beta: Array,
    extra: Indices | None = None, extra_gain: Array | None = None,
) -> Motion:  # fmt: skip
    """As `Plant.simulate`."""
    size = len(start)
    which = np.full(size, -1) if extra is None else extra
    gain = np.ones(size) if extra_gain is None else extra_gain
    lowered = lower(plant.vehicle, plant.model, plant.slots, plant.index, plant.null, beta)
    nu, eta = sensors.unobserve(plant.vehicle, plant.index, plant.null, beta, nu0, eta0)
    prepared = prepare(inputs, plant.vehicle)
    if sensors.settling(lowered.active):
        first, _, _ = _integrate(plant, lowered, inputs, prepared, start, which, gain, nu, eta, 1)
        nu = sensors.settle(plant.vehicle, plant.index, plant.null, beta, nu, (first[:, 1] - first[:, 0]) / inputs.dt)
    true_nu, true_eta, stopped = _integrate(plant, lowered, inputs, prepared, start, which, gain, nu, eta, steps)
    seen = sensors.observe(plant.vehicle, plant.index, plant.null, beta, sensors.Log(true_nu, true_eta, inputs.dt, nu0))
    return Motion(seen.nu, seen.eta, stopped, tuple(f"lane {b}" for b in np.flatnonzero(stopped >= 0)))


def _integrate(
    plant: Plant, lowered: Lowered, inputs: Inputs, prepared: Prepared, start: Indices, which: Indices, gain: Array,
    nu0: Array, eta0: Array, steps: int,
) -> tuple[Array, Array, Indices]:  # fmt: skip
    lanes = lowered.lanes
    mass = rigid_body(lanes.mass, lanes.mass[:, None] * lanes.centre_of_gravity, lanes.inertia)
    run = _Run(plant, lowered, inputs, prepared, start, which, gain, lanes, mass, np.zeros((len(start), 1)))
    run.memory = _warm(run)
    state = np.concatenate([eta0[:, :3], quaternion_from_euler(eta0[:, 3:]), nu0], axis=1)
    states, stopped = [state], np.full(len(start), -1)
    limit = prepared.steps_before_gap(start, inputs.hold)
    h = inputs.dt / plant.substeps
    for step in range(steps):
        for sub in range(plant.substeps):
            f0, f1 = sub / plant.substeps, (sub + 1) / plant.substeps
            _take_payload(run, step, f0)
            stages = _stages(run, step, f0, f1, h)
            new = _runge_kutta(run, state, stages, h)
            speed, rate = (new[:, 7:10] ** 2).sum(axis=1), (new[:, 10:] ** 2).sum(axis=1)
            sane = (speed < SPEED_LIMIT**2) & (rate < RATE_LIMIT**2) & (np.abs(new[:, :3]).sum(axis=1) < 1e12) & (step < limit)
            stopped = np.where((stopped < 0) & ~sane, step + 1, stopped)
            state = np.where((stopped < 0)[:, None], new, state)
        states.append(state)
    all_states = np.stack(states, axis=1)
    eta = np.concatenate([all_states[..., :3], euler_from_quaternion(all_states[..., 3:7])], axis=-1)
    return all_states[..., 7:], eta, stopped


def _runge_kutta(run: _Run, x: Array, stages: list[dict[str, Array]], h: float) -> Array:
    k1 = _derivative(run, x, stages[0])
    k2 = _derivative(run, x + 0.5 * h * k1, stages[1])
    k3 = _derivative(run, x + 0.5 * h * k2, stages[1])
    k4 = _derivative(run, x + h * k3, stages[2])
    new = x + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
    quaternion = new[:, 3:7] / np.linalg.norm(new[:, 3:7], axis=1, keepdims=True)
    return np.concatenate([new[:, :3], quaternion, new[:, 7:]], axis=1)


def _logged_speed(run: _Run, samples: Indices) -> Array:
    """Speed (B, k) at the samples, after time offset and drift, and what acts before the lag."""
    speed, t, dt = run.prepared.speed, run.prepared.t, run.inputs.dt
    last = len(speed) - 1
    samples = np.clip(samples, 0, last)
    x = np.clip(samples - (run.lanes.shift / dt + run.lanes.drift / dt * t[samples]), 0, last)
    low = np.minimum(x.astype(np.int64), max(last - 1, 0))
    part = (x - low)[:, None]
    n = speed[low] + (speed[np.minimum(low + 1, last)] - speed[low]) * part
    return _chain(run, "speed", n, {})


def _ends(run: _Run, step: int) -> tuple[Array, Array]:
    a = _logged_speed(run, run.start + step)
    return a, a if run.inputs.hold else _logged_speed(run, np.minimum(run.start + step + 1, len(run.prepared.speed) - 1))


def _lagged(tau: Array, memory: Array, a: Array, now: Array, slope: Array, elapsed: float) -> Array:
    """Exact answer of tau dn/dt = u - n to u running linearly from ``a`` to ``now``; u itself where tau is 0."""
    tau = tau[:, None]
    left = np.where(tau > 0, np.exp(-elapsed / np.where(tau > 0, tau, 1.0)), 0.0)
    return now - slope * tau + (memory - a + slope * tau) * left


def _warm(run: _Run) -> Array:
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


def _take_payload(run: _Run, step: int, f0: float) -> None:
    lanes = run.lowered.lanes
    if lanes.payload_mass.any():
        loaded = with_payload(lanes)
        now = run.prepared.t[run.start] + step * run.inputs.dt + f0 * run.inputs.dt
        on = (lanes.payload_mass != 0) & (now >= lanes.payload_onset)
        before = rigid_body(lanes.mass, lanes.mass[:, None] * lanes.centre_of_gravity, lanes.inertia)
        after = rigid_body(loaded.mass, loaded.mass[:, None] * loaded.centre_of_gravity, loaded.inertia)
        run.mass = np.where(on[:, None, None], after, before)


def _stages(run: _Run, step: int, f0: float, f1: float, h: float) -> list[dict[str, Array]]:
    """Log, acting speed and thrust at rest at the start, middle and end of a substep."""
    dt, last = run.inputs.dt, len(run.prepared.t) - 1
    now, after = np.minimum(run.start + step, last), np.minimum(run.start + step + 1, last)
    a, b = _ends(run, step)
    slope = (b - a) / dt
    begin, memory, stages = a + slope * (f0 * dt), run.memory, []
    for part in (0.0, 0.5, 1.0):
        f = f0 + (f1 - f0) * part
        names = {c: run.prepared.log[now, i] + (run.prepared.log[after, i] - run.prepared.log[now, i]) * f for i, c in enumerate(LOG)}
        names["t"] = run.prepared.t[run.start] + (step + f) * dt
        n = _lagged(run.lanes.lag, memory, begin, a + slope * (f * dt), slope, part * h)
        if part == 0.0:
            n = np.where((run.lanes.lag > 0)[:, None], memory, begin)
        if part == 1.0:
            run.memory = n
        n = _chain(run, "acting", n, names)
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


def _thrust_at_rest(run: _Run, n: Array, names: Mapping[str, Array]) -> Array:
    lanes = run.lanes
    thrust = np.where(n > 0, lanes.k_pos, lanes.k_neg) * n * np.abs(n)
    thrust = _chain(run, "static", thrust, names)
    for (j, i), (ahead, astern) in zip(run.jets.pairs, run.jets.weights, strict=True):
        jet = np.where(n[:, j] > 0, ahead, astern) * np.minimum(np.abs(n[:, j]), np.abs(n[:, i]))
        gain = np.where(n[:, i] > 0, lanes.k_pos[:, i], lanes.k_neg[:, i])
        thrust[:, i] -= lanes.wake[:, i] * jet * gain * n[:, i]
    return thrust


def _derivative(run: _Run, x: Array, stage: Mapping[str, Array]) -> Array:
    """Time derivative of x y z, q_wxyz, nu (B, 13)."""
    lanes = run.lanes
    q, nu = x[:, 3:7], x[:, 7:]
    rotation = rotation_from_quaternion(q)
    v, omega = nu[:, :3], nu[:, 3:]
    over_ground = _turn(rotation, v)
    names = _names(x, rotation, over_ground, stage)
    water = _sum(run, "water", names, 9)
    back = np.swapaxes(rotation, 1, 2)
    current, along, here = (_turn(back, water[:, i : i + 3]) for i in (0, 3, 6))
    nu_r = np.concatenate([v - current, omega], axis=1)
    names |= {"ur": nu_r[:, 0], "vr": nu_r[:, 1], "wr": nu_r[:, 2]} | {n: water[:, i] for i, n in enumerate(("cn", "ce", "cd"))}
    zero = np.zeros_like(omega)
    nu_c_dot = np.concatenate([along - np.cross(omega, current), zero], axis=1)

    down = rotation[:, 2]
    weight, buoyancy = lanes.weight[:, None] * down, lanes.buoyancy[:, None] * down
    restoring = _at(lanes.centre_of_gravity, weight) - _at(lanes.centre_of_buoyancy, buoyancy)
    pressed = _at(lanes.centre_of_buoyancy, lanes.buoyancy[:, None] / lanes.vehicle.water.gravity * here)
    drag = _matmul(lanes.linear_drag, nu_r) + _matmul(lanes.quadratic_drag, np.abs(nu_r) * nu_r)
    force = (
        _thrusters(run, nu_r, stage) + restoring + pressed - drag - _coriolis(run.mass, nu) - _coriolis(lanes.added_mass, nu_r)
        + _matmul(lanes.added_mass, nu_c_dot) + stage["extra"] + _sum(run, "wrench", names, 6)
    )  # fmt: skip
    nu_dot = np.linalg.solve(run.mass + lanes.added_mass, force[..., None])[..., 0]
    w, vector = q[:, :1], q[:, 1:]
    q_dot = 0.5 * np.concatenate([-(vector * omega).sum(axis=1, keepdims=True), w * omega + np.cross(vector, omega)], axis=1)
    return np.concatenate([over_ground, q_dot, nu_dot], axis=1)


def _coriolis(mass: Array, nu: Array) -> Array:
    """C(nu) nu of a 6 x 6 mass matrix from its momentum (Kirchhoff; Fossen 2021, 3.57)."""
    momentum = _matmul(mass, nu)
    linear, angular, omega = momentum[:, :3], momentum[:, 3:], nu[:, 3:]
    return np.concatenate([np.cross(omega, linear), np.cross(omega, angular) + np.cross(nu[:, :3], linear)], axis=1)


def _thrusters(run: _Run, nu_r: Array, stage: Mapping[str, Array]) -> Array:
    """Wrench (B, 6) of all thrusters in water that flows past them."""
    lanes = run.lanes
    flow = nu_r[:, None, :3] + np.cross(nu_r[:, None, 3:], run.place)
    axial = (flow * lanes.direction).sum(axis=-1)
    cross = np.sqrt(np.maximum((flow**2).sum(axis=-1) - axial**2, 0.0))
    thrust = stage["T"] * _advance(run, stage["n"], axial)
    thrust = _chain(run, "thrust", thrust, {**stage, "ua": axial, "cross": cross})
    moment = np.cross(run.place, lanes.direction) + (lanes.torque_arm[:, None] * run.hand)[..., None] * lanes.direction
    columns = np.concatenate([lanes.direction, moment], axis=-1)
    side = lanes.side[:, None] * np.abs(stage["T"])
    return np.asarray(np.einsum("bk,bki->bi", thrust, columns) + side @ run.side)


def _advance(run: _Run, n: Array, axial: Array) -> Array:
    """K_T(J) / K_T(0), J held within +-ADVANCE_LIMIT (thesis's upstream: rho D^4 n|n| theta K_T(J_a))."""
    factor = np.ones_like(n)
    for i, thruster in enumerate(run.plant.vehicle.thruster):
        if thruster.diameter > 0:
            j = np.clip(axial[:, i] * n[:, i] / (thruster.diameter * (n[:, i] ** 2 + 1e-12)), -ADVANCE_LIMIT, ADVANCE_LIMIT)
            powers = np.stack([j, j**2, j**3], axis=1)
            factor[:, i] = 1.0 + np.where(n[:, i] > 0, powers @ np.array(thruster.advance_pos), powers @ np.array(thruster.advance_neg))
    return factor




def _call(run: _Run, name: str, kind: str, names: Mapping[str, Any]) -> Any:
    """One effect's function of the state with its own rows and whatever else it asks for by name."""
    function = getattr(effects.module(name), kind)
    own = {row.partition(".")[2]: value for row, value in run.lowered.rows.items() if row.startswith(name + ".")}
    if kind in PER_THRUSTER:
        own = {row: value[:, None] if value.ndim == 1 else value for row, value in own.items()}
    return function(**{a: own[a] if a in own else names[a] for a in inspect.signature(function).parameters})


def _chain(run: _Run, kind: str, value: Array, names: Mapping[str, Array]) -> Array:
    """Speed or thrust (B, k) handed from one effect to the next."""
    spread = {n: v[:, None] if v.ndim == 1 else v for n, v in names.items()}
    for name in effects.names():
        if hasattr(effects.module(name), kind):
            value = _call(run, name, kind, {**spread, "n" if kind in ("speed", "acting") else "T": value})
    return value


def _sum(run: _Run, kind: str, names: Mapping[str, Array], size: int) -> Array:
    total = np.zeros((len(run.start), size))
    for name in effects.names():
        if hasattr(effects.module(name), kind):
            parts = _call(run, name, kind, names)
            total = total + np.stack(np.broadcast_arrays(*parts, total[:, 0])[:size], axis=1)
    return total


def _names(x: Array, rotation: Array, over_ground: Array, stage: Mapping[str, Array]) -> dict[str, Array]:
    names = {n: x[:, i] for i, n in enumerate("xyz")} | {n: x[:, 7 + i] for i, n in enumerate("uvwpqr")}
    names |= {f"r{i + 1}{j + 1}": rotation[:, i, j] for i in range(3) for j in range(3)}
    names |= {n: over_ground[:, i] for i, n in enumerate(("vn", "ve", "vd"))}
    return names | {n: stage[n] for n in (*LOG, "t")}


def _at(place: Array, force: Array) -> Array:
    """Wrench of a force at a place."""
    return np.concatenate([force, np.cross(place, force)], axis=1)


def _turn(rotation: Array, vector: Array) -> Array:
    return np.asarray(np.einsum("bij,bj->bi", rotation, vector))


def _matmul(matrix: Array, vector: Array) -> Array:
    return np.asarray(np.einsum("bij,bj->bi", matrix, vector))
