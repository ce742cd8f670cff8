"""The compiled kernel against the NumPy twin, and effects that are null."""

from __future__ import annotations

import numpy as np
import plant_cases as cases
import pytest

from rovval.core.frames import wrap
from rovval.plant import Inputs, Plant
from rovval.plant.reference import plant as oracle

TOLERANCE = 1e-12


def compare(plant: Plant, seed: int, hold: bool, extra_lanes: int = 20, steps: int = 20):
    rng = np.random.default_rng(seed)
    inputs = cases.random_inputs(rng, plant, hold=hold)
    beta = cases.random_beta(rng, plant, extra_lanes)
    lanes = len(beta)
    nu, eta = cases.random_states(rng, lanes)
    start = rng.integers(0, 350, lanes)
    which, gain = rng.integers(-1, 3, lanes), rng.normal(size=lanes)
    ours = plant.simulate(inputs, start, steps, nu, eta, beta, which, gain)
    twin = oracle.simulate(plant, inputs, start, steps, nu, eta, beta, which, gain)
    assert (ours.stopped == twin.stopped).all()
    assert np.isfinite(ours.nu).all() and np.isfinite(ours.eta).all()
    scale = 1.0 + np.abs(twin.nu).max(axis=(1, 2), keepdims=True)
    assert (np.abs(ours.nu - twin.nu) / scale).max() < TOLERANCE
    assert (np.abs(wrap(ours.eta[..., 3:] - twin.eta[..., 3:])) / scale).max() < 1e3 * TOLERANCE  # arc cosines near their ends
    assert (np.abs(ours.eta[..., :3] - twin.eta[..., :3]) / scale).max() < 10 * TOLERANCE


@pytest.mark.parametrize("hold", [False, True])
@pytest.mark.parametrize("model", ["fossen", "freefloating", pytest.param("uuv", marks=pytest.mark.slow)])
def test_kernel_agrees_with_the_oracle_for_every_effect(model, hold):
    """Every hypothesis of the library on its own and mixtures of eight parameters, Merlin, two substeps."""
    compare(Plant(cases.merlin(), model, substeps=2), seed=hold, hold=hold, steps=5 if model == "uuv" else 20)


@pytest.mark.slow
@pytest.mark.parametrize("hold", [False, True])
def test_the_kernel_of_an_engine_that_takes_added_mass_as_a_force_agrees_with_the_oracle(hold):
    """uuv without effects, at its own step of 2 ms; windows that begin in mid-log, with what its thrusters remember."""
    plant = Plant(cases.merlin(), "uuv")
    rng = np.random.default_rng(hold)
    inputs = cases.random_inputs(rng, plant, hold=hold)
    nu, eta = cases.random_states(rng, 20)
    start, null = rng.integers(0, 350, 20), np.tile(plant.null, (20, 1))
    ours, twin = plant.simulate(inputs, start, 10, nu, eta, null), oracle.simulate(plant, inputs, start, 10, nu, eta, null)
    assert np.abs(ours.nu - twin.nu).max() < TOLERANCE and np.abs(ours.eta - twin.eta).max() < 1e2 * TOLERANCE


def test_kernel_agrees_with_the_oracle_for_random_vehicles():
    """Dense matrices, advance-ratio law, thrusters anywhere."""
    for seed in range(4):
        compare(Plant(cases.random_vehicle(np.random.default_rng(seed))), seed, hold=bool(seed % 2))


@pytest.mark.slow
def test_kernel_agrees_with_the_oracle_for_many_random_vehicles():
    for seed in range(100, 200):
        model = ("fossen", "uuv", "freefloating")[seed % 3]
        compare(Plant(cases.random_vehicle(np.random.default_rng(seed)), model), seed, hold=bool(seed % 3))


def test_a_null_effect_changes_nothing_to_the_last_bit():
    """The same lanes beside lanes with an effect (so in the kernel that holds every effect), alone, and in another block."""
    plant = Plant(cases.merlin())
    rng = np.random.default_rng(5)
    inputs = cases.random_inputs(rng, plant)
    beta = cases.random_beta(rng, plant, 0)
    lanes = len(beta)
    nu, eta = cases.random_states(rng, lanes)
    start = rng.integers(0, 300, lanes)
    null = np.tile(plant.null, (lanes, 1))
    mixed = np.where((np.arange(lanes) % 2 == 0)[:, None], null, beta)
    beside = plant.simulate(inputs, start, 50, nu, eta, mixed)
    first = np.where((np.arange(lanes) < 1)[:, None], beta, null)
    alone = plant.simulate(inputs, start, 50, nu, eta, first)
    even = np.arange(2, lanes, 2)
    assert (beside.nu[even] == alone.nu[even]).all() and (beside.eta[even] == alone.eta[even]).all()
    nominal = plant.simulate(inputs, start, 50, nu, eta, null)
    assert (nominal.nu[even] == alone.nu[even]).all() and (nominal.eta[even] == alone.eta[even]).all()
    forced = plant.simulate(inputs, start, 50, nu, eta, null, np.zeros(lanes, int), np.zeros(lanes))  # the full kernel, nothing on
    assert np.abs(nominal.nu - forced.nu).max() < 1e-13
    moved = plant.simulate(inputs, start[::-1], 50, nu[::-1], eta[::-1], null[::-1])
    assert (moved.nu[::-1] == nominal.nu).all()


def test_every_slot_does_something():
    """No parameter is declared and then forgotten: with its companions away from null, each one alters the motion (of a vehicle whose propellers are
    not all of one hand)."""
    merlin = cases.merlin()
    first, *others = merlin.thruster
    plant = Plant(merlin.model_copy(update={"thruster": (first.model_copy(update={"handedness": -first.handedness}), *others)}))
    rng = np.random.default_rng(6)
    inputs = cases.random_inputs(rng, plant)
    base = np.array([min(max(s.parameter.null + s.parameter.typical, s.parameter.low), s.parameter.high) for s in plant.slots])
    base[[s.parameter.name == "onset" for s in plant.slots]] = 21.0
    rows, keys = [], []
    for slot in (s for s in plant.slots if not s.parameter.instead_of):  # what stands in for a channel that is logged here does nothing
        columns = list(plant.hypotheses[slot.hypothesis])
        one = plant.null.copy()
        one[columns] = base[columns]
        other = one.copy()
        c = plant.index[slot.key]
        p = slot.parameter
        other[c] = 22.0 if p.name == "onset" else (one[c] + 0.5 * p.typical if one[c] + 0.5 * p.typical <= p.high else one[c] - 0.5 * p.typical)
        rows += [one, other]
        keys.append(slot.key)
    lanes = len(rows)
    nu, eta = cases.random_states(rng, 1)
    nu[:] = [0.3, 0.2, 0.1, 0.05, 0.05, 0.1]
    eta[:, :3] = [30.0, 30.0, 12.0]
    change = np.zeros(len(keys))
    for way in (1.0, -1.0):  # some act one way only
        out = plant.simulate(inputs, np.full(lanes, 200), 60, np.tile(way * nu, (lanes, 1)), np.tile(eta, (lanes, 1)), np.array(rows))
        change += np.abs(out.nu[::2] - out.nu[1::2]).max(axis=(1, 2)) + np.abs(out.eta[::2] - out.eta[1::2]).max(axis=(1, 2))
    assert [k for k, c in zip(keys, change, strict=True) if not c > 1e-9] == []


def test_a_lane_does_not_depend_on_its_neighbours():
    plant = Plant(cases.merlin())
    rng = np.random.default_rng(7)
    inputs = cases.random_inputs(rng, plant)
    nu, eta = cases.random_states(rng, 70)
    start = rng.integers(0, 300, 70)
    null = np.tile(plant.null, (70, 1))
    together = plant.simulate(inputs, start, 40, nu, eta, null)
    for b in (0, 33, 69):
        single = plant.simulate(inputs, start[b : b + 1], 40, nu[b : b + 1], eta[b : b + 1], null[b : b + 1])
        assert (single.nu[0] == together.nu[b]).all() and (single.eta[0] == together.eta[b]).all()


def test_hidden_lag_begins_where_a_long_simulation_has_it():
    """A window that starts in mid-log with a lag is the same as a simulation from the log's start, handed over there."""
    plant = Plant(cases.merlin())
    rng = np.random.default_rng(8)
    for hold in (False, True):
        inputs = cases.random_inputs(rng, plant, hold=hold)
        beta = plant.null.copy()
        beta[plant.index["thrust_lag.tau"]] = 0.7
        zero = np.zeros((1, 6))
        long = plant.simulate(Inputs(0.1, inputs.speed, hold), np.zeros(1, int), 120, zero, zero, beta[None])
        window = plant.simulate(Inputs(0.1, inputs.speed, hold), np.array([70]), 50, long.nu[:, 70], long.eta[:, 70], beta[None])
        assert np.abs(window.nu - long.nu[:, 70:]).max() < 1e-11
