"""The library of hypotheses: what a log cannot test does not compete, and is said to."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from diagnose_case import merlin, own, without

from rovval.diagnose.hypotheses.initial_points import Hints
from rovval.diagnose.hypotheses.library import hypotheses
from rovval.diagnose.problem.prior import tolerance_prior
from rovval.diagnose.windows.multiple_shooting import cut


def test_a_parameter_whose_channel_is_not_in_the_log_does_not_compete():
    parts, _ = cut([own((), 5, 120.0)], merlin(), "fossen", 10.0)
    library, untestable = hypotheses(parts)
    (sag,) = [h for h in library if h.name == "voltage_sag"]
    assert [parts[0].plant.slots[s].key for s in sag.slots] == ["voltage_sag.rate"]
    assert "voltage" in untestable["voltage_sag.gain"]


def test_a_late_depth_needs_a_velocity_to_be_late_against():
    """Where depth is all that is known of heave, a late one is any force that lifts."""
    parts, _ = cut([without(own((), 5, 120.0), "w")], merlin(), "fossen", 10.0)
    library, untestable = hypotheses(parts)
    assert "time_offset[depth]" not in {h.name for h in library} and "needs w" in untestable["time_offset[depth].delay"]


@pytest.mark.parametrize(("logged", "there"), [((), False), (("u",), True), (("x", "y"), True)])
def test_a_hose_that_is_dragged_along_needs_a_way_that_it_is_dragged(logged: tuple[str, ...], there: bool):
    """Of a vehicle that only turns, as far as the log shows, its drag is any drag in yaw: yaw drag of real basin runs was named a tether's."""
    missing = [c for c in ("u", "v", "x", "y") if c not in logged]
    parts, _ = cut([without(own((), 5, 120.0), *missing)], merlin(), "fossen", 10.0)
    library, untestable = hypotheses(parts)
    assert ("tether_drag" in {h.name for h in library}) is there is ("tether_drag" not in untestable)


@pytest.mark.parametrize(("least", "there"), [(2.9, True), (3.1, False)])
def test_what_acts_close_by_does_not_compete_from_afar(least: float, there: bool):
    """Else a force that varies with depth five metres above the bottom is the bottom's."""
    run = own((), 5, 120.0)
    altitude = {"altitude": least + np.linspace(4.0, 0.0, len(run))}
    logged = replace(run, values={**run.values, **altitude}, reasons={**run.reasons, "altitude": run.reasons["psi"]})
    parts, _ = cut([logged], merlin(), "fossen", 10.0)
    library, untestable = hypotheses(parts)
    assert ("ground_effect" in {h.name for h in library}) == there
    assert untestable.get("ground_effect") == (None if there else "no altitude below 3 m in this log")


def test_a_tolerance_is_no_diagnosis():
    parts, _ = cut([own((), 5, 100.0)], merlin(), "fossen", 10.0)
    names = {h.name.partition("[")[0] for h in hypotheses(parts)[0]}
    assert "thruster_astern" not in names and "thruster_degraded" in names
    assert any(parts[0].plant.slots[s].effect == "thruster_astern" for s in tolerance_prior(parts[0].plant, 0.05).sd)


def test_in_still_water_nothing_of_the_water_competes():
    """Where the profile says so (`water = "still"`): a tank has neither current nor waves, whatever they would explain."""
    run = own((), 5, 100.0)
    for properties, there in (({}, True), ({"water": "still"}, False)):
        parts, _ = cut([replace(run, properties=properties)], merlin(), "fossen", 10.0)
        library, untestable = hypotheses(parts)
        assert any(h.effect.place == "water" for h in library) is there
        assert ("current_constant" in untestable and "stands still" in untestable["current_constant"]) is not there


@pytest.mark.parametrize("logged", [True, False])
def test_a_seabed_is_searched_for_below_the_log_where_no_altitude_says_where_it_is(logged: bool):
    run = own((), 5, 120.0)
    altitude = {"altitude": 1.0 + np.linspace(4.0, 0.0, len(run))} if logged else {}
    reasons = {"altitude": run.reasons["psi"]} if logged else {}
    parts, _ = cut([replace(run, values={**run.values, **altitude}, reasons={**run.reasons, **reasons})], merlin(), "fossen", 10.0)
    seabed = parts[0].plant.index["ground_effect.seabed"]
    found = [h for h in hypotheses(parts)[0] if h.name == "ground_effect"]
    assert found and all((seabed in h.slots) != logged for h in found)
    if not logged:
        deepest = float(run.get("z").max())
        assert all(deepest < dict(h.at)[seabed] < deepest + 2.0 for h in found)


def test_where_neither_altitude_nor_depth_is_logged_there_is_no_bottom():
    parts, _ = cut([without(own((), 5, 120.0), "z")], merlin(), "fossen", 10.0)
    library, untestable = hypotheses(parts)
    assert "ground_effect" not in {h.name for h in library}
    assert untestable["ground_effect"] == "needs altitude or z, and this log holds neither"


def test_a_sea_begins_at_as_many_trains_as_the_log_shows():
    """A single wave at the first of its lines, a sea at all of them, with the sizes of all in the linearisation; where it shows one there is no sea."""
    parts, _ = cut([own((), 5, 120.0)], merlin(), "fossen", 10.0)
    index = parts[0].plant.index
    lines: dict[float | None, tuple[float, ...]] = dict.fromkeys((-0.75 * np.pi, -0.25 * np.pi, 0.25 * np.pi, 0.75 * np.pi), (9.0, 10.0, 8.0))
    several = [h for h in hypotheses(parts, hints=Hints(lines))[0] if h.name == "waves"]
    assert {(len(h.slots), len(h.columns)) for h in several} == {(4, 2), (10, 6)} and len({h.label for h in several}) == len(several) == 8
    assert len({c for h in several for c in h.columns}) == sum(len(h.columns) for h in several)
    for single, sea in zip(several[::2], several[1::2], strict=True):
        assert dict(sea.at).items() >= dict(single.at).items()
        assert [dict(sea.at)[index[f"waves.{p}"]] for p in ("period", "period_2", "period_3")] == [9.0, 10.0, 8.0]
    assert {len(h.slots) for h in hypotheses(parts, hints=Hints({None: (9.0,)}))[0] if h.name == "waves"} == {4}


def test_a_tether_s_drag_and_its_pull_are_one_cause():
    """And nothing else of the library is one with another."""
    parts, _ = cut([own((), 5, 120.0)], merlin(), "fossen", 10.0)
    library, _ = hypotheses(parts)
    one = {(a.name, b.name) for a in library for b in library if a.is_one_with(b) and a.name != b.name}
    assert one == {("tether_drag", "tether_tension"), ("tether_tension", "tether_drag")}
    assert all(h.is_one_with(h) for h in library)
