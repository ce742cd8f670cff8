"""The questions of a set: every stratum is asked about, and what is left out is gone under every name."""

import pytest

from rovval import vehicle
from rovval.blind.cases.mixed import kinds
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


@pytest.mark.parametrize("plant", ["a", "b"])
def test_a_mixed_set_holds_the_stated_share_of_healthy_logs(plant):
    cases = [q.case for q in questions(MERLIN, 4, "100", plant, 0.3, 240.0)]
    assert sum(not case.effects for case in cases) == 30
    assert {case.plant for case in cases} == {plant} and {case.duration_s for case in cases} == {240.0}
    assert len({case.seed for case in cases}) == 100
    lacking = {kind.name for kind in kinds(plant) if kind.lacking}
    assert 5 <= sum(case.effects[0].name in lacking for case in cases if case.effects) <= 12
    two = [case.effects for case in cases if len(case.effects) > 1]
    assert 8 <= len(two) <= 14 and all(one.name != other.name for one, other in two)
    singles = [case.effects[0].name for case in cases if len(case.effects) == 1]
    assert max(singles.count(name) for name in singles) <= 3


def test_shares_and_lengths_that_make_no_set_are_refused():
    for healthy, seconds in ((1.5, 240.0), (0.3, 5.0)):
        with pytest.raises(UsageProblem, match="--healthy"):
            questions(MERLIN, 1, "10", "b", healthy, seconds)
