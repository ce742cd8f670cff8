"""Strata: which logs are counted together."""

from __future__ import annotations

import pytest
from blind_case import label, planted

from rovval.blind.scoring.strata import strata


@pytest.mark.parametrize(("each", "kinds"), [(0.4, ["two", "two, each distinguishable"]), (0.05, ["two"])])
def test_two_effects_of_which_one_hides_are_a_kind_of_their_own(each, kinds):
    both = label(planted("rpm_scale", relative=0.1), planted("waves", lift=1.0))
    assert strata(both, {"dynamic": 0.8, "seen": 0.8, "each": each}) == kinds


def test_what_begins_in_mid_log_is_a_kind_of_its_own_but_for_events():
    seen = {"dynamic": 0.5, "seen": 0.5}
    begun, event = (label({**planted(name, relative=0.1), "onset_s": 120.0}) for name in ("rpm_scale", "payload_change"))
    assert strata(begun, seen) == ["single, begins in mid-log", "single, begins in mid-log, distinguishable"]
    assert "single, distinguishable" in strata(event, seen)
