"""Closed loops hold what they are told on three vehicles, way points are passed, and a flight is a run like any log."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

from rovval import vehicle
from rovval.comparison import compare
from rovval.core.errors import UsageProblem
from rovval.core.frames import wrap
from rovval.fly import fly
from rovval.fly.flight import Flight
from rovval.fly.mission import parse
from rovval.simulation import simulate

STEP = {"kind": "hold", "for_s": 60.0, "depth_m": 22.0, "heading_deg": 45.0}


def flown(rov: str, *legs: dict[str, Any], model: str = "fossen", draws: int = 0, seed: int = 0, effects: tuple[str, ...] = (), **tables: Any) -> Flight:
    return fly(parse({"name": "test", "leg": list(legs), **tables}), vehicle.load(rov), model, effects, draws=draws, seed=seed)


@cache
def step(rov: str, sensors: bool = False) -> Flight:
    """Two metres deeper and 45 degrees round at once, from rest and without trim."""
    return flown(rov, STEP, sensors={} if sensors else None)


@pytest.mark.parametrize(
    ("rov", "sensors", "times"),
    [
        ("merlin", False, 1.0), ("bluerov2_heavy", False, 1.0), ("bluerov2_heavy", True, 3.0),
        *(pytest.param(*one, marks=pytest.mark.slow) for one in (("minerva", False, 1.0), ("merlin", True, 3.0), ("minerva", True, 3.0))),
    ],
)  # fmt: skip
def test_a_step_is_held_after_a_minute(rov, sensors, times):
    flight = step(rov, sensors)
    last = slice(-50, None)
    assert len(flight) == 600 and not flight.stops
    assert np.abs(flight.eta[last, 2] - 22.0).max() < times * 0.05
    assert np.degrees(np.abs(wrap(flight.eta[last, 5] - np.radians(45.0)))).max() < times * 2.0
    assert flight.eta[0, 2] == 20.0 and flight.eta[0, 5] == 0.0
    believed = np.abs(flight.seen_eta - flight.eta).max()
    assert 1e-3 < believed < 1.0 if sensors else believed == 0.0


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_half_a_turn_has_no_overshoot_of_half_a_turn(way):
    """180 degrees are asked for, to either side of which the error jumps from one sign to the other."""
    flight = flown("merlin", {"kind": "hold", "for_s": 40.0, "heading_deg": 180.0}, start={"heading_deg": 1e-3 * way}, water={"surface": False})
    [held] = flight.held
    assert abs(held.step) == pytest.approx(np.pi, abs=1e-3) and held.overshoot < np.radians(5.0) and held.settled_s is not None


@pytest.mark.parametrize("rov", ["bluerov2_heavy", *(pytest.param(rov, marks=pytest.mark.slow) for rov in ("merlin", "minerva"))])
def test_way_points_are_passed_within_a_length(rov):
    length = vehicle.load(rov).body.size[0]
    way = {"kind": "way_points", "for_s": 90.0, "speed_m_s": 0.4, "points": [[8.0, 0.0, 21.0], [8.0, 5.0, 20.0]]}
    flight = flown(rov, way, water={"effects": ["current_constant:east=0.1"]})
    assert [p.distance < length for p in flight.passed] == [True, True]
    assert np.linalg.norm(flight.eta[-1, :3] - [8.0, 5.0, 20.0]) < length, "the last one is held"
    assert flight.passed[0].at_s < flight.passed[1].at_s


def test_altitude_and_speed_are_held_in_a_current():
    leg = {"kind": "hold", "for_s": 60.0, "altitude_m": 10.0, "heading_deg": 0.0, "speed_m_s": 0.3, "sway_m_s": 0.0}
    flight = flown("merlin", leg, water={"bottom_m": 30.0, "effects": ["current_constant:north=-0.2,east=0.1"]})
    assert flight.altitude is not None
    assert flight.altitude[-1] == pytest.approx(10.0, abs=0.05)
    assert flight.nu[-1, 0] == pytest.approx(0.3, abs=0.01)
    assert abs(flight.nu[-1, 1]) < 0.02


def test_a_flight_on_the_true_state_is_what_the_simulator_makes_of_its_run():
    """Planned or by controllers, the run's own thruster speeds give its motion back."""
    flight, rov = step("bluerov2_heavy"), vehicle.load("bluerov2_heavy")
    comparison = compare(flight.run(), simulate(flight.run(), rov, effects=("free_surface:share=1",)))
    assert max(row.rmse for row in comparison.free.values()) < 1e-4
    assert min(row.baseline_rmse for axis, row in comparison.free.items() if axis in ("heave", "yaw")) > 0.01


def test_the_run_of_sensors_holds_what_the_filter_says_and_the_truth_lies_beside_it():
    flight = step("bluerov2_heavy", sensors=True)
    np.testing.assert_allclose(flight.run().get("z"), flight.seen_eta[:, 2])
    np.testing.assert_allclose(flight.run(truth=True).get("z"), flight.eta[:, 2])
    assert flight.run().sha256 != flight.run(truth=True).sha256


def test_a_seed_is_a_flight_and_draws_leave_the_first_lane_alone():
    brief = STEP | {"for_s": 8.0}
    one, again, other = (flown("merlin", brief, seed=seed, sensors={}) for seed in (1, 1, 2))
    beside = flown("merlin", brief, seed=1, draws=5, sensors={})
    np.testing.assert_array_equal(one.seen_eta, again.seen_eta)
    np.testing.assert_allclose(one.eta, beside.eta, atol=1e-12)
    assert np.abs(one.seen_eta - other.seen_eta).max() > 1e-3
    assert one.held[0].draws is None and beside.held[0].draws is not None and len(beside.held[0].draws) == 5


def test_draws_spread_by_their_tolerance():
    """The speed that a thrust gives differs among vehicles by a part of the tolerance of drag and thrust, more with more slop, and the file's is among them."""
    mission = parse({"name": "t", "leg": [{"kind": "protocol", "axes": ["surge"], "move_s": 12.0, "rest_s": 0.0, "rpm": 150.0}]})
    rov = vehicle.load("merlin")
    wide, narrow = (fly(mission, rov, draws=100, calibration_slop=slop).spread["u"] for slop in (0.05, 0.01))
    at = 115
    assert 0.02 < (wide[2, at] - wide[0, at]) / wide[1, at] < 0.5
    assert narrow[2, at] - narrow[0, at] < 0.5 * (wide[2, at] - wide[0, at])
    assert wide[0, at] < fly(mission, rov).nu[at, 0] < wide[2, at]


def test_a_vehicle_that_is_told_to_go_below_the_bottom_lies_on_it():
    flight = flown("bluerov2_heavy", STEP | {"depth_m": 30.0, "for_s": 40.0}, water={"bottom_m": 21.0})
    assert 21.0 - 0.127 < flight.eta[-1, 2] < 21.0
    assert flight.altitude is not None and flight.altitude.min() > 0.0


def test_thrusters_keep_their_limits():
    """One that is asked for more than it can is cut, the rest waits for it, and the result counts it."""
    flight = flown("merlin", STEP | {"speed_m_s": 1.0}, limits={"rpm": 120.0, "rpm_per_s": 60.0})
    assert np.abs(flight.speed).max() * 60 <= 120.0 + 1e-9
    assert np.abs(np.diff(flight.speed, axis=0)).max() * 60 <= 6.0 + 1e-9
    assert flight.saturated().mean() > 0.1
    assert flight.eta[-1, 2] == pytest.approx(22.0, abs=0.15), "depth comes before speed"


def test_the_file_s_own_gains_fly_in_place_of_ours():
    """A proportional depth controller alone leaves the offset that weight less buoyancy makes: e = (W - B) / kp."""
    rov = vehicle.load("merlin")
    flight = flown("merlin", STEP | {"for_s": 90.0, "depth_m": 20.0}, control={"depth": {"kp": 500.0, "kd": 3000.0}, "feedforward": False})
    assert flight.eta[-1, 2] - 20.0 == pytest.approx((rov.weight - rov.buoyancy) / 500.0, rel=0.02)


def test_what_cannot_be_flown_is_refused_by_name():
    with pytest.raises(UsageProblem, match="cannot push alone"):
        flown("bluerov2", {"kind": "protocol", "axes": ["pitch"], "rpm": 500.0})
    with pytest.raises(UsageProblem, match="bottom"):
        flown("merlin", {"kind": "hold", "for_s": 5.0, "altitude_m": 3.0})
    with pytest.raises(UsageProblem, match="effect of the log"):
        flown("merlin", STEP, effects=("gyro_bias:r=0.01",))
    with pytest.raises(UsageProblem, match="no effect named"):
        flown("merlin", STEP, effects=("no_such:x=1",))
