"""Unlogged forces: as large as what was put in, next to none on a healthy vehicle, judged where causes act."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from diagnose_case import posed

from rovval.core.channels import AXES
from rovval.diagnose.criteria import FORCE_RIGHT
from rovval.diagnose.inference.hypothesis_fit import fit_hypothesis
from rovval.diagnose.inference.map_fit import healthy_fit
from rovval.diagnose.inference.unlogged_forces import thrusters_force, unlogged_forces, where_causes_act
from rovval.diagnose.problem.problem import Problem
from rovval.diagnose.residuals.external_forces import force_sensitivities, typical_wrench

HELD = 50  # samples, 5 s


def pushed(problem: Problem, axis: str, share: float) -> Problem:
    """The problem with what a force does to the residuals of the nominal vehicle that jumps every 5 s and is of ``share`` of the thrusters' rms."""
    [windows], [nominal] = problem.runs, problem.nominal
    unit = thrusters_force(typical_wrench(problem.runs), windows.plant.vehicle)[AXES.index(axis)]
    jumps = np.random.default_rng(3).normal(size=len(windows.run) // HELD + 1)
    series = share * unit * np.repeat(jumps / jumps.std(), HELD)[: len(windows.run)]
    r = nominal.r + force_sensitivities(windows, problem.origin, [(axis, series)])[..., 0]
    return replace(problem, nominal=(replace(nominal, r=np.where(windows.ok, r, 0.0)),))


@pytest.mark.parametrize("axis", ["surge", "heave", "yaw"])
def test_a_force_that_nobody_logged_is_found_on_its_axis_in_its_size(axis: str):
    problem, _ = posed(())
    found = unlogged_forces(pushed(problem, axis, 0.3))
    assert found[axis] == pytest.approx(0.3, rel=0.25)
    assert max(size for other, size in found.items() if other != axis) < 0.1


def test_a_healthy_vehicle_leaves_next_to_none():
    problem, _ = posed(())
    left = unlogged_forces(problem, healthy_fit(problem))
    assert set(left) == set(AXES) and max(left.values()) < FORCE_RIGHT


def test_right_causes_leave_next_to_none_where_they_act():
    problem, library = posed(("inflow_loss:loss=0.5",))
    [cause] = [one for one in library if one.name == "inflow_loss"]
    nominal, left = unlogged_forces(problem), unlogged_forces(problem, fit_hypothesis(problem, problem.origin, cause.slots).posterior)
    assert where_causes_act(nominal, left, nominal) > 3.0 * FORCE_RIGHT > 3.0 * where_causes_act(left, left, nominal)


def test_an_axis_on_which_causes_change_nothing_does_not_count():
    nominal = {"surge": 0.4, "sway": 0.3, "yaw": 2.0}
    assert where_causes_act({"surge": 7.0, "sway": 9.0, "yaw": 5.0}, nominal | {"surge": 0.0}, nominal) == pytest.approx(7.0)
    both = where_causes_act({"surge": 7.0, "sway": 9.0, "yaw": 5.0}, {"surge": 0.0, "sway": 0.5, "yaw": 2.0}, nominal)
    assert both == pytest.approx(8.0), "what causes open counts as what they close"
    assert where_causes_act(nominal, nominal, nominal) == 0.0


def test_the_force_of_the_thrusters_is_the_same_on_every_axis_whatever_they_drive():
    problem, _ = posed(())
    vehicle = problem.plant.vehicle
    ahead, down = (thrusters_force(np.array(wrench), vehicle) for wrench in ([3.0, 4.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 5.0, 9.0, 9.0, 9.0]))
    assert ahead.tolist() == down.tolist() and ahead[:3].tolist() == [5.0] * 3
    reach = [np.linalg.norm(np.subtract(one.position, vehicle.body.centre_of_gravity)) for one in vehicle.thruster]
    assert 5.0 * min(reach) <= ahead[5] <= 5.0 * max(reach)


def test_nothing_is_said_where_thrusters_stand_still_or_windows_are_few():
    problem, _ = posed(())
    [windows] = problem.runs
    still = replace(windows.actuation.inputs, speed=np.zeros_like(windows.actuation.inputs.speed))
    drifting = replace(problem, runs=(replace(windows, actuation=replace(windows.actuation, inputs=still)),))
    assert unlogged_forces(drifting) == {} == unlogged_forces(replace(problem, components=None))
