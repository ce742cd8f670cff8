"""Causes in company: two that offset each other, one that an earlier one imitated."""

from __future__ import annotations

import pytest
from diagnose_case import merlin, own

from rovval.diagnose import diagnose


@pytest.mark.slow
def test_a_second_cause_does_not_lead_the_first_away():
    """A step of all parameters at once takes the waves out of step, and a list beside them would seem to be worth nothing."""
    document = diagnose([own(("waves:amplitude=1.2,period=6.2,direction=-2,phase=0.4", "cg_offset:x=-0.012"), 5, 240.0)], merlin()).document()
    assert {c["effect"] for c in document["causes"]} == {"waves", "cg_offset"}, document["sentence"]


def test_two_causes_that_offset_each_other_are_both_found():
    """Weaker thrust and less drag: the speed is as before, only the way there differs."""
    document = diagnose([own(("rpm_scale:scale=-0.25", "quadratic_drag[surge]:scale=-0.7", "linear_drag[surge]:scale=-0.7"), 5, 240.0)], merlin()).document()
    named = {c["effect"] for c in document["causes"]}
    assert {"rpm_scale"} <= named and named & {"quadratic_drag[surge]", "linear_drag[surge]"}, document["sentence"]


