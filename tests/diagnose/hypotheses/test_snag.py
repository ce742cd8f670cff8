"""What holds the vehicle: a spring is found in the forces that are missing, and named in a log of one."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from diagnose_case import foreign, merlin, own

from rovval.core.frames import rotation_from_euler
from rovval.diagnose import diagnose
from rovval.diagnose.effort import SPRING_EVIDENT_SHARE
from rovval.diagnose.hypotheses.initial_points import Hints
from rovval.diagnose.hypotheses.library import hypotheses
from rovval.diagnose.hypotheses.missing_wrench import MissingWrench
from rovval.diagnose.hypotheses.snag import explained, fitted_spring
from rovval.diagnose.windows.multiple_shooting import cut
from rovval.vehicle import load


@pytest.mark.slow
def test_a_stiff_spring_is_found_through_the_beginnings_of_windows(tmp_path: Path):
    """A small vehicle of the independent plant, held for half of the log: over ten seconds a spring a third too soft is a valley of its own."""
    run = foreign(tmp_path, (("tether_snag", "", 1.1),), 1, 300.0, 0.03, "bluerov2_heavy", "survey", 135.4)
    document = diagnose([run], load("bluerov2_heavy")).document()
    assert document["causes"][0]["effect"] == "tether_snag", document["sentence"]
    assert document["causes"][0]["onset_s"] == pytest.approx(135.4, abs=10.0)
    assert document["shrinkage"]["total"] > 0.85


def test_a_slack_spring_is_a_steady_pull_and_not_evident():
    parts, _ = cut([own((), 5, 200.0)], merlin(), "fossen", 10.0)
    spring = {"stiffness": 300.0, "onset": 80.0}
    springs = [spring | {"share": SPRING_EVIDENT_SHARE}, spring | {"share": 0.9 * SPRING_EVIDENT_SHARE}, spring]
    assert [h.evident for h in hypotheses(parts, hints=Hints(springs=springs))[0] if h.name == "tether_snag"] == [True, False, False]


def test_what_has_held_the_vehicle_all_along_may_pull_steadily():
    """A steady pull is searched from where a spring would hold the vehicle, too: towards that point, as strong as the spring is on average."""
    parts, _ = cut([own((), 5, 200.0)], merlin(), "fossen", 10.0)
    spring = {"stiffness": 50.0, "north": 30.0, "east": 40.0, "down": 25.0, "radius": 0.0, "x": -0.8, "z": 0.0, "onset": 8.0, "pull": 60.0, "share": 0.0}
    [held] = [h for h in hypotheses(parts, hints=Hints(springs=[spring]))[0] if h.label == "tether_tension@held0"]
    at = {parts[0].plant.slots[s].parameter.name: value for s, value in held.at}
    depth = at["depth"]
    assert np.array([at["north"], at["east"], at["down"]]) == pytest.approx(60.0 * np.array([30.0, 40.0, 25.0 - depth]) / np.hypot(50.0, 25.0 - depth))
    assert at["nearness"] == pytest.approx(1.0 / np.hypot(50.0, 25.0 - depth)) and at["x"] == -0.8


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
    lack = MissingWrench(A, np.einsum("wij,wj->wi", A, wrench), t, place, rotation, np.zeros((*t.shape, 6)))
    worth, found = fitted_spring(lack, onset, place[6, 0, 0], 1.0)
    assert worth == pytest.approx(float(np.einsum("wi,wij,wj->", wrench, A, wrench)), rel=0.01)
    want = {"north": 2.0, "east": -1.0, "down": 6.0, "radius": radius, "stiffness": stiffness, "x": -0.6, "z": -0.1, "onset": onset}
    assert {name: found[name] for name in want} == pytest.approx(want, rel=0.1, abs=0.15)
    away = np.linalg.norm(point - place[t >= onset], axis=-1)
    assert found["pull"] == pytest.approx(float(stiffness * np.maximum(away - radius, 0.0).mean()), rel=0.2)
    assert explained(replace(lack, b=-lack.b), onset, point, radius)[0] == 0.0


@pytest.mark.slow
@pytest.mark.parametrize(("effect", "seed"), [("tether_snag", 8), ("compass_deviation", 6)])
def test_what_catches_the_tether_or_turns_the_compass_is_named(effect, seed, tmp_path: Path):
    """Of the independent plant: a softened spring from the fairlead, and a compass with two harmonics and the thrusters' own field."""
    document = diagnose([foreign(tmp_path, ((effect, "", 1.4),), seed, 240.0, 0.03)], merlin()).document()
    assert [c["effect"] for c in document["causes"]] == [effect], document["sentence"]
