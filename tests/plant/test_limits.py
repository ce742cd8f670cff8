"""What the plant refuses, where it stops a lane, and what else it computes: equation 2.4, lags."""

from __future__ import annotations

import os
import subprocess
import sys
from functools import partial
from pathlib import Path

import numpy as np
import plant_cases as cases
import pytest
from real_data import real

from rovval import vehicle
from rovval.core.errors import BadInput, UsageProblem
from rovval.plant import Inputs, Plant, electrical, parse_settings
from rovval.plant import thruster_lag as lag
from rovval.plant.reference import plant as oracle


def test_a_lane_that_leaves_sane_limits_stops_with_reason_and_time():
    """Its neighbours go on, and no NaN is left behind."""
    plant = Plant(cases.merlin())
    speed = np.zeros((101, 7))
    speed[50:] = 500.0
    out = plant.simulate(Inputs(0.1, speed, True), np.array([0, 0]), 100, np.zeros((2, 6)), np.zeros((2, 6)), np.tile(plant.null, (2, 1)))
    assert (out.stopped > 50).all() and (out.stopped < 60).all()
    assert ("m/s" in out.why[0] or "rad/s" in out.why[0]) and "lane 0 stopped at 5." in out.why[0]
    assert np.isfinite(out.nu).all()
    assert (out.nu[0, out.stopped[0] :] == out.nu[0, out.stopped[0] - 1]).all()


@pytest.mark.parametrize(("hold", "last"), [(True, 30), (False, 29)])
def test_a_lane_stops_where_thruster_speed_is_missing(hold, last):
    plant = Plant(cases.merlin())
    speed = np.ones((101, 7))
    speed[30, 2] = np.nan
    out = plant.simulate(Inputs(0.1, speed, hold), np.array([0, 40]), 50, np.zeros((2, 6)), np.zeros((2, 6)), np.tile(plant.null, (2, 1)))
    assert out.stopped.tolist() == [last + 1, -1]
    assert out.why == (f"lane 0 stopped at {(last + 1) / 10:.1f} s: thruster speed missing in the log",)
    assert np.isfinite(out.nu).all()


def test_a_load_that_is_set_down_takes_inertia_with_it_and_never_all_of_it():
    """A push astern moves the lighter vehicle more; a mass taken from so far out that nothing is left to turn stops the lane when it goes, in the kernel and
    in its oracle, and the lane beside it goes on."""
    plant = Plant(cases.merlin())
    beta = np.tile(plant.null, (3, 1))
    at = {name: plant.index[f"payload_change.{name}"] for name in ("mass", "onset", "x")}
    beta[:, at["onset"]], beta[1, at["mass"]], beta[2, [at["mass"], at["x"]]] = 1.0, -300.0, (-1000.0, 3.0)
    inputs, zero = Inputs(0.1, np.tile([3.0, 3.0, 0, 0, 0, 0, 0], (60, 1)), True), np.zeros((3, 6))
    for simulate in (plant.simulate, partial(oracle.simulate, plant)):
        out = simulate(inputs, np.zeros(3, int), 50, zero, zero, beta)
        assert out.stopped.tolist() == [-1, -1, 11]
        assert np.allclose(out.nu[0, :11], out.nu[1, :11], rtol=0, atol=1e-15)
        assert 1.01 < (out.nu[1, 20, 0] - out.nu[1, 10, 0]) / (out.nu[0, 20, 0] - out.nu[0, 10, 0]) < 1.2
    assert plant.simulate(inputs, np.zeros(3, int), 50, zero, zero, beta).why == ("lane 2 stopped at 1.1 s: the payload that was set down leaves no inertia",)


def test_settings_are_refused_by_name_and_all_at_once():
    plant = Plant(cases.merlin())
    with pytest.raises(UsageProblem) as refusal:
        parse_settings(plant, ["inflow_los:loss=0.3", "thruster_degraded:loss=1", "inflow_loss:los=1", "dvl_scale:scale=9", "dvl_scale:scale=x"])
    message = str(refusal.value)
    parts = ("no effect named 'inflow_los'", "thruster_degraded[HFP]", "inflow_loss has loss", "dvl_scale.scale = 9, allowed -0.7 to 1.2")
    for part in (*parts, "'x' is not a number"):
        assert part in message
    assert parse_settings(plant, ["thruster_degraded[HFP]:loss=0.4", "waves:amplitude=0.2,period=5"])[plant.index["waves.period"]] == 5


def test_out_of_bounds_parameters_are_refused_by_name():
    plant = Plant(cases.merlin())
    beta = plant.null.copy()
    beta[plant.index["dvl_scale.scale"]] = 1.5
    beta[plant.index["gyro_bias.r"]] = np.nan
    with pytest.raises(UsageProblem, match=r"(?s)dvl_scale.scale = 1.5, .*gyro_bias.r = nan"):
        cases.run(plant, beta=beta)


def test_an_effect_without_its_channel_is_refused():
    plant = Plant(cases.merlin())
    with pytest.raises(UsageProblem, match="ground_effect needs altitude"):
        cases.run(plant, beta=parse_settings(plant, ["ground_effect:gain=100"]))


@pytest.mark.parametrize("voltage", [None, np.full(11, np.nan)])
def test_a_parameter_without_its_channel_is_refused(voltage):
    plant, still = Plant(cases.merlin()), np.zeros((1, 6))
    inputs = Inputs(0.1, np.zeros((11, 7)), False, voltage=voltage)
    beta = parse_settings(plant, ["voltage_sag:gain=1,rate=1e-5"])
    with pytest.raises(UsageProblem, match=r"voltage_sag\.gain needs voltage"):
        plant.simulate(inputs, np.zeros(1, int), 5, still, still, beta[None])
    plant.simulate(inputs, np.zeros(1, int), 5, still, still, parse_settings(plant, ["voltage_sag:rate=1e-5"])[None])


def test_shapes_that_do_not_fit_are_refused_together():
    plant = Plant(cases.merlin())
    with pytest.raises(BadInput, match=r"(?s)nu0 is .*8 thruster speeds for 7.*samples 0 to 50 of a log of 11"):
        plant.simulate(Inputs(0.1, np.zeros((11, 8)), False), np.zeros(1, int), 50, np.zeros((2, 6)), np.zeros((1, 6)), plant.null[None])


def test_freefloating_has_no_added_mass_and_no_linear_drag():
    """Thesis 2.1 and 2.3: at the first instant the acceleration is T / m; slow motion does not decay."""
    neutral = cases.changed(cases.merlin(), volume=2936.0 / 1025.0)
    fossen, free = Plant(neutral), Plant(neutral, "freefloating")
    nu = [1e-4, 0, 0, 0, 0, 0]
    a, b = (cases.run(p, seconds=10.0, nu=nu).nu[0, -1, 0] for p in (fossen, free))
    assert a == pytest.approx(1e-4 * np.exp(-150.0 / 4404.0 * 10), rel=1e-3)
    assert b == pytest.approx(1e-4, rel=1e-3)


def test_equation_2_4_recovers_a_motor_and_states_its_fit_error():
    thrust = np.array([-40.0, -20, -5, 3, 10, 30, 50])
    truth = electrical.Electrical(0.05, 0.6, 0.0, 0.0, 0, 0.0, 0.0)
    found = electrical.fit(truth.voltage(thrust), thrust)
    assert (found.resistive, found.back_emf) == pytest.approx((0.05, 0.6)) and found.rms < 1e-12
    assert found.thrust(found.voltage(thrust)) == pytest.approx(thrust)
    assert "rms error 0.000 V" in str(found)


def test_equation_2_4_on_the_thruster_bench():
    volts, thrust = np.loadtxt(real("thruster_bench/Steady_State_Data.csv"), delimiter=",")[:, :2].T
    found = electrical.fit(volts, thrust)
    assert found.n == 10 and 0.3 < found.rms < 0.5 and "at its bound of 0" in str(found)


def test_lags_settle_and_first_order_is_exponential():
    step = np.repeat([[0.0], [1.0]], [1, 40], axis=0)
    first = lag.first_order(step, 0.05, 0.2)[:, 0]
    assert first[1:] == pytest.approx(1 - np.exp(-0.05 * np.arange(40) / 0.2))
    third = lag.third_order(step, 0.05)[:, 0]
    assert third[-1] == pytest.approx(1.0, abs=1e-6) and third[2] > 0.5
    held, changed = lag.saturate(np.array([[3.0, -9.0]]), 5.0)
    assert held.tolist() == [[3.0, -5.0]] and changed.tolist() == [[False, True]]


def test_minerva_thrust_is_its_cubic():
    """rho D^4 n|n| theta K_T(J_a) at J_a = 0.5 ahead: K_T = 0.5/8 - 0.66/4 - 0.25/2 + 0.24 = 0.0125."""
    v = vehicle.load("minerva")
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


@pytest.mark.slow
def test_a_kernel_cache_that_cannot_be_written_is_no_hindrance(tmp_path):
    """And whoever waits for a compilation is told so on stderr."""
    code = "import plant_cases as c; from rovval.plant import Plant; print(c.run(Plant(c.merlin())).nu.shape)"
    blocked = tmp_path / "file"
    blocked.write_text("")
    environment = {**os.environ, "ROVVAL_CACHE": str(blocked / "below"), "PYTHONPATH": str(Path(__file__).parents[1] / "cases")}
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "(1, 11, 6)" and "compiling" in done.stderr
    assert "once for this machine" not in done.stderr and "ROVVAL_CACHE" in done.stderr


def test_a_parameter_given_twice_is_refused():
    """The last one used to win in silence."""
    plant = Plant(cases.merlin())
    for settings in (["inflow_loss:loss=0.1", "inflow_loss:loss=0.2"], ["inflow_loss:loss=0.1,loss=0.2"]):
        with pytest.raises(UsageProblem, match=r"inflow_loss.loss is given twice, 0.1 and 0.2"):
            parse_settings(plant, settings)
