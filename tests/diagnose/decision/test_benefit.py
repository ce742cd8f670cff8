"""Benefit: causes surely reduce the gap, harm no axis, and do so where the simulator follows the vehicle."""

from __future__ import annotations

import pytest
from diagnose_case import posed, slot

from rovval.core.channels import AXES
from rovval.diagnose.decision.benefit import Benefit, beneficial, benefit_as_filed, benefit_beside, followed
from rovval.diagnose.inference.hypothesis_fit import fit_hypothesis
from rovval.diagnose.inference.map_fit import healthy_fit
from rovval.diagnose.problem.problem import corrected_residuals


def test_an_axis_is_harmed_if_it_loses_much_of_what_is_gained_in_all():
    before = {"surge": 10.0, "yaw": 1.0}
    assert Benefit(before, {"surge": 2.0, "yaw": 4.0}, True, True).harms()
    assert not Benefit(before, {"surge": 2.0, "yaw": 2.0}, True, True).harms()
    assert not Benefit(before, before | {"yaw": 1.0 + 1e-6}, True, True).harms()  # rounding, as of a compass


def test_a_drag_that_spoils_its_own_axis_is_none():
    """Whatever it gains elsewhere, beside other causes or through coupling."""
    way = Benefit({"surge": 1.0, "yaw": 10.0}, {"surge": 2.0, "yaw": 1.0}, True, True)
    assert way.harms(["surge"]) and not beneficial([way], False, ["yaw", "surge"])
    assert not way.harms() and not way.harms(["yaw"]) and beneficial([way], False, ["yaw"])


def test_beside_a_cause_coefficients_may_move_within_their_tolerance():
    p = posed(("buoyancy_error:force=60", "quadratic_drag[surge]:scale=0.2",), seconds=100.0)[0]
    final, healthy = fit_hypothesis(p, p.origin, (slot(p, "buoyancy_error.force"),)), healthy_fit(p)
    filed, eased = benefit_as_filed(p, final, corrected_residuals(p)), benefit_beside(p, final, healthy, corrected_residuals(p))
    assert filed.sure and eased.sure and filed.followed and eased.followed
    assert eased.after["surge"] < 0.8 * filed.after["surge"]
    assert eased.after["heave"] == pytest.approx(filed.after["heave"], rel=0.2)


def test_an_axis_on_which_the_simulator_errs_as_much_as_the_vehicle_moves_shows_nothing():
    p = posed(seconds=100.0)[0]
    was, left = dict.fromkeys(AXES, 2e6), dict.fromkeys(AXES, 8e5)
    still = Benefit(was, left, True, followed(p, was, left))
    assert not still.followed and not beneficial([still], seen=False) and beneficial([still], seen=True)
