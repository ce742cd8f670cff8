"""What the vehicle drags along: a line is found in the forces that are missing, and named in a log of one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from diagnose_case import merlin, own

from rovval.core.data import Array
from rovval.core.frames import rotation_from_euler
from rovval.diagnose import diagnose
from rovval.diagnose.hypotheses.initial_points import Hints
from rovval.diagnose.hypotheses.library import hypotheses
from rovval.diagnose.hypotheses.missing_wrench import MissingWrench
from rovval.diagnose.hypotheses.towed_line import LEAST_PULL, explained, towed_line
from rovval.diagnose.windows.multiple_shooting import cut

POINT, TIE = np.array([12.0, -8.0, 20.0]), np.array([-0.9, 0.0, -0.3])
DRAG, WEIGHT, PULL = 80.0, 6.0, 15.0


def lacking(rng: np.random.Generator, *, drag: float = DRAG, pull: float = PULL) -> MissingWrench:
    """The forces of a known line, tied astern and on top, on a vehicle that goes to and fro 30 m below the surface and turns."""
    t = np.arange(0.25, 300.0, 0.5).reshape(30, 2, 10)
    place = np.stack([15.0 * np.sin(t / 17.0), 12.0 * np.cos(t / 29.0), 30.0 + np.sin(t / 23.0)], axis=-1)
    rotation = rotation_from_euler(np.stack([0.05 * np.sin(t), 0.05 * np.cos(t), t / 23.0], axis=-1))
    over_ground = np.stack([15.0 / 17.0 * np.cos(t / 17.0), -12.0 / 29.0 * np.sin(t / 29.0), np.cos(t / 23.0) / 23.0], axis=-1)
    velocity = np.concatenate([np.einsum("whtij,whti->whtj", rotation, over_ground), np.broadcast_to([0.0, 0.0, 1.0 / 23.0], place.shape)], axis=-1)
    to = POINT - place - rotation @ TIE
    way = to / np.linalg.norm(to, axis=-1, keepdims=True)
    moving = over_ground + np.einsum("whtij,whtj->whti", rotation, np.cross(velocity[..., 3:], TIE))
    across = moving - (moving * way).sum(axis=-1, keepdims=True) * way
    force = pull * way - drag * np.linalg.norm(across, axis=-1, keepdims=True) * across + np.array([0.0, 0.0, WEIGHT])
    mean = np.einsum("whtij,whti->whj", rotation, force) / t.shape[-1]
    wrench = np.concatenate([mean, np.cross(TIE, mean)], axis=-1).reshape(30, 12)
    shape = rng.normal(size=(30, 12, 12))
    A = shape @ shape.swapaxes(1, 2)
    return MissingWrench(A, np.einsum("wij,wj->wi", A, wrench), t, place, rotation, velocity)


def test_a_line_is_found_in_the_forces_that_are_missing():
    found = towed_line(lacking(np.random.default_rng(3)))
    assert found is not None
    place: Array = np.array([found[name] for name in ("north", "east", "down")])
    np.testing.assert_allclose(place, POINT, atol=0.5)
    want = {"x": TIE[0], "z": TIE[2], "coefficient": DRAG, "weight": WEIGHT, "pull": PULL}
    assert {name: found[name] for name in want} == pytest.approx(want, rel=0.1, abs=0.1)


def test_no_line_drives_the_vehicle_and_none_pushes():
    lack = lacking(np.random.default_rng(4))
    assert explained(replace(lack, b=-lack.b), POINT, TIE)[0] == 0.0
    reduction, (drag, _, pull) = explained(lacking(np.random.default_rng(4), pull=-PULL), POINT, TIE)
    assert reduction > 0.0 and drag > 0.0 and pull == 0.0


@pytest.mark.parametrize("pull", [20.0, 0.0])
def test_the_drag_of_a_tether_is_searched_from_the_line_too(pull: float):
    """Towards its point, as strong as it pulls there, and strong enough to tell a direction."""
    parts, _ = cut([own((), 5, 200.0)], merlin(), "fossen", 10.0)
    line = {"north": 30.0, "east": 40.0, "down": 25.0, "x": -0.8, "z": -0.2, "coefficient": 90.0, "weight": 5.0, "pull": pull}
    [begun] = [h for h in hypotheses(parts, hints=Hints(line=line))[0] if h.label == "tether_drag@line"]
    at = {parts[0].plant.slots[s].parameter.name: value for s, value in begun.at}
    to = np.array([30.0, 40.0, 25.0 - at["depth"]])
    far = float(np.linalg.norm(to))
    assert np.array([at["north"], at["east"], at["down"]]) == pytest.approx(max(pull, LEAST_PULL) * to / far)
    assert at["nearness"] == pytest.approx(1.0 / far)
    assert {name: at[name] for name in ("coefficient", "weight", "x", "z")} == {"coefficient": 90.0, "weight": 5.0, "x": -0.8, "z": -0.2}


@pytest.mark.slow
def test_a_tether_that_is_dragged_past_its_point_is_named_with_its_drag():
    """A line to a point 15 m off, on a flight of some tens of metres: which way it brakes turns along the log."""
    setting = "tether_drag:coefficient=150,north=15,east=-6,down=-12,nearness=0.06,depth=10,weight=8,x=-0.9,z=-0.4"
    document = diagnose([own((setting,), 7, 240.0)], merlin()).document()
    assert [c["effect"] for c in document["causes"]] == ["tether_drag"], document["sentence"]
    assert document["causes"][0]["parameters"]["coefficient"]["value"] == pytest.approx(150.0, rel=0.2)
