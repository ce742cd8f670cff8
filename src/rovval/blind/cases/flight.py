"""Fly a mission with a vehicle that has what is planted: 10 Hz control, adaptive integration between the steps."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from scipy.integrate import RK45

from rovval.blind.missions.manoeuvres import MISSIONS, Mission
from rovval.blind.missions.pilot import Nav
from rovval.blind.plant.dynamics import Plant
from rovval.blind.plant.effect import Effect, Kinematics, Setting
from rovval.blind.plant.environment import Background, Supply, draw_setting
from rovval.blind.plant.equivalent_wrench import ROWS_A_LOOK, Recorder, channel_change, realised
from rovval.blind.plant.motor import motor
from rovval.blind.plant.nominal_vehicle import NominalVehicle, read_vehicle
from rovval.blind.plant.parameters import perturbed
from rovval.blind.plant.rotation import euler, quaternion, to_body
from rovval.blind.plant.scales import Scales, scales
from rovval.blind.plant.sensors import finish, measure, spoil
from rovval.blind.plant.spec import RATE_HZ, STEP_S, Array, Flight, Planted, stream
from rovval.blind.planted.catalogue import build
from rovval.blind.planted.tether_drag import paid_out

SANE_SPEED = 8.0  # m/s; beyond this the flight is not an ROV's
TOLERANCE = 1e-6  # relative, of the adaptive solver


def integrate(plant: Plant, t: float, y: Array, first: float, atol: Array) -> tuple[Array, float]:
    """One control step of ``STEP_S`` by an adaptive Runge-Kutta 5(4); the state and the step size to begin the next with."""
    end = t + STEP_S
    solver = RK45(plant.rhs, t, y, end, first_step=min(first, end - t), rtol=TOLERANCE, atol=atol)
    largest = 0.0
    while solver.status == "running":
        message = solver.step()
        if message:
            raise RuntimeError(f"the plant's solver stopped at {t:.1f} s: {message}")
        largest = max(largest, float(solver.h_abs))
    return solver.y, max(largest, 1e-4)


def tolerances(plant: Plant, scale: Scales) -> Array:
    """Absolute tolerance of each state: micrometres, 1e-6 of the working momentum, 1e-4 rpm."""
    out = np.full(plant.size, 1e-6)
    heavy = np.abs(np.diag(plant.mass))
    out[7:10], out[10:13] = 1e-6 * heavy[:3] * scale.speed, 1e-6 * heavy[3:]
    out[13 : 13 + 2 * plant.many] = 1e-6 * scale.rpm
    out[13 + 2 * plant.many :] = 1e-5
    return out


def initial(plant: Plant, setting: Setting) -> Array:
    """At rest over ground, level, at the starting depth and heading."""
    y = np.zeros(plant.size)
    y[2] = setting.depth
    y[3:7] = quaternion(0.0, 0.0, setting.heading)
    k = plant.see(0.0, y)
    y[7:13] = plant.mass @ np.array([*(-a for a in to_body(k.r, *k.water[:3])), 0.0, 0.0, 0.0])
    for e, own in plant.owners:
        y[own] = e.start(k)
    return y


def instruments(k: Kinematics, y: Array, rng: np.random.Generator) -> Nav:
    """What the pilot sees: the truth with a little noise."""
    phi, theta, psi = euler(*y[3:7].tolist())
    e = (0.01 * rng.standard_normal(5)).tolist()
    u, v, w, p, q, r = k.vel
    return Nav(k.x, k.y, k.z + e[0], phi, theta, psi, u + e[1], v + e[2], w + e[3], p, q, r + 0.2 * e[4], k.altitude)


def fly(vehicle: Path, mission: str, effects: Sequence[Planted], seed: int, duration_s: float, slop: float = 0.03) -> Flight:
    """Generate one log. The same arguments give the same log to the last bit; severity 0 is the same as not planted."""
    nominal = read_vehicle(Path(vehicle))
    scale = scales(nominal)
    setting = draw_setting(nominal, scale, seed, duration_s)
    planted = [build(item, nominal, scale, setting) for item in effects if item.severity != 0.0]
    healthy = perturbed(nominal, scale, slop, stream(seed, "slop"))
    plant = Plant(healthy, planted, scale, motor(scale, len(nominal.thrusters), stream(seed, "motor")), setting.bottom)
    pilot = MISSIONS[mission](nominal, scale, setting, stream(seed, "mission"))
    recorder = Recorder(plant)
    true = _loop(plant, pilot, nominal, setting, slop, recorder)
    t: Array = np.arange(len(true["x"]), dtype=np.float64) * STEP_S
    log = measure(true, nominal.thrusters, stream(seed, "sensors"))
    changes: dict[int, dict[str, Any]] = {}
    for i, e in enumerate(planted):
        if e.overrides("record"):
            before = {name: values.copy() for name, values in log.items()}
            e.record(log, true, t)
            changes[i] = channel_change(before, log)
    sizes = realised(recorder, changes, len(planted))
    spoil(log, stream(seed, "spoil"))
    finish(log)
    clock = stream(seed, "clock")
    start = round(float(clock.uniform(0.0, 86_399.0)), 3)
    truth = _truth(nominal, mission, seed, duration_s, slop, setting, planted, sizes)
    return Flight(nominal.name, mission, nominal.thrusters, t, true, log, start, truth)


def _loop(plant: Plant, pilot: Mission, nominal: NominalVehicle, setting: Setting, slop: float, recorder: Recorder) -> dict[str, Array]:
    """Control steps to the end: the true channels."""
    scale = plant.scale
    rng = stream(setting.seed, "pilot")
    background, supply = Background(scale, slop, stream(setting.seed, "background")), Supply(scale, setting)
    y, first, psi, length = initial(plant, setting), 0.02, setting.heading, 0.0
    atol = tolerances(plant, scale)
    rows: list[list[float]] = []
    for i in range(round(setting.duration_s * RATE_HZ)):
        t = i * STEP_S
        carry = plant.refresh(t)
        if carry is not None and i:
            y = y.copy()
            y[7:13] = carry @ y[7:13]
        k = plant.see(t, y)
        for e in plant.effects:
            e.tick(k)
        plant.background = background.step()
        plant.volts = supply.step(t, k)
        nav = instruments(k, y, rng)
        psi += float(np.remainder(nav.psi - psi + np.pi, 2.0 * np.pi) - np.pi)
        plant.set_point = pilot(t, nav)
        length = paid_out(setting.anchor, np.array([k.x, k.y, k.z]), length)
        head = [k.x, k.y, k.z, nav.phi, nav.theta, psi, *k.vel, k.altitude, supply.volts, length]
        rows.append(head + k.n.tolist() + plant.set_point.tolist())
        if i % ROWS_A_LOOK == 0 and i:
            recorder.look(t, y)
        if max(map(abs, k.vel[:3])) > SANE_SPEED or not np.isfinite(y).all():
            raise RuntimeError(f"the flight left sane limits at {t:.1f} s")
        y, first = integrate(plant, t, y, first, atol)
    names = ["x", "y", "z", "phi", "theta", "psi", *"uvwpqr", "altitude", "voltage", "tether_length"]
    names += [f"n:{n}" for n in nominal.thrusters] + [f"n_cmd:{n}" for n in nominal.thrusters]
    table = np.array(rows)
    return {name: table[:, j].copy() for j, name in enumerate(names)}


def _truth(
    nominal: NominalVehicle,
    mission: str,
    seed: int,
    duration_s: float,
    slop: float,
    setting: Setting,
    planted: Sequence[Effect],
    sizes: Sequence[dict[str, Any]],
) -> dict[str, Any]:
    """The label: JSON-able."""
    return {
        "vehicle": nominal.name,
        "mission": mission,
        "seed": seed,
        "duration_s": duration_s,
        "slop": slop,
        "start_depth_m": setting.depth,
        "start_altitude_m": setting.bottom - setting.depth,
        "effects": [
            {
                "name": e.name,
                "place": e.place if e.known else "foreign",
                "form": e.form if e.known else "foreign",
                "target": e.target,
                "severity": e.s,
                "onset_s": e.onset,
                "values": e.values,
                "realised": size,
            }
            for e, size in zip(planted, sizes, strict=True)
        ],
    }
