"""Where the search begins: effects whose place, period or size no slope at nothing shows, and fits that would end in the first valley."""

from __future__ import annotations

import functools
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from diagnose_case import LIBRARY, foreign, merlin, own, without

from rovval.core.data import Run
from rovval.core.frames import rotation_from_euler
from rovval.diagnose import diagnose
from rovval.diagnose.hypotheses.change_points import FEWEST, _split
from rovval.diagnose.hypotheses.holding import EVIDENT
from rovval.diagnose.hypotheses.hypothesis import Hypothesis, columns_of
from rovval.diagnose.hypotheses.initial_points import LEVER
from rovval.diagnose.hypotheses.library import hypotheses
from rovval.diagnose.hypotheses.observability import LARGE, LEAST_SIGMA, excited
from rovval.diagnose.hypotheses.snag import Missing
from rovval.diagnose.hypotheses.snag import _settled as settled_spring
from rovval.diagnose.hypotheses.spectrum import lines, waves
from rovval.diagnose.inference.hypothesis_fit import Confirmed, confirm, errors
from rovval.diagnose.inference.map_fit import healthy_point, resettled, settle
from rovval.diagnose.inference.prior import slop_prior
from rovval.diagnose.inference.problem import Problem, pose
from rovval.diagnose.residuals import perturbations as lanes
from rovval.diagnose.residuals.perturbations import lanes_of
from rovval.diagnose.residuals.sensitivities import linearise
from rovval.diagnose.search.admissibility import _beyond_the_library, simplest
from rovval.diagnose.search.candidates import _half_a_turn_later, finalists, prior_of
from rovval.diagnose.search.confusion import Rival
from rovval.diagnose.search.forward import select
from rovval.diagnose.windows.shooting import cut_all
from rovval.storage.archive import open_run
from rovval.vehicle import load


@functools.cache
def posed(*effects: str) -> tuple[Problem, list[Hypothesis]]:
    parts, _ = cut_all([own(effects, 5, 200.0)], merlin(), "fossen", 10.0)
    library = hypotheses(parts)[0]
    return pose(parts, columns_of(library), 0.05), library


def slot(problem: Problem, key: str) -> int:
    return next(i for i, s in enumerate(problem.plant.slots) if s.key == key)


@pytest.mark.parametrize("period", [7.7, 12.4])
def test_the_period_of_waves_is_the_strongest_line(period):
    p, _ = posed(f"waves:amplitude=1,period={period},direction=2.6,phase=-2.0")
    (best, share), *others = lines(p, settle(p, p.origin, ()))
    assert best == pytest.approx(period, rel=0.02)
    assert share > 0.3 and all(share > 2 * other for _, other in others)


@pytest.mark.parametrize(("period", "direction", "amplitude"), [(5.0, 0.8, 2.0), (4.0, -2.4, 3.0), (6.0, 2.6, 1.5)])
def test_a_vehicle_under_way_meets_waves_at_another_period_than_theirs(period, direction, amplitude):
    """Whose direction is right finds their own; without a position none is looked for."""
    p, _ = posed(f"waves:amplitude={amplitude},period={period},direction={direction},phase=1")
    point = settle(p, p.origin, ())
    met = [one for one, _ in lines(p, point)]
    [found] = waves(p, point, met, (2.0, 20.0), (direction,))[direction]
    assert abs(found - period) < 0.4 * abs(met[0] - period)
    lost = replace(p, parts=tuple(replace(part, run=without(part.run, "x")) for part in p.parts))
    assert waves(lost, point, met, (2.0, 20.0), (direction,)) == waves(p, point, [70.0], (2.0, 20.0), (direction,)) == {}


def test_a_healthy_log_has_no_line():
    p, _ = posed()
    assert max((share for _, share in lines(p, settle(p, p.origin, ()))), default=0.0) < 0.1


@pytest.mark.parametrize(
    ("effect", "name"),
    [("waves:amplitude=1,period=9.3,direction=2.6,phase=-2.0", "waves"), ("current_varying:north=0.15,east=-0.1,period=83,phase=2.5", "current_varying")],
)
def test_what_swings_is_found_whatever_its_period_and_phase(effect, name):
    document = diagnose([own((effect,), 5, 240.0)], merlin()).document()
    assert [c["effect"] for c in document["causes"]] == [name], document["sentence"]
    found, true = document["causes"][0]["parameters"]["period"]["value"], float(effect.split("period=")[1].split(",")[0])
    assert found == pytest.approx(true, rel=0.03) and document["shrinkage"]["total"] > 0.8


def test_waves_of_the_independent_plant_are_found(tmp_path: Path):
    document = diagnose([foreign(tmp_path, (("waves", "", 1.5),), 31, 240.0, 0.03)], merlin()).document()
    assert "waves" in [c["effect"] for c in document["causes"]], document["sentence"]


def test_a_negative_amplitude_is_half_a_turn():
    p, library = posed()
    h, phase = next(h for h in library if h.name == "waves"), slot(p, "waves.phase")
    for before, after in ((0.0, np.pi), (np.pi / 2, -np.pi / 2)):
        start = p.origin.copy()
        start[phase] = before
        assert _half_a_turn_later(p, h, start)[phase] == pytest.approx(after)
        assert start[phase] == before


def test_a_pull_may_begin_ahead_or_astern():
    p, library = posed()
    x, reach = slot(p, "tether_tension.x"), LEVER * max(float(np.linalg.norm(t.position)) for t in merlin().thruster)
    starts = [dict(h.at)[x] for h in library if h.name == "tether_tension" and h.at]
    assert starts == pytest.approx([-min(reach, 2.0), min(reach, 2.0)])
    document = diagnose([own(("tether_tension:north=250,east=120,x=-1.4",), 5, 200.0)], merlin()).document()
    assert document["causes"][0]["effect"] == "tether_tension", document["sentence"]
    assert document["causes"][0]["parameters"]["x"]["value"] == pytest.approx(-1.4, abs=0.4)


def test_a_long_lag_is_found_though_it_is_no_multiple_of_a_short_one():
    document = diagnose([own(("velocity_filter_lag:tau=0.9",), 5, 200.0)], merlin()).document()
    assert document["causes"][0]["effect"] == "velocity_filter_lag", document["sentence"]


def bluerov2(folder: Path, name: str, seed: int, seconds: float, slop: float, *effects: tuple[str, str, float]) -> Run:
    """A log of the independent plant, flown open-loop."""
    from rovval.blind.cases.csv_log import write_csv
    from rovval.blind.cases.flight import fly
    from rovval.blind.plant.spec import Planted

    planted = [Planted(name, target or None, severity) for name, target, severity in effects]
    write_csv(fly(LIBRARY / "bluerov2_heavy.toml", "rich", planted, seed, seconds, slop), folder / name)
    return open_run(folder / name, "merlin")


def rolling(folder: Path) -> Problem:
    parts, _ = cut_all([bluerov2(folder, "rolling.csv", 12, 150.0, 0.05)], load("bluerov2_heavy"), "fossen", 10.0)
    return pose(parts, columns_of(hypotheses(parts)[0]), 0.05)


def test_a_list_that_an_autopilot_holds_is_found(tmp_path: Path):
    """It makes roll and pitch count little, and other coefficients within slop show more than the list itself."""
    document = diagnose([bluerov2(tmp_path, "list.csv", 12, 200.0, 0.03, ("cg_offset", "", -1.6))], load("bluerov2_heavy")).document()
    assert [c["effect"] for c in document["causes"]] == ["cg_offset"], document["sentence"]


def test_what_only_refines_an_effect_does_not_make_it_less_simple():
    p, library = posed()
    fitted = Confirmed((), p.origin, SimpleNamespace(), 0.0, np.zeros(1), np.zeros(1), ())  # type: ignore[arg-type]
    by_name = {h.name: Rival(h, fitted, evidence, 0.8, 0.0) for h in library for evidence in [400.0 if h.name == "thrust_lag" else 390.0]}
    lag, offset, hull = (by_name[name] for name in ("thrust_lag", "time_offset", "hull_interaction"))
    assert len(lag.hypothesis.slots) == 2 and len(offset.hypothesis.slots) == 1
    assert simplest(p, [lag, offset]) is lag
    assert simplest(p, [replace(hull, evidence=400.0), offset]) is offset


@pytest.mark.parametrize(("other", "evidence", "told"), [
    ("thruster_degraded[HFP]", 370.0, "thruster_fault_onset[HFP]"), ("thruster_degraded[HFP]", 390.0, "thruster_degraded[HFP]"),
    ("thruster_degraded[HFS]", 370.0, "thruster_degraded[HFS]"),
])  # fmt: skip
def test_evidence_says_whether_a_loss_of_thrust_began_in_mid_log(other: str, evidence: float, told: str):
    """No form of an equation lies between the two; between two thrusters it may."""
    p, library = posed()
    fitted = Confirmed((), p.origin, SimpleNamespace(), 0.0, np.zeros(1), np.zeros(1), ())  # type: ignore[arg-type]
    worth = {"thruster_fault_onset[HFP]": 400.0, other: evidence}
    rivals = [Rival(next(h for h in library if h.name == name), fitted, much, 0.8, 0.0) for name, much in worth.items()]
    assert simplest(p, rivals).hypothesis.name == told


def test_the_beginning_first_ends_no_higher(tmp_path: Path):
    """A vehicle that rolls freely on a log of the independent plant: a fit of whole windows from far away stops in the first valley."""
    p = rolling(tmp_path)
    far, near = settle(p, p.origin, ()), healthy_point(p)
    assert near.profile() <= 1.02 * far.profile()


def test_no_cause_gains_by_another_start():
    p, _ = posed("inflow_loss:loss=0.4")
    healthy, slots = settle(p, p.origin, ()), (slot(p, "inflow_loss.loss"),)
    cause = confirm(p, p.origin, slots)
    again = resettled(p, healthy, cause.point, slots)
    assert again.profile() <= healthy.profile()
    assert all(again.beta[s] == p.origin[s] for s in slots)


@pytest.mark.parametrize(
    ("name", "key", "value", "beyond"),
    [
        ("cross_drag", "cross_drag.sway_to_yaw", -0.5, True), ("cross_drag", "cross_drag.sway_to_yaw", -0.3, False),
        ("quadratic_drag[surge]", "quadratic_drag[surge].scale", -0.95, False), ("quadratic_drag[surge]", "quadratic_drag[surge].scale", 9.0, True),
        ("thruster_degraded[HFP]", "thruster_degraded[HFP].loss", 1.0, False), ("thruster_degraded[HFP]", "thruster_degraded[HFP].loss", -0.5, True),
        ("tether_tension", "tether_tension.x", 2.0, False), ("tether_drag", "tether_drag.per_length", 0.0, False), ("waves", "waves.amplitude", 3.0, True),
    ],
)  # fmt: skip
def test_a_size_at_the_end_of_its_search_is_no_cause_unless_it_is_the_end_of_the_thing(name, key, value, beyond):
    p, library = posed()
    h, where = next(h for h in library if h.name == name), slot(p, key)
    beta = p.origin.copy()
    beta[where] = value
    bounds = p.plant.slots[where].parameter
    fitted: Any = SimpleNamespace(beta=beta, at_bound=(where,) if value in (bounds.low, bounds.high) else ())
    assert _beyond_the_library(p, Rival(h, fitted, 100.0, 0.5, 0.0)) is beyond


def test_a_channel_that_never_changes_is_no_measurement():
    run = own((), 5, 100.0)
    stuck = replace(run, values={**run.values, "u": np.full(len(run), 0.5)})
    document = diagnose([stuck], merlin()).document()
    assert "u" not in document["gap"]["axes"] and any("all along" in row["detail"] for row in document["log"])
    assert document["verdict"] == "no_gap", document["sentence"]


@pytest.mark.parametrize(
    ("planted", "name"),
    [
        ((("density_gradient", "", -0.8),), "density_gradient"), ((("thruster_deadband", "", 2.3),), "thruster_deadband"),
        pytest.param((("crossflow_loss", "", 1.5),), "crossflow_loss", marks=pytest.mark.slow),
        pytest.param((("current_shear", "", 1.2),), "current_shear", marks=pytest.mark.slow),
    ],
)  # fmt: skip
def test_what_is_large_or_has_its_datum_in_the_log_is_found(tmp_path: Path, planted, name):
    """A loss or a dead band beyond what is usual, and a change with depth about a depth that the log goes through; independent plant. The dead band there
    is of low flow: above it nothing is missing, which no gain of all thrusters is to make up for."""
    document = diagnose([foreign(tmp_path, planted, 41, 160.0, 0.03)], merlin()).document()
    assert name in document["causes"][0]["group"][:2], document["sentence"]
    assert "rpm_scale" not in {c["effect"] for c in document["causes"]}


def test_propellers_that_are_all_of_one_hand_are_found_where_the_file_has_them_in_pairs(tmp_path: Path):
    document = diagnose([bluerov2(tmp_path, "hand.csv", 12, 160.0, 0.03, ("propeller_torque", "", 1.5))], load("bluerov2_heavy")).document()
    (cause,) = document["causes"]
    assert cause["effect"] == "propeller_torque" and cause["parameters"]["common"]["value"] < -0.02, document["sentence"]


def test_a_change_with_depth_begins_at_depths_of_the_log():
    p, library = posed()
    z = np.concatenate([part.eta0[:, 2] for part in p.parts])
    for name in ("density_gradient", "current_shear"):
        data = [dict(h.at)[slot(p, f"{name}.depth")] for h in library if h.name == name]
        assert len(data) == 3 and z.min() < min(data) < max(data) < z.max()


def test_a_drag_that_is_gone_altogether_is_significant_though_it_rests_on_its_bound():
    """The slope that is left on a bound belongs to no window: it widens no interval."""
    p, _ = posed("linear_drag[sway]:scale=-0.95")
    where = slot(p, "linear_drag[sway].scale")
    start = p.origin.copy()
    start[where] = -0.95
    fitted = confirm(p, start, (where,))
    point, first = fitted.point, np.arange(len(fitted.point.columns)) == 0
    pushed = replace(point.data, b=point.data.b - first * 0.2 * point.curvature[0, 0])
    on_bound = replace(fitted, point=replace(point, data=pushed, side=np.where(first, -1.0, 0.0)))
    assert errors(p, on_bound)[0] < 1.5 * errors(p, fitted)[0]


def test_an_offset_along_one_axis_is_tried_by_itself():
    """Three parameters free for one that is off are evidence lost."""
    p, library = posed()
    assert {h.slots for h in library if h.label in ("cg_offset@x", "cg_offset@y", "cg_offset@z")} == {(slot(p, f"cg_offset.{c}"),) for c in "xyz"}
    document = diagnose([own(("cg_offset:y=0.012",), 5, 200.0)], merlin()).document()
    (cause,) = document["causes"]
    assert cause["effect"] == "cg_offset" and cause["parameters"]["y"]["value"] == pytest.approx(0.012, rel=0.15)


def test_thrust_across_a_stream_is_lost_and_never_turned_round():
    from rovval.effects.library.crossflow_loss import thrust

    assert thrust(1.0, 100.0, np.array([0.0, 0.5, 1.0, 3.0])).tolist() == [100.0, 50.0, 0.0, 0.0]


def test_what_only_shows_when_it_is_large_competes_and_is_not_called_absent():
    p, library = posed()
    kept, silent = excited(p, library)
    names = {h.name for h in kept}
    assert silent.keys() & names and silent.keys() - names and not (names | silent.keys()) ^ {h.name for h in library}
    assert all(float(why.split("with ")[1].split()[0]) >= LEAST_SIGMA / LARGE for name, why in silent.items() if name in names)


def test_a_coefficient_that_slop_moves_competes_wherever_its_search_begins():
    """Begun elsewhere, a dead band would else be held to its tolerance by slop's own column for it."""
    p, library = posed()
    width = slot(p, "thruster_deadband.width")
    begun = [h for h in library if h.name == "thruster_deadband"]
    assert width in p.slop.sd and all(h.directions for h in begun)
    assert all(prior_of(p, h).sd[width] > 10.0 * p.slop.sd[width] for h in begun)


def test_what_only_places_an_effect_does_not_make_its_size_unsure():
    """Seen from one height, a gain and a height of the ground effect are one number; that it is not nothing is sure all the same."""
    p, _ = posed()
    north, phase, period = (slot(p, f"current_varying.{name}") for name in ("north", "phase", "period"))
    beta = p.origin.copy()
    beta[[north, phase, period]] = 0.1, 0.4, 60.0
    fitted = confirm(p, beta, (north, phase, period))
    free, fixed = errors(p, fitted), errors(p, fitted, (phase, period))
    assert (fixed[1:] == 0.0).all() and 0.0 < fixed[0] <= free[0]


def test_a_parameter_whose_channel_is_not_in_the_log_does_not_compete():
    parts, _ = cut_all([own((), 5, 120.0)], merlin(), "fossen", 10.0)
    library, untestable = hypotheses(parts)
    (sag,) = [h for h in library if h.name == "voltage_sag"]
    assert [parts[0].plant.slots[s].key for s in sag.slots] == ["voltage_sag.rate"]
    assert "voltage" in untestable["voltage_sag.gain"]


def test_a_late_depth_needs_a_velocity_to_be_late_against():
    """Where depth is all that is known of heave, a late one is any force that lifts."""
    parts, _ = cut_all([without(own((), 5, 120.0), "w")], merlin(), "fossen", 10.0)
    library, untestable = hypotheses(parts)
    assert "time_offset[depth]" not in {h.name for h in library} and "needs w" in untestable["time_offset[depth].delay"]


@pytest.mark.parametrize(("least", "there"), [(2.9, True), (3.1, False)])
def test_what_acts_close_by_does_not_compete_from_afar(least: float, there: bool):
    """Else a force that varies with depth five metres above the bottom is the bottom's."""
    run = own((), 5, 120.0)
    altitude = {"altitude": least + np.linspace(4.0, 0.0, len(run))}
    logged = replace(run, values={**run.values, **altitude}, reasons={**run.reasons, "altitude": run.reasons["psi"]})
    parts, _ = cut_all([logged], merlin(), "fossen", 10.0)
    library, untestable = hypotheses(parts)
    assert ("ground_effect" in {h.name for h in library}) == there
    assert untestable.get("ground_effect") == (None if there else "no altitude below 3 m in this log")


def test_what_is_named_is_not_called_untestable(tmp_path: Path):
    """A thruster that is turned far round shows, though a turn of typical size would not."""
    document = diagnose([bluerov2(tmp_path, "turned.csv", 12, 200.0, 0.03, ("thruster_misaligned", "T1", -2.0))], load("bluerov2_heavy")).document()
    assert [c["effect"] for c in document["causes"]] == ["thruster_misaligned[T1]"], document["sentence"]
    untestable = {row["effect"] for row in document["not_testable"]}
    assert "thruster_misaligned[T2]" in untestable and "thruster_misaligned[T1]" not in untestable


def test_what_the_finalists_kept_out_is_tried_where_none_of_them_stands(monkeypatch: pytest.MonkeyPatch):
    """The first ones settled are none that is there, as where a bogus one promises much."""
    p, library = posed("buoyancy_error:force=200")
    asked = list[set[str]]()

    def settled(problem: Problem, data: Any, hypotheses: list[Hypothesis], promised: dict[str, float], *rest: Any) -> list[Rival]:
        asked.append({h.name for h in hypotheses})
        if len(asked) > 1:
            return finalists(problem, data, hypotheses, promised, *rest)
        bogus = [h for h in hypotheses if h.label == "linear_drag[yaw]"]
        return finalists(problem, data, bogus, {h.label: 50.0 for h in bogus}, *rest)

    monkeypatch.setattr("rovval.diagnose.search.round.finalists", settled)
    found = select(p, library, 0, lambda *_: None)
    assert [n.hypothesis.name for n in found.named] == ["buoyancy_error"]
    assert asked[0] - asked[1] == {"linear_drag[yaw]"}, "what was settled is not settled again"


@pytest.mark.parametrize("at", [3, 10, 17])
def test_a_break_is_where_the_level_steps(at):
    noise = np.random.default_rng(at).normal(0.0, 0.2, 20)
    found = _split(noise + np.where(np.arange(20) < at, 0.0, 2.0), 5, 2)
    assert max(found)[1] == 5 + at
    assert all(5 + FEWEST <= i <= 25 - FEWEST for _, i in found)
    assert _split(noise[: 2 * FEWEST - 1], 0, 2) == []


def test_what_holds_the_vehicle_begins_where_it_is_said_to():
    """Until then where the vehicle was in the middle of the log; beyond its bounds nothing begins."""
    parts, _ = cut_all([own((), 5, 200.0)], merlin(), "fossen", 10.0)
    names = {i: s.parameter.name for i, s in enumerate(parts[0].plant.slots)}

    def snags(held: list[dict[str, float]]) -> list[dict[str, float]]:
        library, _ = hypotheses(parts, breaks_s=[120.0], held=held)
        assert 120.0 in {dict(h.at)[h.slots[1]] for h in library if h.name == "thruster_fault_onset[VAC]"}
        return [{names[s]: value for s, value in h.at} for h in library if h.name == "tether_snag"]

    run, (somewhere,) = parts[0].run, snags([])
    assert 60.0 < somewhere["onset"] < 140.0
    for place, channel in {"north": "x", "east": "y", "down": "z"}.items():
        assert somewhere[place] == pytest.approx(float(np.interp(somewhere["onset"] / run.dt, np.arange(len(run)), run.get(channel))))
    spring = {"stiffness": 300.0, "north": 3.0, "east": -2.0, "down": 9.0, "radius": 1.5, "onset": 80.0, "x": -0.5, "z": 0.0}
    assert snags([spring, spring | {"x": -9.0}]) == [spring, spring | {"x": -2.0}]


def test_a_stiff_spring_is_found_through_the_beginnings_of_windows(tmp_path: Path):
    """A small vehicle of the independent plant, held for half of the log: over ten seconds a spring a third too soft is a valley of its own."""
    run = foreign(tmp_path, (("tether_snag", "", 1.1),), 47900686, 300.0, 0.03, "bluerov2_heavy", "survey", 135.4)
    document = diagnose([run], load("bluerov2_heavy")).document()
    assert [c["effect"] for c in document["causes"]] == ["tether_snag"], document["sentence"]
    assert document["causes"][0]["onset_s"] == pytest.approx(135.4, abs=10.0)
    assert document["shrinkage"]["total"] > 0.85


def test_a_slack_spring_is_a_steady_pull_and_not_evident():
    parts, _ = cut_all([own((), 5, 200.0)], merlin(), "fossen", 10.0)
    spring = {"stiffness": 300.0, "onset": 80.0}
    springs = [spring | {"share": EVIDENT}, spring | {"share": 0.9 * EVIDENT}, spring]
    assert [h.evident for h in hypotheses(parts, held=springs)[0] if h.name == "tether_snag"] == [True, False, False]


def test_a_spring_is_found_in_the_forces_that_are_missing():
    """Forces of a known spring from 60 s on, tied 0.6 m astern, on a vehicle that circles and turns; and none that would have to push."""
    rng, onset, point, radius, stiffness, tie = np.random.default_rng(3), 60.0, np.array([2.0, -1.0, 6.0]), 1.2, 40.0, np.array([-0.6, 0.0, -0.1])
    t = np.arange(0.25, 200.0, 0.5).reshape(20, 2, 10)
    place = np.stack([4.0 * np.sin(t / 17.0), 3.0 * np.cos(t / 11.0), 6.0 + np.sin(t / 29.0)], axis=-1)
    rotation = rotation_from_euler(np.stack([0.05 * np.sin(t), 0.05 * np.cos(t), t / 23.0], axis=-1))
    to = point - (place + rotation @ tie)
    away = np.linalg.norm(to, axis=-1, keepdims=True)
    pull = np.where(t[..., None] >= onset, stiffness * np.maximum(away - radius, 0.0) * to / away, 0.0)
    force = np.einsum("whtij,whti->whj", rotation, pull) / t.shape[-1]
    wrench = np.concatenate([force, np.cross(tie, force)], axis=-1).reshape(20, 12)
    shape = rng.normal(size=(20, 12, 12))
    A = shape @ shape.swapaxes(1, 2)
    lack = Missing(A, np.einsum("wij,wj->wi", A, wrench), t, place, rotation)
    worth, found = settled_spring(lack, onset, place[6, 0, 0], 1.0)
    assert worth == pytest.approx(float(np.einsum("wi,wij,wj->", wrench, A, wrench)), rel=0.01)
    want = {"north": 2.0, "east": -1.0, "down": 6.0, "radius": radius, "stiffness": stiffness, "x": -0.6, "z": -0.1, "onset": onset}
    assert found == pytest.approx(want, rel=0.1, abs=0.15)
    assert replace(lack, b=-lack.b).worth(onset, point, radius)[0] == 0.0


@pytest.mark.parametrize(("effect", "seed"), [("tether_snag", 8), ("compass_deviation", 6)])
def test_what_catches_the_tether_or_turns_the_compass_is_named(effect, seed, tmp_path: Path):
    """Of the independent plant: a softened spring from the fairlead, and a compass with two harmonics and the thrusters' own field."""
    document = diagnose([foreign(tmp_path, ((effect, "", 1.4),), seed, 240.0, 0.03)], merlin()).document()
    assert [c["effect"] for c in document["causes"]] == [effect], document["sentence"]


def test_a_hypothesis_is_tried_without_what_only_refines_it():
    _, library = posed()
    lags = [h for h in library if h.name == "thrust_lag" and not h.at]
    assert sorted(len(h.slots) for h in lags) == [1, 2] and len({h.label for h in lags}) == 2


def test_where_nothing_is_there_yet_the_nominal_simulation_serves(monkeypatch: pytest.MonkeyPatch):
    """To the last digit: onsets, periods, depths, levers of effects of no size; once there is a size, the place counts."""
    p, library = posed()
    part, asked = p.parts[0], columns_of(library)
    columns, directions = tuple(sorted({*asked.slots, *p.slop.sd})), asked.directions
    beta = p.origin.copy()
    beta[slot(p, "payload_change.weight")] = 50.0
    lean, few = linearise(part, beta, columns, directions), len(lanes_of(part, beta, [], columns, directions))
    monkeypatch.setattr(lanes, "_idle", lambda *known: set())
    whole, all_of_them = linearise(part, beta, columns, directions), len(lanes_of(part, beta, [], columns, directions))
    np.testing.assert_array_equal(lean.S, whole.S)
    assert few < 0.9 * all_of_them


def test_a_depth_sensor_that_is_late_is_named_and_has_no_tolerance(tmp_path: Path):
    """Half a sample of delay is nothing that a check of the depth is held to see, so it is no slop; a longer one is told by that check alone."""
    run = foreign(tmp_path, (("time_offset", "depth", 1.5),), 12, 200.0, 0.02)
    parts, _ = cut_all([run], merlin(), "fossen", 10.0)
    late = {parts[0].plant.slots[s].key for s in slop_prior(parts[0].plant, 0.05).sd if parts[0].plant.slots[s].effect == "time_offset"}
    assert late == {"time_offset.tau", "time_offset[velocity].delay", "time_offset[attitude].delay"}
    (cause,) = diagnose([run], merlin()).document()["causes"]
    assert cause["effect"] == "time_offset[depth]" and cause["parameters"]["delay"]["low"] < 0.6 < cause["parameters"]["delay"]["high"]


@pytest.mark.parametrize(
    ("planted", "seed", "effect", "parameter", "true"),
    [
        (("time_offset", "attitude", 2.0), 13, "time_offset[attitude]", "delay", 0.8),
        (("time_offset", "attitude", -1.5), 13, "time_offset[attitude]", "delay", -0.6),
        (("payload_change", "", -1.5), 14, "payload_change", "mass", None),
    ],
    ids=["late", "early", "set down"],
)
def test_a_late_sensor_and_a_load_that_is_set_down_are_told_in_their_size(
    planted: tuple[str, str, float], seed: int, effect: str, parameter: str, true: float | None, tmp_path: Path
):
    """From the independent plant: delays that are a good part of a roll's period, and a mass that leaves with its load."""
    run = foreign(tmp_path, (planted,), seed, 200.0, 0.02)
    cause = diagnose([run], merlin()).document()["causes"][0]
    told = cause["parameters"][parameter]
    assert cause["effect"] == effect
    assert told["low"] < true < told["high"] if true else told["high"] < 0.0
