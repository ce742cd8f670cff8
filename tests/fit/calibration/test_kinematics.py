"""What kinematics say of the sensors: a tilt, a turned frame and a lever arm with their sizes, whatever the forces were, and nothing of what a log has not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from diagnose_case import merlin
from kinematic import spoilt

from rovval.core.channels import POSE
from rovval.core.data import Run
from rovval.fit.calibration.kinematics import kinematics
from rovval.fit.calibration.unknowns import SENSORS, unknowns
from rovval.vehicle.model import Vehicle

CHANNELS = ("u", "v", "w", "p", "q", "r", "phi", "theta", "z")


def estimate(run: Run, vehicle: Vehicle) -> dict[str, float]:
    """The most probable values of the sensors' unknowns, under their priors, by kinematics alone."""
    chosen = tuple(one for one in unknowns(vehicle, CHANNELS) if one.key in SENSORS)
    said = kinematics(run, vehicle, 10.0).of(chosen)
    found = np.linalg.solve(said.curvature + np.diag([one.sd**-2 for one in chosen]), said.slope)
    return {one.key: float(x) for one, x in zip(chosen, found, strict=True)}


@pytest.mark.parametrize(("fault", "seen", "size"), [("attitude_bias.phi", "roll", 0.06), ("attitude_bias.theta", "pitch", -0.05)])
def test_how_attitude_and_velocity_are_turned_against_each_other_is_seen_without_a_simulation(fault: str, seen: str, size: float):
    angle = fault.rpartition(".")[2]
    found, sound = estimate(spoilt({fault: size}), merlin()), estimate(spoilt({}), merlin())
    between = {name: one[f"attitude.{angle}"] - one[f"velocity.{seen}"] for name, one in (("found", found), ("sound", sound))}
    assert between["found"] == pytest.approx(size, rel=0.1)
    assert abs(between["sound"]) < 0.1 * abs(size)
    assert found[f"attitude.{angle}"] == pytest.approx(size / 2, rel=0.1)  # which of the two it is nothing says but their priors, which are the same


@pytest.mark.parametrize(("fault", "unknown", "size"), [("dvl_misalignment.yaw", "velocity.yaw", 0.08), ("dvl_lever_arm.x", "velocity.lever.x", 0.1)])
def test_a_pose_may_be_off_as_the_velocity_is(fault: str, unknown: str, size: float):
    """Half of what is between them is the velocity's."""
    found, sound = estimate(spoilt({fault: size}), merlin()), estimate(spoilt({}), merlin())
    assert found[unknown] - sound[unknown] == pytest.approx(size / 2, rel=0.15)


def test_what_the_file_already_says_of_a_sensor_is_where_it_counts_from():
    knows = merlin().model_copy(update={"effects": {"attitude_bias": {"theta": -0.05}}})
    assert abs(estimate(spoilt({"attitude_bias.theta": -0.05}), knows)["attitude.theta"]) < 0.002


def test_a_log_without_a_pose_says_nothing():
    run = spoilt({})
    kept = [c for c in run.values if c not in POSE]
    blind = replace(run, values={c: run.values[c] for c in kept}, reasons={c: run.reasons[c] for c in kept})
    chosen = unknowns(merlin(), CHANNELS)
    said = kinematics(blind, merlin(), 10.0).of(chosen)
    assert not said.curvature.any() and not said.slope.any()


def test_nothing_is_said_of_what_is_no_sensor_s():
    chosen = unknowns(merlin(), CHANNELS)
    said = kinematics(spoilt({}), merlin(), 10.0).of(chosen)
    others = [i for i, one in enumerate(chosen) if one.key not in SENSORS]
    assert not said.curvature[others].any() and not said.slope[others].any()
