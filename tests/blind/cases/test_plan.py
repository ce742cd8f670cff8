"""The questions of a set: every stratum is asked about, and what is left out is gone under every name."""

import pytest

from rovval import vehicle
from rovval.blind.cases.questions import DECOY_SHARE, questions, same_law
from rovval.blind.scoring import ground_truth
from rovval.core.errors import UsageProblem
from rovval.plant import Plant

MERLIN = vehicle.LIBRARY / "merlin.toml"


def test_full_set_asks_about_every_stratum():
    asked = questions(MERLIN, 1, "full")
    assert len(asked) > 300
    left = [q for q in asked if q.left_out]
    assert all(q.case.effects[0].name in q.without for q in left)
    for one in {q.case.effects[0].name for q in left}:
        on = [q.case.effects[0].target for q in left if q.case.effects[0].name == one]
        assert len(on) == 2 and (on[0] != on[1] or on == [None, None])
    decoys = [q for q in asked if q.without and not q.left_out]
    assert 0.5 * DECOY_SHARE < len(decoys) / (len(asked) - len(left)) < 1.5 * DECOY_SHARE
    for q in decoys:
        assert not set(q.without) & {law for e in q.case.effects for law in same_law(e.name)}


def test_what_is_left_out_is_gone_under_every_name_that_would_be_right():
    library = Plant(vehicle.load("merlin")).hypotheses
    for q in questions(MERLIN, 1, "full"):
        if q.left_out:
            [e] = q.case.effects
            planted = {"name": e.name, "target": e.target, "place": ""}
            right = {h for h in library if ground_truth.accepts(planted, ground_truth.Member(h, 0.0))}
            assert right and {h.partition("[")[0] for h in right} <= set(q.without), e


@pytest.mark.parametrize("size", ["some", "0", "-3"])
def test_size_is_checked(size):
    with pytest.raises(UsageProblem, match="use full, small, or a number"):
        questions(MERLIN, 1, size)
