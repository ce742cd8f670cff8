"""The platforms: what each takes of a vehicle, and that uuv is the source's algorithm, written out here step by step."""

from __future__ import annotations

import numpy as np
import plant_cases as cases
import pytest

from rovval.cli.options import Model
from rovval.core.errors import UsageProblem
from rovval.plant import Inputs, Plant, platforms
from rovval.vehicle.model import as_matrix


@pytest.mark.parametrize("name", platforms.names())
def test_every_platform_says_what_it_is_and_can_be_asked_for(name):
    platform = platforms.load(name)
    assert platform.title and platform.equations and platform.source and platform.leaves_out
    assert Model(name) and Plant(cases.merlin(), name).model == name


def test_only_platforms_can_be_asked_for():
    assert {m.value for m in Model} == set(platforms.names())
    with pytest.raises(UsageProblem, match="platform"):
        Plant(cases.merlin(), "gazebo")


def surge_of_the_source(mass: float, added: float, linear: float, quadratic: float, thrust: float, lag: float, seconds: float) -> float:
    """Surge speed from rest in uuv_simulator on one axis: HMFossen's force, `FirstOrder` thrusters, ODE's step; thrust is switched on at rest."""
    h, alpha = 0.002, 0.3
    u = before = filtered = share = 0.0
    for k in range(round(seconds / h)):
        filtered = (1 - alpha) * filtered + alpha * ((u - before) / h if k else 0.0)
        before = u
        force = thrust * share * abs(share) - added * filtered - (linear + quadratic * abs(u)) * u
        u += h * force / mass
        share = share * np.exp(-h / lag) + (1 - np.exp(-h / lag))
    return u


def test_uuv_on_one_axis_is_the_algorithm_of_its_source():
    """A neutral Merlin that pushes straight ahead with all its thrust in its middle: one axis, nothing else moves."""
    merlin = cases.merlin()
    ahead = merlin.thruster[0].model_copy(update={"position": (0.0, 0.0, 0.0), "direction": (1.0, 0.0, 0.0)})
    vehicle = cases.changed(merlin.model_copy(update={"thruster": (ahead,), "uuv": None}), volume=merlin.body.mass / 1025.0)
    plant = Plant(vehicle, "uuv")
    speed = np.full((101, 1), 10.0)
    speed[0] = 0.0  # the answer to a command begins settled: at rest
    inputs = Inputs(0.1, speed, hold=True)
    out = plant.simulate(inputs, np.zeros(1, int), 100, np.zeros((1, 6)), np.zeros((1, 6)), plant.null[None])
    thrust = ahead.k_pos * 600.0**2
    expected = [surge_of_the_source(2936.0, 1468.0, 150.0, 1500.0, thrust, 0.05, 0.1 * k) for k in (1, 10, 99)]
    assert out.nu[0, [2, 11, 100], 0] == pytest.approx(expected, rel=1e-9)
    assert np.abs(out.nu[0, :, 1:]).max() < 1e-12


def test_uuv_without_lag_and_with_the_file_s_thrust_comes_to_fossen_s_motion():
    """The same equation: what is left is the engine's step of 2 ms and the filter's, some thousandths."""
    merlin = cases.merlin()
    same = merlin.model_copy(update={"uuv": merlin.uuv.model_copy(update={"time_constant": 0.0, "k_pos": (), "k_neg": ()})})
    rng = np.random.default_rng(2)
    speed = np.repeat(rng.normal(size=(30, 7)), 20, axis=0) * 2.0
    start = (np.zeros(1, int), 599, np.zeros((1, 6)), np.array([[0, 0, 20.0, 0.1, -0.05, 1.0]]))
    uuv, fossen = (Plant(same, name).simulate(Inputs(0.1, speed, True), *start, Plant(same, name).null[None]) for name in ("uuv", "fossen"))
    assert np.abs(uuv.nu - fossen.nu).max() < 0.005 * np.abs(fossen.nu).max()
    assert np.abs(uuv.eta[..., :3] - fossen.eta[..., :3]).max() < 0.02


def test_uuv_s_step_is_its_own_whatever_the_log_s():
    """Half the sample time, the same motion."""
    plant = Plant(cases.merlin(), "uuv")
    assert [plant.steps(dt) for dt in (0.1, 0.05, 0.02)] == [50, 25, 10]
    state = (np.zeros((1, 6)), np.array([[0, 0, 20.0, 0, 0, 0]]), plant.null[None])
    coarse, fine = (plant.simulate(Inputs(0.1 / m, np.full((50 * m + 1, 7), 1.0), True), np.zeros(1, int), 50 * m, *state) for m in (1, 2))
    assert coarse.nu[0, -1] == pytest.approx(fine.nu[0, -1], rel=1e-9, abs=1e-12)


def test_uuv_refuses_a_body_that_its_added_mass_makes_unstable():
    heavy = cases.changed(cases.merlin(), added_mass=(20000.0, 1.0, 1.0, 1.0, 1.0, 1.0))
    with pytest.raises(UsageProblem, match=r"6\.81 times.*unstable from 5\.67"):
        Plant(heavy, "uuv")


def test_uuv_takes_the_diagonal_of_quadratic_drag_and_no_inflow():
    vehicle = cases.random_vehicle(np.random.default_rng(1))
    taken = Plant(vehicle, "uuv").simulated
    assert as_matrix(taken.body.quadratic_drag) == pytest.approx(np.diag(np.diag(as_matrix(vehicle.body.quadratic_drag))))
    assert all(t.advance_pos == t.advance_neg == (0.0, 0.0, 0.0) for t in taken.thruster)


def test_restoring_is_the_same_on_every_platform():
    """Held still and tilted, a trimmed vehicle begins to right itself at the rate of its moments over its inertia."""
    eta = np.array([[0, 0, 20.0, 0.3, 0, 0]])
    for name in platforms.names():
        plant = Plant(cases.merlin(), name)
        out = plant.simulate(Inputs(0.1, np.zeros((3, 7)), True), np.zeros(1, int), 2, np.zeros((1, 6)), eta, plant.null[None])
        assert -0.2 < out.nu[0, -1, 3] < -0.05, name

