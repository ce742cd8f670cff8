"""The independent plant against closed forms and conservation laws."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from blind_case import LIBRARY, bare, vehicle_file
from scipy.spatial.transform import Rotation

from rovval.blind.cases import flight as plant
from rovval.blind.cases.visibility import RecordedSpeeds
from rovval.blind.plant.dynamics import BASE, Plant
from rovval.blind.plant.environment import draw_setting
from rovval.blind.plant.motor import motor
from rovval.blind.plant.nominal_vehicle import read_vehicle
from rovval.blind.plant.parameters import nominal_parameters
from rovval.blind.plant.rotation import euler, matrix, quaternion
from rovval.blind.plant.scales import rpm_for, scales
from rovval.blind.plant.spec import STEP_S, Planted, stream
from rovval.blind.planted.catalogue import build


@pytest.fixture(scope="module")
def merlin() -> Path:
    return vehicle_file("merlin")


def run(body: Plant, y: np.ndarray, seconds: float) -> list[np.ndarray]:
    states, step = [y], 0.02
    for _ in range(round(seconds / STEP_S)):
        y, step = plant.integrate(body, 0.0, y, step, plant.tolerances(body, body.scale))
        states.append(y)
    return states


def thrown(body: Plant) -> np.ndarray:
    """Tilted and moving on all six axes."""
    y = np.zeros(body.size)
    y[2], y[3:7] = 20.0, quaternion(0.4, -0.3, 1.0)
    y[7:13] = body.mass @ np.array([0.6, -0.4, 0.3, 0.2, -0.15, 0.25])
    return y


def energy(body: Plant, y: np.ndarray) -> float:
    """Kinetic energy of body and water, and potential of weight and buoyancy."""
    down = np.array(matrix(*y[3:7])[6:9])
    p = body.p
    moment = p.mass * p.gravity_centre - p.density * p.volume * p.buoyancy_centre
    potential = -p.gravity * ((p.mass - p.density * p.volume) * y[2] + moment @ down)
    return float(0.5 * y[7:13] @ body.inverse @ y[7:13] + potential)


@pytest.mark.parametrize("name", ["merlin", "bluerov2_heavy"])
def test_energy_never_grows_without_thrust(name: str) -> None:
    body = bare(vehicle_file(name), neutral=False)
    levels = np.array([energy(body, y) for y in run(body, thrown(body), 30.0)])
    assert np.all(np.diff(levels) <= 1e-5 * abs(levels[0]))
    assert levels[-1] < levels[0]


def test_without_drag_energy_and_world_momentum_are_kept(merlin: Path) -> None:
    body = bare(merlin, neutral=True, drag=0.0)
    states = run(body, thrown(body), 10.0)
    levels = [energy(body, y) for y in states]
    assert max(levels) - min(levels) < 1e-4 * abs(levels[0])
    world = [np.array(matrix(*y[3:7])).reshape(3, 3) @ y[7:10] for y in states]
    assert np.allclose(world, world[0], atol=1e-3 * np.linalg.norm(world[0]))


def test_steady_surge_speed_is_the_root_of_thrust_and_drag(merlin: Path) -> None:
    body, nominal = bare(merlin, neutral=True), read_vehicle(merlin)
    push = 700.0
    y = np.zeros(body.size)
    y[3] = 1.0
    y[BASE : BASE + body.many] = rpm_for(push * body.scale.share[:, 0], nominal.k_pos, nominal.k_neg)
    speed = body.see(0.0, run(body, y, 60.0)[-1]).vel[0]
    a, b = nominal.quadratic_drag[0], nominal.linear_drag[0]
    assert speed == pytest.approx((-b + math.sqrt(b * b + 4.0 * a * push)) / (2.0 * a), rel=1e-4)


def test_terminal_sink_speed(merlin: Path) -> None:
    body, nominal = bare(merlin, neutral=False), read_vehicle(merlin)
    y = np.zeros(body.size)
    y[3] = 1.0
    load = (nominal.mass - nominal.density * nominal.volume) * nominal.gravity
    sink = body.see(0.0, run(body, y, 240.0)[-1]).vel[2]
    a, b = nominal.quadratic_drag[2], nominal.linear_drag[2]
    assert sink == pytest.approx((-b + math.sqrt(b * b + 4.0 * a * load)) / (2.0 * a), rel=1e-3)


def test_a_current_carries_an_idle_vehicle_away(merlin: Path) -> None:
    nominal = read_vehicle(merlin)
    setting = draw_setting(nominal, scales(nominal), 1, 60.0)
    current = build(Planted("current_constant"), nominal, scales(nominal), setting)
    body = Plant(bare(merlin, neutral=True).healthy, [current], scales(nominal), RecordedSpeeds(np.zeros(7)), setting.bottom)
    last = run(body, plant.initial(body, setting), 60.0)[-1]
    k = body.see(0.0, last)
    ground = np.array(k.r).reshape(3, 3) @ k.vel[:3]
    assert np.allclose(ground[:2], k.water[:2], atol=0.25 * math.hypot(*k.water[:2]))


def test_quaternion_and_euler_agree_with_scipy() -> None:
    for angles in ((0.1, -0.4, 2.9), (-1.2, 1.1, -0.3), (3.0, 0.2, 0.0)):
        q = quaternion(*angles)
        other = Rotation.from_euler("ZYX", angles[::-1]).as_matrix()
        assert np.allclose(np.array(matrix(*q)).reshape(3, 3), other)
        assert np.allclose(euler(*q), angles)


def test_the_motor_settles_on_its_set_point(merlin: Path) -> None:
    nominal = read_vehicle(merlin)
    drive = motor(scales(nominal), 7, stream(1, "motor"))
    y, out = np.zeros(14), np.zeros(14)
    for _ in range(4000):
        drive.derivative(np.full(7, 150.0), y, out, 0, 7)
        y += 0.005 * out
    assert np.allclose(y[:7], 150.0, atol=0.5)


def test_thrust_under_way_is_the_file_s_open_water_curve():
    """Minerva's K_T of the public project, ahead 0.5 J^3 - 0.66 J^2 - 0.25 J + 0.24, astern 0.025 J^3 - 0.28 J^2 + 0.17 J + 0.15."""
    nominal = read_vehicle(LIBRARY / "minerva.toml")
    body = Plant(nominal_parameters(nominal), [], scales(nominal), RecordedSpeeds(np.zeros(len(nominal.thrusters))), 1e6)
    unit, speed = nominal.thrusters.index("HS"), 0.4
    axial = float(nominal.directions[unit] @ np.array([speed, 0.0, 0.0]))
    for n, curve in ((600.0, (0.5, -0.66, -0.25, 0.24)), (-600.0, (0.025, -0.28, 0.17, 0.15))):
        j = axial / (n / 60.0 * nominal.diameter[unit])
        turn = np.full(len(nominal.thrusters), n)
        said = body.under_way(turn, [speed, 0.0, 0.0, 0.0, 0.0, 0.0])[unit]
        assert said == pytest.approx(np.polyval(curve, j) / curve[-1], rel=1e-6)
    assert not Plant(nominal_parameters(read_vehicle(LIBRARY / "merlin.toml")), [], scales(nominal), RecordedSpeeds(np.zeros(7)), 1e6).advancing
