"""Every file of effects/ keeps the contract: what it says, what it asks for, and that a sensor's log starts where it was measured."""

from __future__ import annotations

import inspect
from dataclasses import replace

import numpy as np
import plant_cases as cases
import pytest

from rovval import effects, vehicle
from rovval.core.channels import AXES, CHANNELS
from rovval.core.frames import wrap
from rovval.effects.lanes import jet_on_hull
from rovval.effects.library import thruster_deadband
from rovval.effects.literature import REFERENCES
from rovval.effects.literature import key as reference
from rovval.effects.log import Log
from rovval.plant import Inputs, Plant
from rovval.plant.codegen import spec as compose
from rovval.plant.sensors import observe

LIBRARY = """added_mass linear_drag quadratic_drag cross_drag current_constant current_shear current_varying waves density_gradient
ground_effect wall_suction tether_drag tether_tension tether_snag buoyancy_error cg_offset payload_change inertia_error thruster_degraded
thruster_fault_onset thruster_deadband thruster_reversed reverse_asymmetry thrust_lag inflow_loss crossflow_loss hull_interaction
thruster_interaction thruster_misaligned propeller_torque rpm_scale voltage_sag time_offset clock_drift dvl_scale dvl_misalignment
dvl_lever_arm gyro_bias compass_deviation attitude_bias velocity_filter_lag""".split()


def test_every_name_of_the_contract_is_there():
    assert set(LIBRARY) <= set(effects.names())


@pytest.mark.parametrize("name", effects.names())
def test_an_effect_says_what_an_engineer_needs(name):
    effect = effects.load(name)
    assert effect.name == name and effect.title and effect.signature and effect.separates
    assert effect.place in ("vehicle", "input", "water", "wrench", "sensor")
    assert effect.equation and effect.symbols and all(effect.symbols.values())
    assert effect.literature and {reference(cited) for cited in effect.literature} <= set(REFERENCES)
    assert effect.confused_with and set(effect.confused_with) <= set(effects.names()) - {name}
    assert (effect.per == "axis") == bool(effect.axes) and set(effect.axes) <= set(AXES)
    assert {*effect.needs, *effect.needs_one_of} <= set(CHANNELS)


@pytest.mark.parametrize("name", effects.names())
def test_the_parameters_of_an_effect_are_what_the_search_needs(name):
    effect = effects.load(name)
    assert set(effect.refines) <= {p.name for p in effect.parameters}
    assert any(not p.places for p in effect.parameters), "nothing says how strong it is"
    for p in effect.parameters:
        assert p.source and p.unit and p.low <= p.null <= p.high and p.typical > 0
        assert all(p.low <= v <= p.high for v in p.starts)
        assert not p.channel or p.channel in CHANNELS
        assert p.tolerance is None or p.tolerance.source
    assert effect.continues in ("", *effects.names())
    assert not effect.continues or all(p.starts for p in effect.parameters), "it begins as large as it is searched from"
    assert bool(effect.stage) == hasattr(effects.module(name), "observe"), "a sensor's effect says where on the way into the log it acts"


@pytest.mark.parametrize("name", effects.names())
def test_an_effect_asks_only_for_what_there_is(name):
    module = effects.module(name)
    kinds = [k for k in (*compose.HOOKS, "lower", "observe") if hasattr(module, k)]
    assert kinds, "an effect must act somewhere"
    rows = getattr(module, "ROWS", ())
    assert hasattr(module, "rows") == bool(rows)
    assert hasattr(module, "observe") == hasattr(module, "unobserve")
    for kind in kinds:
        if kind in compose.HOOKS:
            known = compose.THRUSTER_NAMES if kind in compose.PER_THRUSTER else compose.BODY_NAMES
            assert set(inspect.signature(getattr(module, kind)).parameters) <= {*rows, *known}


@pytest.mark.parametrize("name", [n for n in effects.names() if effects.load(n).place == "sensor"])
def test_a_sensor_s_log_starts_where_it_was_measured(name):
    """The first state is what the log says; the simulated log begins there, whatever the sensor does."""
    plant = Plant(cases.merlin())
    beta = plant.null.copy()
    for hypothesis, columns in plant.hypotheses.items():
        if hypothesis.partition("[")[0] == name:
            beta[list(columns)] = [min(plant.slots[c].parameter.null + plant.slots[c].parameter.typical, plant.slots[c].parameter.high) for c in columns]
    assert (beta != plant.null).any()
    rng = np.random.default_rng(0)
    nu, eta = cases.random_states(rng, 5)
    inputs = Inputs(0.1, np.ones((50, 7)), False)
    out = plant.simulate(inputs, np.full(5, 10), 20, nu, eta, np.tile(beta, (5, 1)))
    assert np.abs(out.nu[:, 0] - nu).max() < 1e-12
    assert np.abs(np.angle(np.exp(1j * (out.eta[:, 0] - eta)))).max() < 1e-12


def test_the_jet_that_meets_the_hull_most_squarely_loses_what_the_effect_says():
    """Vectored thrusters of a BlueROV2 blow at it when they push out (which is astern of their thrust), all alike, the upright ones past it; of a
    Merlin the upright ones meet it most."""
    small, large = (jet_on_hull(vehicle.load(n)) for n in ("bluerov2_heavy", "merlin"))
    assert np.allclose(small, [[0.0, 1.0]] * 4 + [[0.0, 0.0]] * 4)
    assert large.max() == 1.0 and large[:2].max() == 1.0 and np.all((large[3:].max(axis=1) > 0.6) & (large[3:].max(axis=1) < 0.75))
    assert np.all(np.minimum(large[:, 0], large[:, 1]) == 0.0)


def test_a_window_reproduces_the_log_that_its_own_effects_made():
    """Shooting from a logged state with the true effects gives the log back: the part of a motion that a filter or a delay has not shown yet is
    simulated, to some per cent of speeds that here reach 0.6 m/s and of rates that reach 1.9 rad/s."""
    plant = Plant(cases.merlin())
    rng = np.random.default_rng(1)
    inputs = cases.random_inputs(rng, plant)
    for key, value, tolerance in (
        ("dvl_misalignment.yaw", 0.2, 1e-9), ("dvl_lever_arm.x", 0.5, 1e-9), ("compass_deviation.sine", 0.2, 1e-9), ("attitude_bias.phi", 0.05, 1e-9),
        ("time_offset.tau", 0.25, 1e-9), ("thrust_lag.tau", 0.3, 1e-9), ("gyro_bias.r", 0.02, 1e-9), ("velocity_filter_lag.tau", 0.3, 0.03),
        ("time_offset[velocity].delay", 0.3, 0.02), ("time_offset[attitude].delay", 0.3, 0.001), ("time_offset[velocity].delay", 0.65, 0.12),
        ("time_offset[attitude].delay", 0.65, 0.005), ("time_offset[velocity].delay", -0.65, 0.03), ("time_offset[attitude].delay", -0.65, 0.02),
        ("time_offset[depth].delay", 0.3, 1e-9),
    ):  # fmt: skip
        beta = plant.null.copy()
        beta[plant.index[key]] = value
        zero = np.zeros((1, 6))
        log = plant.simulate(inputs, np.zeros(1, int), 150, zero, zero, beta[None])
        window = plant.simulate(inputs, np.array([80]), 60, log.nu[:, 80], log.eta[:, 80], beta[None])
        assert np.abs(window.nu - log.nu[:, 80:141]).max() < tolerance, (key, value)


@pytest.mark.parametrize("key", ["time_offset[velocity].delay", "time_offset[attitude].delay", "time_offset[depth].delay", "velocity_filter_lag.tau"])
def test_a_window_goes_over_without_a_jump_from_one_delay_to_the_next(key):
    """At no delay at all, and at each whole sample of it, where another sample of the log is the first that counts: a jump there, of half a sensor's noise
    before this was held, is a slope of its own in every linearisation across it, and the larger the smaller the step is."""
    plant, rng = Plant(cases.merlin()), np.random.default_rng(3)
    inputs, tiny = cases.random_inputs(rng, plant), 1e-7
    nu, eta = cases.random_states(rng, 1)
    least = plant.slots[plant.index[key]].parameter.low
    delays = [d for d in (0.0, 0.1, 0.2, -0.1, -0.2) if d >= least]
    beta = np.tile(plant.null, (2 * len(delays), 1))
    beta[:, plant.index[key]] = [max(d + side * tiny, least) for d in delays for side in (-1, 1)]
    many = np.ones((len(beta), 1))
    out = plant.simulate(inputs, np.full(len(beta), 60), 30, nu * many, eta * many, beta)
    motion = np.concatenate([out.nu, out.eta], axis=-1).reshape(len(delays), 2, 31, 12)
    assert np.abs(motion[:, 1] - motion[:, 0]).max() < 100.0 * tiny  # m/s, rad/s, m and rad per second of delay
    assert np.abs(motion[:, 1] - motion[:, 0]).max() > 1e-3 * tiny


def test_sensors_of_many_lanes_are_those_of_one_lane_at_a_time():
    """Lanes side by side, apart and all at once, several effects on one of them; the motion handed in stays as it was."""
    plant, rng = Plant(cases.merlin()), np.random.default_rng(2)
    nu, eta, nu0, eta0 = (0.3 * rng.normal(size=size) for size in ((6, 40, 6), (6, 40, 6), (6, 6), (6, 6)))
    motion = Log(nu, eta, 0.1, nu0, eta0)
    beta = np.tile(plant.null, (6, 1))
    for key, value, lanes in (
        ("gyro_bias.r", 0.02, slice(None)), ("dvl_lever_arm.x", 0.5, [0, 2, 5]), ("dvl_misalignment.yaw", 0.2, [1, 2, 3]), ("compass_deviation.sine", 0.2, [4]),
        ("velocity_filter_lag.tau", 0.3, [2, 3]), ("time_offset[velocity].delay", -0.25, [0, 3]),
        ("time_offset[attitude].delay", 0.15, [3, 5]), ("time_offset[depth].delay", 0.2, [0, 3]), ("time_offset.tau", 0.2, [1]),
    ):  # fmt: skip
        beta[lanes, plant.index[key]] = value
    before = motion.nu.copy(), motion.eta.copy()
    seen = observe(plant.vehicle, plant.index, plant.null, beta, motion)
    assert np.array_equal(motion.nu, before[0]) and np.array_equal(motion.eta, before[1])
    for b in range(6):
        one = replace(motion, nu=motion.nu[b : b + 1], eta=motion.eta[b : b + 1], nu0=motion.nu0[b : b + 1], eta0=motion.eta0[b : b + 1])
        alone = observe(plant.vehicle, plant.index, plant.null, beta[b : b + 1], one)
        assert np.allclose(seen.nu[b], alone.nu[0], rtol=0, atol=1e-12) and np.allclose(seen.eta[b], alone.eta[0], rtol=0, atol=1e-12)
    turned = before[0][5, :, :3] + np.cross(before[0][5, :, 3:], [0.5, 0.0, 0.0])
    assert np.allclose(seen.nu[5, :, :3], turned, rtol=0, atol=1e-12)


def test_a_delay_of_one_sensor_leaves_all_else_and_is_a_hypothesis_of_its_own():
    """From a steady start (no acceleration to begin with) the log is the true motion, that sensor's part that much later; early ones too."""
    plant = Plant(cases.merlin())
    assert [len(plant.hypotheses[f"time_offset{which}"]) for which in ("", "[velocity]", "[attitude]", "[depth]")] == [1, 1, 1, 1]
    still = cases.changed(plant.vehicle, volume=plant.vehicle.body.mass / plant.vehicle.water.density)
    plant = Plant(still)
    speed = np.where(np.arange(100)[:, None] < 20, 0.0, np.linspace(-3.0, 3.0, 7))
    inputs, first, zero = Inputs(0.1, speed, False), np.zeros(1, int), np.zeros((1, 6))
    true = plant.simulate(inputs, first, 90, zero, zero, plant.null[None])
    whole = np.concatenate([true.nu[0], true.eta[0, :, :3], np.unwrap(true.eta[0, :, 3:], axis=0)], axis=1)
    assert np.abs(whole[:, 11]).max() > np.pi / 2 and np.ptp(whole[:, :6], axis=0).min() > 1e-3
    for which, part in (("velocity", (0, 1, 2)), ("attitude", (3, 4, 5, 9, 10, 11)), ("depth", (8,))):
        for delay in (0.25, -0.25):
            beta = plant.null.copy()
            beta[plant.index[f"time_offset[{which}].delay"]] = delay
            seen = plant.simulate(inputs, first, 90, zero, zero, beta[None])
            late = np.arange(5, 85) - delay / 0.1
            for i in range(12):
                want = np.interp(late, np.arange(91), whole[:, i]) if i in part else whole[5:85, i]
                got = np.concatenate([seen.nu[0], seen.eta[0]], axis=1)[5:85, i]
                rounding = 1e-4 if i > 8 and i in part else 1e-12  # between samples an attitude turns, and its angles are linear to second order
                assert np.abs(wrap(got - want) if i > 8 else got - want).max() < rounding


def test_sized_parameters_grow_with_the_vehicle():
    """A buoyancy error of newtons means another thing for 13 kg than for 3 t."""
    small, large = (Plant(vehicle.load(n)) for n in ("bluerov2_heavy", "merlin"))
    typical = [p.slots[p.index["buoyancy_error.force"]].parameter.typical for p in (small, large)]
    assert typical[0] == pytest.approx(3.0, rel=1e-3) and typical[1] == pytest.approx(3.0 * 2936 * 9.81 / 132.57, rel=1e-3)


def test_lengths_grow_with_the_cube_root_of_the_weight_and_searches_begin_within():
    """Vehicles of one shape: how far above the bottom its own jets are felt goes by their size."""
    small, large = (Plant(vehicle.load(n)) for n in ("bluerov2_heavy", "merlin"))
    near, far = (p.slots[p.index["ground_effect.height"]].parameter for p in (small, large))
    assert far.high / near.high == pytest.approx((2936 * 9.81 / 132.57) ** (1 / 3), rel=1e-3)
    for p in (near, far):
        assert p.low <= min(p.starts) < p.null < max(p.starts) <= p.high
        assert p.starts[0] / p.high == pytest.approx(near.starts[0] / near.high)


def test_the_true_heading_is_found_at_the_corners_of_every_deviation_card():
    rng, compass, n = np.random.default_rng(0), effects.module("compass_deviation"), 4000
    p = {part.name: rng.choice([part.low, part.high], n) for part in compass.EFFECT.parameters}
    psi = rng.uniform(-np.pi, np.pi, (n, 1))
    true = np.concatenate([np.zeros((n, 5)), psi], axis=1)
    seen = compass.observe(Log(np.zeros((n, 1, 6)), true[:, None], 0.1, np.zeros((n, 6)), true), p).eta[:, 0]
    assert np.abs(wrap(seen[:, 5] - true[:, 5])).max() > 1.0
    _, eta = compass.unobserve(np.zeros((n, 6)), seen, p)
    np.testing.assert_allclose(wrap(eta[:, 5:] - psi), 0.0, atol=1e-12)


def test_what_a_dead_band_takes_is_made_up_beyond_it_and_no_more():
    """A band of the drive takes its width all along; one of low flow is caught up with at 1 + 1 / catch widths, and never gives more than there is; one of
    thrust takes the thrust at its edge."""
    n = np.linspace(-10.0, 10.0, 401)
    drive, flow, thrust = (thruster_deadband.acting(2.0, catch, n) for catch in (0.0, 0.5, -1.0))
    np.testing.assert_allclose(thrust * np.abs(thrust), np.sign(n) * np.maximum(n**2 - 4.0, 0.0), atol=1e-9)
    assert (np.abs(thrust) <= np.abs(n) + 1e-12).all() and (np.abs(thrust) >= np.abs(drive) - 1e-12).all()
    np.testing.assert_allclose(drive, np.sign(n) * np.maximum(np.abs(n) - 2.0, 0.0), atol=1e-12)
    inside, beyond = np.abs(n) <= 2.0, np.abs(n) >= 6.0
    assert (flow[inside] == 0.0).all() and np.abs(flow[beyond] - n[beyond]).max() < 1e-12
    assert (np.abs(flow) <= np.abs(n) + 1e-12).all() and (np.abs(flow) >= np.abs(drive) - 1e-12).all()
    np.testing.assert_array_equal(thruster_deadband.acting(0.0, 0.0, n), n)
