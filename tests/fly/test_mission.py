"""Mission files: checked whole, told with every problem at once, laid out in time."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from rovval import vehicle
from rovval.core.errors import UsageProblem
from rovval.effects.lanes import reference_speed
from rovval.fly import mission as missions
from rovval.fly.document import text
from rovval.fly.dry_run import dry_run
from rovval.fly.loop.allocation import thrusters_of
from rovval.fly.plan import lay_out, read_speeds

PAGE = Path(__file__).parent.parent.parent / "docs" / "missions.md"


def test_the_page_of_the_mission_file_is_current():
    assert PAGE.read_text(encoding="utf-8") == text(), "write it anew: python -m rovval.fly.document > docs/missions.md"


@pytest.mark.parametrize("name", missions.names())
def test_missions_of_the_library_exceed_nothing_on_their_vehicle(name):
    mission = missions.load(name)
    assert mission.name == name
    assert dry_run(mission, vehicle.load(mission.vehicle)).exceeds == ()


def test_every_problem_of_a_file_is_named_at_once(tmp_path):
    (tmp_path / "bad.toml").write_text(
        '[start]\ndepht_m = 3.0\n[limits]\nrpm = -1\n[[leg]]\nkind = "hold"\nfor_s = 5.0\n[[leg]]\nkind = "hover"\nfor_s = 5.0\n'
    )
    with pytest.raises(UsageProblem) as refused:
        missions.load(tmp_path / "bad.toml")
    for words in ("depht_m", "limits.rpm", "holds nothing", "hover"):
        assert words in str(refused.value)


def test_planned_speeds_run_linearly_between_their_rows(tmp_path):
    (tmp_path / "plan.csv").write_text("t_s,HFP,VAC\n0,0,0\n2,120,-60\n4,120,-60\n")
    merlin = vehicle.load("merlin")
    speed = read_speeds(tmp_path / "plan.csv", merlin)
    assert speed.shape == (41, 7)
    np.testing.assert_allclose(speed[[0, 10, 20, 40], merlin.thrusters.index("HFP")], [0.0, 1.0, 2.0, 2.0])
    assert speed[40, merlin.thrusters.index("VAC")] == pytest.approx(-1.0) and not speed[:, merlin.thrusters.index("VFP")].any()


def test_a_table_of_speeds_is_a_mission_by_itself(tmp_path):
    """No motion, made up or measured, is asked for beside it."""
    (tmp_path / "my plan.csv").write_text("t_s,HFP,VAC\n0,0,0\n2,120,-60\n4,120,-60\n")
    mission, merlin = missions.load(tmp_path / "my plan.csv"), vehicle.load("merlin")
    [phase] = lay_out(mission, merlin, thrusters_of(merlin, mission.limits))
    assert mission.name == "my_plan" and phase.end_s == pytest.approx(4.0, abs=0.11)
    assert phase.speed is not None and phase.speed[20, merlin.thrusters.index("HFP")] == pytest.approx(2.0)


def test_a_wrong_table_of_speeds_is_told_with_its_lines(tmp_path):
    (tmp_path / "plan.csv").write_text("t_s,HFP,XYZ\n0,0,0\n1,fast,0\n2,0\n")
    with pytest.raises(UsageProblem) as refused:
        read_speeds(tmp_path / "plan.csv", vehicle.load("merlin"))
    for words in ("XYZ", "line 3", "line 4"):
        assert words in str(refused.value)


def test_the_protocol_is_the_thesis_s():
    """Eight movements of 30 s, each with 30 s of rest (thesis 4.4, table 4.6), the fastest thruster at 70 rpm, the thrusts' signs those of thesis 6.4."""
    merlin = vehicle.load("merlin")
    mission = missions.load("protocol")
    phases = lay_out(mission, merlin, thrusters_of(merlin, mission.limits))
    assert [p.push for p in phases] == [word for axis in ("surge", "sway", "heave", "yaw") for word in 2 * (axis, "rest")]
    assert phases[-1].end_s == 480.0
    surge = phases[0].speed
    assert surge is not None and np.abs(surge).max() == pytest.approx(70 / 60)
    assert np.sign(np.round(surge[0], 9)).tolist() == [0, 0, 0, 1, -1, -1, 1]


@pytest.mark.parametrize("name", vehicle.names())
def test_each_thruster_turns_alone_both_ways_on_every_vehicle(name):
    own = vehicle.load(name)
    mission = missions.load("thrusters_singly")
    phases = lay_out(mission, own, thrusters_of(own, mission.limits))
    speed = np.concatenate([p.speed for p in phases if p.speed is not None])
    assert ((speed != 0).sum(axis=1) <= 1).all() and not speed[-1].any()
    assert (speed.max(axis=0) == -speed.min(axis=0)).all() and speed.max(axis=0) == pytest.approx(0.5 * reference_speed(own))
    assert phases[-1].end_s == pytest.approx(40.0 * len(own.thrusters))


def test_a_dry_run_says_what_would_be_exceeded(tmp_path):
    (tmp_path / "plan.csv").write_text("t_s,HFP\n0,0\n1,900\n5,900\n")
    mission = missions.parse(
        {
            "name": "over", "water": {"bottom_m": 25.0}, "limits": {"rpm_per_s": 100.0},
            "leg": [
                {"kind": "speeds", "file": "plan.csv"}, {"kind": "hold", "for_s": 10.0, "depth_m": 0.2, "speed_m_s": 9.0},
                {"kind": "way_points", "for_s": 10.0, "speed_m_s": 0.5, "points": [[40.0, 0.0, 25.0]]},
            ],
        }, tmp_path / "over.toml",
    )  # fmt: skip
    found = "\n".join(dry_run(mission, vehicle.load("merlin")).exceeds)
    for words in ("900 rpm, limit 500 rpm", "limit 100 rpm/s", "at the surface", "9 m/s in surge takes", "touches the bottom", "without a turn"):
        assert words in found
    assert len(found.splitlines()) == 6
