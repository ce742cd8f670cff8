"""Initial points: effects whose place, period or size no slope at no effect shows are found from them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from diagnose_case import LIBRARY, foreign, logged, merlin, own, posed, slot

from rovval.blind.plant.spec import Planted
from rovval.blind.second import flight as second
from rovval.diagnose import diagnose
from rovval.diagnose.effort import LEVER_SHARE
from rovval.diagnose.hypotheses.hypothesis import columns_of, prior_of
from rovval.diagnose.hypotheses.initial_points import Hints
from rovval.diagnose.hypotheses.library import hypotheses
from rovval.diagnose.windows.multiple_shooting import cut


@pytest.mark.slow
@pytest.mark.parametrize(
    ("effect", "name"),
    [
        ("waves:cosine=-0.42,sine=0.91,period=9.3,direction=2.6", "waves"),
        ("current_varying:north=0.15,east_cosine=-0.1,period=83", "current_varying"),
    ],
)
def test_what_swings_is_found_whatever_its_period_and_phase(effect, name):
    document = diagnose([own((effect,), 5, 240.0)], merlin()).document()
    assert [c["effect"] for c in document["causes"]] == [name], document["sentence"]
    found, true = document["causes"][0]["parameters"]["period"]["value"], float(effect.split("period=")[1].split(",")[0])
    assert found == pytest.approx(true, rel=0.03) and document["shrinkage"]["total"] > 0.8


@pytest.mark.slow
def test_waves_of_the_independent_plant_are_found(tmp_path: Path):
    document = diagnose([foreign(tmp_path, (("waves", "", 1.5),), 31, 240.0, 0.03)], merlin()).document()
    assert "waves" in [c["effect"] for c in document["causes"]], document["sentence"]


@pytest.mark.slow
def test_a_sea_of_many_waves_from_all_over_a_sector_is_found(tmp_path: Path):
    """Ten Airy waves of a JONSWAP spectrum by another plant, which keeps its station: more than a few trains are seen, and close most of the gap."""
    sea = second.fly(LIBRARY / "merlin.toml", "hover", [Planted("waves", None, 1.5)], 31, 240.0)
    document = diagnose([logged(sea, tmp_path / "sea.csv")], merlin()).document()
    assert [c["effect"] for c in document["causes"]] == ["waves"], document["sentence"]
    assert len(document["causes"][0]["parameters"]) > 4 + 3 * 2 and document["shrinkage"]["total"] > 0.5


@pytest.mark.slow
def test_a_pull_may_begin_ahead_or_astern():
    p, library = posed()
    x, reach = slot(p, "tether_tension.x"), LEVER_SHARE * max(float(np.linalg.norm(t.position)) for t in merlin().thruster)
    starts = {dict(h.at)[x] for h in library if h.name == "tether_tension" and x in dict(h.at)}
    assert sorted(starts) == pytest.approx([-min(reach, 2.0), min(reach, 2.0)])
    document = diagnose([own(("tether_tension:north=250,east=120,x=-1.4",), 5, 200.0)], merlin()).document()
    assert document["causes"][0]["effect"] in ("tether_tension", "tether_drag"), document["sentence"]  # a steady pull is of either
    assert document["causes"][0]["parameters"]["x"]["value"] == pytest.approx(-1.4, abs=0.4)


def test_a_line_that_only_drags_is_found_where_it_is_tied():
    """A little drag aft and no pull. That a line's pull has no size costs evidence that so little drag has not: with a pull in every fit that begins off the
    origin, drag across axes was named instead."""
    p, library = posed()
    x, pull = slot(p, "tether_drag.x"), slot(p, "tether_drag.north")
    assert {pull in h.slots for h in library if h.name == "tether_drag" and x in dict(h.at)} == {True, False}
    document = diagnose([own(("tether_drag:coefficient=80,x=-1.4",), 5, 120.0)], merlin()).document()
    [cause] = document["causes"]
    assert cause["effect"] == "tether_drag", document["sentence"]
    assert cause["parameters"]["x"]["value"] == pytest.approx(-1.4, abs=0.3)
    assert cause["parameters"]["coefficient"]["value"] == pytest.approx(80.0, rel=0.3)


@pytest.mark.slow
def test_a_long_lag_is_found_though_it_is_no_multiple_of_a_short_one():
    document = diagnose([own(("velocity_filter_lag:tau=0.9",), 5, 200.0)], merlin()).document()
    assert document["causes"][0]["effect"] == "velocity_filter_lag", document["sentence"]


def test_a_change_with_depth_begins_at_depths_of_the_log_and_beyond_them():
    p, library = posed()
    z = np.concatenate([part.eta0[:, 2] for part in p.runs])
    data = sorted(dict(h.at)[slot(p, "density_gradient.depth")] for h in library if h.name == "density_gradient")
    assert len(data) == 5 and data[0] < z.min() < data[1] < data[3] < z.max() < data[4]


@pytest.mark.slow
def test_a_vehicle_that_keeps_its_depth_does_not_tell_a_weight_from_a_change_of_density(tmp_path: Path):
    """By another plant: trimmed above the depth at which it works, in water that gets lighter; either may be so."""
    document = diagnose([foreign(tmp_path, (("density_gradient", "", -1.126),), 31, 300.0, 0.03, mission="steps")], merlin()).document()
    assert {"density_gradient", "buoyancy_error"} <= {name for cause in document["causes"] for name in cause["group"]}, document["sentence"]


def test_a_current_with_shear_begins_with_and_without_a_velocity_in_the_middle_of_the_depths():
    p, library = posed()
    begun = [h for h in library if h.name == "current_shear"]
    z = np.concatenate([part.depths() for part in p.runs])
    assert [slot(p, "current_shear.north_at_depth") in h.slots for h in begun] == [False, True]
    assert all(dict(h.at)[slot(p, "current_shear.depth")] == pytest.approx(float(np.median(z))) for h in begun)


def test_a_current_that_changes_begins_with_and_without_a_mean_at_every_period():
    p, library = posed()
    begun = [h for h in library if h.name == "current_varying"]
    mean, period = slot(p, "current_varying.north_mean"), slot(p, "current_varying.period")
    with_it, without = ({dict(h.at)[period] for h in begun if (mean in h.slots) is some} for some in (True, False))
    assert with_it == without and len(begun) == 2 * len(without)
    moved = {d.id for h in begun for d in h.displaced}
    assert len(moved) == 4 * len(without), "with a mean it begins by the columns that it has without one"
    assert mean in columns_of(begun).slots


@pytest.mark.slow
@pytest.mark.parametrize(("planted", "severity", "mission", "seed"), [("current_shear", 1.37, "yoyo", 404052221), ("current_varying", 1.9, "station", 31)])
def test_a_current_that_changes_with_depth_and_one_that_changes_in_time_are_told_apart(tmp_path: Path, planted, severity, mission, seed):
    """By another plant: a dive up and down again and again makes the one as periodic as the other."""
    document = diagnose([foreign(tmp_path, ((planted, "", severity),), seed, 300.0, 0.03, mission=mission)], merlin()).document()
    assert [c["effect"] for c in document["causes"]] == [planted], document["sentence"]


def test_a_threshold_begins_at_speeds_at_which_the_thruster_turns_in_the_log():
    p, library = posed()
    data = p.runs[0].actuation
    for i, thruster in enumerate(merlin().thrusters):
        turns = np.abs(data.inputs.speed[data.known][:, i])
        begins = [dict(h.at)[slot(p, f"thruster_sticking[{thruster}].breakaway")] for h in library if h.name == f"thruster_sticking[{thruster}]"]
        assert len(begins) == 3 and turns[turns > 0.0].min() < min(begins) < max(begins) < turns.max()


@pytest.mark.slow
def test_a_thruster_that_sticks_at_half_of_its_speed_is_found():
    """Far beyond a usual dead band: a search that begins at the size of one changes nothing there, and sees no slope."""
    document = diagnose([own(("thruster_sticking[HFP]:breakaway=2.2",), 5, 240.0)], merlin()).document()
    assert [c["effect"] for c in document["causes"]] == ["thruster_sticking[HFP]"], document["sentence"]
    assert document["causes"][0]["parameters"]["breakaway"]["value"] == pytest.approx(2.2, rel=0.1)


@pytest.mark.slow
def test_an_offset_along_one_axis_is_tried_by_itself():
    """Three parameters free for one that is off are evidence lost."""
    p, library = posed()
    assert {h.slots for h in library if h.label in ("cg_offset@x", "cg_offset@y", "cg_offset@z")} == {(slot(p, f"cg_offset.{c}"),) for c in "xyz"}
    document = diagnose([own(("cg_offset:y=0.012",), 5, 200.0)], merlin()).document()
    (cause,) = document["causes"]
    assert cause["effect"] == "cg_offset" and cause["parameters"]["y"]["value"] == pytest.approx(0.012, rel=0.15)


def test_a_coefficient_that_slop_moves_competes_wherever_its_search_begins():
    """Begun elsewhere, a dead band would else be held to its tolerance by the column that its tolerance has."""
    p, library = posed()
    width = slot(p, "thruster_deadband.width")
    begun = [h for h in library if h.name == "thruster_deadband"]
    assert width in p.tolerance.sd and all(h.displaced for h in begun)
    assert all(prior_of(p, h).sd[width] > 10.0 * p.tolerance.sd[width] for h in begun)


def test_what_holds_the_vehicle_begins_where_it_is_said_to():
    """Until then where the vehicle was in the middle of the log; beyond its bounds nothing begins."""
    parts, _ = cut([own((), 5, 200.0)], merlin(), "fossen", 10.0)
    names = {i: s.parameter.name for i, s in enumerate(parts[0].plant.slots)}

    def snags(held: list[dict[str, float]]) -> list[dict[str, float]]:
        library, _ = hypotheses(parts, hints=Hints(changes_s=[120.0], springs=held))
        assert 120.0 in {dict(h.at)[h.slots[1]] for h in library if h.name == "thruster_fault_onset[VAC]"}
        return [{names[s]: value for s, value in h.at} for h in library if h.name == "tether_snag"]

    run, (somewhere,) = parts[0].run, snags([])
    assert 60.0 < somewhere["onset"] < 140.0
    for place, channel in {"north": "x", "east": "y", "down": "z"}.items():
        assert somewhere[place] == pytest.approx(float(np.interp(somewhere["onset"] / run.dt, np.arange(len(run)), run.get(channel))))
    spring = {"stiffness": 300.0, "north": 3.0, "east": -2.0, "down": 9.0, "radius": 1.5, "onset": 80.0, "x": -0.5, "z": 0.0}
    assert snags([spring, spring | {"x": -9.0}]) == [spring, spring | {"x": -2.0}]


def test_a_hypothesis_is_tried_without_what_only_refines_it():
    _, library = posed()
    lags = [h for h in library if h.name == "thrust_lag" and not h.at]
    assert sorted(len(h.slots) for h in lags) == [1, 2] and len({h.label for h in lags}) == 2
