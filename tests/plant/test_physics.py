"""The plant against closed forms, conservation laws and an oracle that is not ours (MuJoCo)."""

from __future__ import annotations

import dataclasses

import numpy as np
import plant_cases as cases
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rovval import vehicle as vehicles
from rovval.core.frames import euler_from_quaternion, quaternion_from_euler, rotation_from_euler, rotation_from_quaternion, wrap
from rovval.effects.library import tether_drag, tether_tension
from rovval.plant import Inputs, Plant, geometry, parse_settings
from rovval.vehicle.model import as_matrix, rigid_body_mass

ZERO6 = (0.0,) * 6


def energy(vehicle, nu, eta, added=True):
    """Kinetic energy of body and added mass, and of weight and buoyancy (z down), J."""
    mass = rigid_body_mass(vehicle.body) + (as_matrix(vehicle.body.added_mass) if added else 0.0)
    kinetic = 0.5 * np.einsum("...i,ij,...j->...", nu, mass, nu)
    rotation = rotation_from_euler(eta[..., 3:])[..., 2, :]
    depth = [eta[..., 2] + rotation @ np.array(p) for p in (vehicle.body.centre_of_gravity, vehicle.body.centre_of_buoyancy)]
    return kinetic - vehicle.weight * depth[0] + vehicle.buoyancy * depth[1]


@pytest.mark.parametrize("model", ["fossen", "freefloating"])
def test_energy_never_grows_in_still_water_without_thrust(model):
    rng = np.random.default_rng(0)
    for seed in range(3):
        vehicle = cases.random_vehicle(np.random.default_rng(seed))
        plant = Plant(vehicle, model, substeps=4)
        nu, eta = rng.normal(size=(64, 6)) * 0.5, rng.normal(size=(64, 6))
        out = plant.simulate(Inputs(0.05, np.zeros((101, 5)), True), np.zeros(64, int), 100, nu, eta, np.tile(plant.null, (64, 1)))
        e = energy(vehicle, out.nu, out.eta, model == "fossen")
        assert (np.diff(e, axis=1) < 1e-7 * np.abs(e).max()).all()


def test_energy_is_kept_without_drag():
    """Lossless body in still water: Coriolis terms and restoring forces do no net work."""
    vehicle = cases.changed(cases.random_vehicle(np.random.default_rng(3)), linear_drag=ZERO6, quadratic_drag=ZERO6)
    vehicle = cases.changed(vehicle, linear_drag=((0.0,) * 6,) * 6)
    plant = Plant(vehicle, substeps=20)
    rng = np.random.default_rng(4)
    nu, eta = rng.normal(size=(8, 6)) * 0.3, rng.normal(size=(8, 6)) * 0.3
    out = plant.simulate(Inputs(0.05, np.zeros((61, 5)), True), np.zeros(8, int), 60, nu, eta, np.tile(plant.null, (8, 1)))
    e = energy(vehicle, out.nu, out.eta)
    assert np.abs(e - e[:, :1]).max() < 1e-8 * np.abs(e).max()


def test_terminal_sink_speed():
    """d_l w + d_q w^2 = W - B."""
    vehicle = cases.merlin()
    out = cases.run(Plant(vehicle), seconds=400.0)
    linear, quadratic, net = 200.0, 2000.0, vehicle.weight - vehicle.buoyancy
    expected = (-linear + np.sqrt(linear**2 + 4 * quadratic * net)) / (2 * quadratic)
    assert out.nu[0, -1, 2] == pytest.approx(expected, rel=1e-9)


def test_steady_surge_speed():
    """Horizontal thrusters ahead on a neutral, well righted vehicle: d_l u + d_q u^2 = X."""
    vehicle = cases.merlin()
    vehicle = cases.changed(vehicle, volume=vehicle.body.mass / 1025.0)
    plant = Plant(vehicle)
    speed = np.zeros(7)
    speed[[3, 6]], speed[[4, 5]] = 1.0, -1.0
    thrust = plant.thrust(speed[None])[0]
    surge = float(thrust[[3, 6]].sum() - thrust[[4, 5]].sum()) * 0.70710678
    out = cases.run(plant, speed, seconds=300.0)
    gain = {"HFP": 63.918, "HAS": 23.0695, "HFS": 63.918, "HAP": 23.0695}
    assert surge == pytest.approx(sum(gain.values()) * 0.70710678, rel=1e-3)
    expected = (-150.0 + np.sqrt(150.0**2 + 4 * 1500.0 * surge)) / 3000.0
    assert np.hypot(*out.nu[0, -1, :2]) == pytest.approx(expected, rel=0.02)  # the four are not quite a pure surge force


@pytest.mark.parametrize(("axis", "inertia", "added"), [(3, 1224.179892, 122.4179892), (4, 2234.271553, 223.4271553)])
def test_roll_and_pitch_period(axis, inertia, added):
    """Small swing about an axis with weight at the origin: T = 2 pi sqrt((I + A) / (BG B))."""
    vehicle = cases.changed(cases.merlin(), linear_drag=ZERO6, quadratic_drag=ZERO6, Ixy=0.0, Ixz=0.0, Iyz=0.0, volume=2936.0 / 1025.0)
    eta = np.zeros(6)
    eta[axis] = 1e-3
    eta_dot = cases.run(Plant(vehicle, substeps=10), seconds=40.0, dt=0.05, eta=eta)
    angle = eta_dot.eta[0, :, axis]
    crossings = np.flatnonzero(np.diff(np.sign(angle)))
    t = (crossings + angle[crossings] / (angle[crossings] - angle[crossings + 1])) * 0.05
    period = 2 * np.mean(np.diff(t))
    assert period == pytest.approx(2 * np.pi * np.sqrt((inertia + added) / (0.10 * vehicle.buoyancy)), rel=1e-5)


def test_mirror_symmetry():
    """The mirrored vehicle with mirrored motion, current and thrusters moves as the mirror image."""
    flip_nu = np.array([1.0, -1, 1, -1, 1, -1])
    vehicle = cases.random_vehicle(np.random.default_rng(11))
    body, f = vehicle.body, flip_nu
    mirrored = cases.changed(
        vehicle, Ixy=-body.Ixy, Iyz=-body.Iyz,
        centre_of_gravity=tuple(np.array(body.centre_of_gravity) * [1, -1, 1]),
        centre_of_buoyancy=tuple(np.array(body.centre_of_buoyancy) * [1, -1, 1]),
        **{m: tuple(map(tuple, f[:, None] * as_matrix(getattr(body, m)) * f)) for m in ("added_mass", "linear_drag", "quadratic_drag")},
    )  # fmt: skip
    over = np.array([1, -1, 1])
    thrusters = tuple(
        t.model_copy(update={"position": tuple(t.position * over), "direction": tuple(t.direction * over), "handedness": -t.handedness})
        for t in vehicle.thruster
    )
    mirrored = mirrored.model_copy(update={"thruster": thrusters})
    a, b = Plant(vehicle), Plant(mirrored)
    rng = np.random.default_rng(12)
    inputs = dataclasses.replace(cases.random_inputs(rng, a), extra=None)
    nu, eta = cases.random_states(rng, 4)
    common = ["propeller_torque:arm=0.02", "inflow_loss:loss=0.3", "tether_drag:coefficient=20", "thrust_lag:tau=0.3"]
    one = parse_settings(a, [*common, "current_constant:north=0.2,east=0.3"])
    two = parse_settings(b, [*common, "current_constant:north=0.2,east=-0.3"])
    start = np.array([0, 50, 100, 200])
    x = a.simulate(inputs, start, 60, nu, eta, np.tile(one, (4, 1)))
    y = b.simulate(inputs, start, 60, nu * f, eta * f, np.tile(two, (4, 1)))
    assert np.abs(x.nu * f - y.nu).max() < 1e-11
    assert np.abs(wrap(x.eta[..., 3:] * f[3:] - y.eta[..., 3:])).max() < 1e-10


def test_galilean_invariance_under_a_uniform_current():
    """Carried by the water, the vehicle moves through it as in still water."""
    vehicle = cases.random_vehicle(np.random.default_rng(21))
    plant = Plant(vehicle, substeps=20)
    rng = np.random.default_rng(22)
    inputs = dataclasses.replace(cases.random_inputs(rng, plant), extra=None)
    nu, eta = cases.random_states(rng, 6)
    current = np.array([0.3, -0.2, 0.1])
    beta = parse_settings(plant, ["current_constant:north=0.3,east=-0.2,down=0.1"])
    start = np.full(6, 30)
    still = plant.simulate(inputs, start, 50, nu, eta, np.tile(plant.null, (6, 1)))
    carried = nu.copy()
    carried[:, :3] += np.einsum("bji,j->bi", rotation_from_euler(eta[:, 3:]), current)
    moving = plant.simulate(inputs, start, 50, carried, eta, np.tile(beta, (6, 1)))
    t = np.arange(51) * 0.1
    assert np.abs(moving.eta[..., :3] - t[None, :, None] * current - still.eta[..., :3]).max() < 1e-6
    assert np.abs(moving.nu[..., 3:] - still.nu[..., 3:]).max() < 1e-6


def test_fourth_order_in_the_step_with_the_lag_at_work():
    """Halving the step divides the error by sixteen; thruster speeds frozen over a step would make it two."""
    vehicle = cases.merlin()
    speed = 1.0 + 0.5 * np.sin(np.outer(np.arange(61) * 0.5, [1, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6]))
    out = []
    for substeps in (1, 2, 4, 8, 64):
        plant = Plant(vehicle, substeps=substeps)
        beta = parse_settings(plant, ["thrust_lag:tau=0.4", "current_constant:north=0.2", "inflow_loss:loss=0.2"])
        nu = np.array([[1.0, 1.0, 1.0, 0.4, 0.4, 0.4]])
        out.append(plant.simulate(Inputs(0.5, speed, False), np.array([10]), 4, nu, np.zeros((1, 6)), beta[None]).nu[0, -1])
    errors = [np.abs(o - out[-1]).max() for o in out[:-1]]
    orders = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    assert orders[-1] == pytest.approx(4.0, abs=0.35), (errors, orders)


def test_rigid_body_without_fluid_is_mujoco_s():
    """Free body with an off-centre mass and products of inertia, gravity and spin: an oracle that is not ours."""
    mujoco = pytest.importorskip("mujoco")
    vehicle = cases.changed(
        cases.merlin(), mass=30.0, Ixx=2.0, Iyy=3.0, Izz=4.0, Ixy=0.2, Ixz=-0.1, Iyz=0.3, added_mass=ZERO6, linear_drag=ZERO6,
        quadratic_drag=ZERO6, volume=1e-15, centre_of_gravity=(0.05, -0.03, 0.02),
    )  # fmt: skip
    plant = Plant(vehicle, substeps=10)
    nu = np.array([0.5, -0.3, 0.2, 1.0, -2.0, 1.5])
    ours = cases.run(plant, seconds=1.0, dt=0.02, nu=nu)
    m, r = 30.0, np.array([0.05, -0.03, 0.02])
    about_origin = np.array([[2.0, -0.2, 0.1], [-0.2, 3.0, -0.3], [0.1, -0.3, 4.0]])
    cross = np.array([[0, -r[2], r[1]], [r[2], 0, -r[0]], [-r[1], r[0], 0]])
    i = about_origin + m * cross @ cross
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><compiler balanceinertia="false"/><option gravity="0 0 9.81" timestep="0.0005" integrator="RK4" density="0" viscosity="0"/>
        <worldbody><body><freejoint/><inertial pos="{r[0]} {r[1]} {r[2]}" mass="{m}"
        fullinertia="{i[0, 0]} {i[1, 1]} {i[2, 2]} {i[0, 1]} {i[0, 2]} {i[1, 2]}"/></body></worldbody></mujoco>"""
    )
    data = mujoco.MjData(model)
    data.qvel[:] = nu  # at the origin, axes of body and world as one
    for _ in range(2000):
        mujoco.mj_step(model, data)
    rotation = rotation_from_quaternion(data.qpos[3:7])
    assert np.abs(ours.eta[0, -1, :3] - data.qpos[:3]).max() < 1e-6
    assert np.abs(rotation_from_euler(ours.eta[0, -1, 3:]) - rotation).max() < 1e-6
    assert np.abs(ours.nu[0, -1, :3] - rotation.T @ data.qvel[:3]).max() < 1e-6
    assert np.abs(ours.nu[0, -1, 3:] - data.qvel[3:]).max() < 1e-6


def test_attitude_survives_pitch_of_ninety_degrees():
    """A slow somersault through the vertical: a quaternion has no singular attitude."""
    vehicle = cases.changed(cases.merlin(), centre_of_buoyancy=(0.0, 0.0, 0.0), quadratic_drag=ZERO6, linear_drag=ZERO6, Ixy=0.0, Ixz=0.0, Iyz=0.0)
    out = cases.run(Plant(vehicle), seconds=10.0, nu=[0, 0, 0, 0, 0.5, 0], eta=[0, 0, 0, 0, 0, 0.3])
    assert np.abs(out.nu[0, :, 4] - 0.5).max() < 1e-9
    forward = rotation_from_euler(out.eta[0, :, 3:])[:, :, 0]
    assert np.abs(forward[:, 2] + np.sin(0.5 * np.arange(101) * 0.1)).max() < 1e-6


angles = st.floats(-1.5, 1.5)


@settings(max_examples=60, deadline=None)
@given(phi=st.floats(-3.1, 3.1), theta=angles, psi=st.floats(-3.1, 3.1))
def test_euler_and_quaternion_round_trip(phi, theta, psi):
    euler = np.array([phi, theta, psi])
    back = euler_from_quaternion(quaternion_from_euler(euler))
    assert np.abs(wrap(back - euler)).max() < 1e-9


@settings(max_examples=20, deadline=None)
@given(phi=st.floats(-3.1, 3.1), theta=angles, psi=st.floats(-3.1, 3.1))
def test_the_kernel_gives_an_attitude_back(phi, theta, psi):
    """Euler angles in, quaternion inside, the kernel's own arc tangents out."""
    out = cases.run(Plant(cases.merlin()), seconds=0.1, eta=[0, 0, 0, phi, theta, psi])
    assert np.abs(wrap(out.eta[0, 0, 3:] - [phi, theta, psi])).max() < 1e-9


def test_a_reversed_thruster_is_one_whose_shaft_turns_the_other_way():
    """T(-n), with the gain of that direction."""
    plant = Plant(cases.merlin())
    speed = np.linspace(-1.0, 1.0, 7)
    at = plant.vehicle.thrusters.index("HFS")
    beta = plant.null.copy()
    beta[plant.index["thruster_reversed[HFS].fraction"]] = 1.0
    turned = np.where(np.arange(7) == at, -speed, speed)
    assert np.allclose(cases.run(plant, speed, beta=beta).nu, cases.run(plant, turned).nu, rtol=0, atol=1e-12)


def test_a_thruster_loses_its_share_only_while_its_neighbour_runs():
    """Law of the tandem pair: nothing alone, half of the share at half the neighbour's speed, never more than the share."""
    plant = Plant(cases.merlin())
    names = plant.vehicle.thrusters
    at, other = names.index("HFP"), names.index("VFP")
    beta, weaker = plant.null.copy(), plant.null.copy()
    beta[plant.index["thruster_interaction[HFP].loss"]] = 0.4
    for neighbour, lost in ((0.0, 0.0), (-0.5, 0.2), (1.0, 0.4), (3.0, 0.4)):
        speed = np.zeros(7)
        speed[at], speed[other] = 1.0, neighbour
        weaker[plant.index["thruster_degraded[HFP].loss"]] = lost
        assert np.allclose(cases.run(plant, speed, beta=beta).nu, cases.run(plant, speed, beta=weaker).nu, rtol=0, atol=1e-12), neighbour


@pytest.mark.parametrize(
    ("name", "pairs"),
    [
        ("merlin", {"VFP": {"HFP"}, "VFS": {"HFS"}, "VAC": {"HAP", "HAS"}, "HFP": {"VFP"}, "HAP": {"VAC"}}),  # no free jet meets a thruster
        ("minerva", {"VP": {"LAT", "HS"}, "HP": {"LAT"}, "LAT": {"VP", "VS"}}),
        ("bluerov2_heavy", {"T5": {"T1", "T3"}, "T1": {"T5"}}),
    ],
)
def test_every_thruster_stands_in_the_jet_that_reaches_it_or_beside_its_nearest(name, pairs):
    vehicle_ = vehicles.load(name)
    jets = geometry.jets(vehicle_)
    for downstream, upstream in pairs.items():
        rows = np.flatnonzero(jets.pairs[:, 1] == vehicle_.thrusters.index(downstream))
        assert {vehicle_.thrusters[j] for j in jets.pairs[rows, 0]} == upstream
    assert set(jets.pairs[:, 1]) == set(range(len(vehicle_.thruster)))


def test_a_tether_damps_a_turn_by_its_arm_and_never_gives_power():
    """Tied aft it brakes a pure turn, N = -c |r| r |x|^3; tied at the origin it does not; what it takes is c |v|^3 at the attachment."""
    rng = np.random.default_rng(41)
    nu, (ax, az) = rng.normal(size=(200, 6)), rng.uniform(-2, 2, size=(2, 200))
    u, v, w, p, q, r = nu.T
    level = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
    line, place = (0.0,) * 6, (0.0,) * 3
    given = np.stack(tether_drag.wrench(*(30.0, 2.0, *line, ax, az, 10.0, *place, u, v, w, p, q, r, *level)), axis=-1)
    speed = np.linalg.norm(nu[:, :3] + np.cross(nu[:, 3:], np.stack([ax, 0 * ax, az], axis=-1)), axis=1)
    assert np.allclose((given * nu).sum(axis=1), -50.0 * speed**3, rtol=1e-12, atol=0)
    turning = (0.0, 0.0, 0.0, 0.0, 0.0, 0.5)
    assert tether_drag.wrench(*(30.0, 0.0, *line, -1.0, 0.0, 0.0, *place, *turning, *level))[5] == pytest.approx(-30.0 * 0.25)
    plant = Plant(cases.merlin())
    turns = []
    for setting in ("x=0", "x=-1"):
        beta = parse_settings(plant, [f"tether_drag:coefficient=400,{setting}"])
        turns.append(cases.run(plant, seconds=5.0, nu=[0, 0, 0, 0, 0, 0.5], beta=beta).nu[0, -1, 5])
    free = cases.run(plant, seconds=5.0, nu=[0, 0, 0, 0, 0, 0.5]).nu[0, -1, 5]
    assert turns[0] == pytest.approx(free, rel=1e-3) and turns[1] < 0.97 * free


def test_a_pull_keeps_its_size_and_points_to_where_it_is_held():
    """Tension T at the log's origin towards A = T / (|T| nearness); far away it is the same everywhere; none is none."""
    rng, pull, nearness = np.random.default_rng(43), np.array([6.0, -3.0, 2.0]), 0.05
    x, y, z = rng.uniform(-8.0, 8.0, (3, 50))

    def given(size: float, near: float) -> np.ndarray:
        n, e, d = size * pull
        return np.stack(tether_tension.wrench(n, e, d, near, 0.0, 0.0, 0.0, 0.0, 0.0, x, y, z, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)[:3], axis=-1)

    size = float(np.linalg.norm(pull))
    towards = pull / (size * nearness) - np.stack([x, y, z], axis=-1)
    assert np.allclose(given(1.0, nearness), size * towards / np.linalg.norm(towards, axis=1)[:, None], rtol=1e-9)
    assert np.allclose(given(1.0, 0.0), pull, rtol=1e-9)
    assert not given(0.0, nearness).any()


def test_minerva_thrust_is_its_cubic():
    """rho D^4 n|n| theta K_T(J_a) at J_a = 0.5 ahead: K_T = 0.5/8 - 0.66/4 - 0.25/2 + 0.24 = 0.0125."""
    v = vehicles.load("minerva")
    plant = Plant(v)
    n, d = 10.0, 0.22
    at_rest = plant.thrust(np.array([[0, 0, 0, n, n]]))[0, 3]
    assert at_rest == pytest.approx(1025 * d**4 * n**2 * 0.72 * 0.24, rel=1e-6)
    u = 0.5 * n * d / 0.985
    dt = 1e-5
    speed = np.array([0, 0, 0, n, n])
    on, off = (cases.run(plant, s, seconds=dt, dt=dt, nu=[u, 0, 0, 0, 0, 0]).nu[0, 1, 0] for s in (speed, 0 * speed))
    force = (on - off) / dt * (460 + 293)
    assert force == pytest.approx(2 * 0.985 / np.hypot(0.985, 0.174) * 1025 * d**4 * n**2 * 0.72 * 0.0125, rel=0.01)
