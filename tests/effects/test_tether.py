"""The pull of a tether: towards a point, from any depth, and as part of a tether that is dragged along."""

from __future__ import annotations

import numpy as np
import plant_cases as cases
import pytest

from rovval.core.data import Array
from rovval.effects.library import tether_drag
from rovval.plant import Inputs, Plant, parse_settings


def begun(setting: str, place: tuple[float, float, float]) -> Array:
    """Velocity (6,) of a Merlin after a tenth of a second from rest, heading north at ``place``, less that of one without the effect."""
    plant, zero, eta = Plant(cases.merlin()), np.zeros((2, 6)), np.zeros((2, 6))
    eta[:, :3] = place
    beta = np.array([parse_settings(plant, settings) for settings in ([setting], [])])
    out = plant.simulate(Inputs(0.1, np.zeros((2, 7)), False), np.zeros(2, dtype=int), 1, zero, eta, beta)
    return np.asarray(out.nu[0, 1] - out.nu[1, 1])


def test_a_pull_leads_to_its_point_from_any_depth():
    """The point is 20 m north of the log's origin at a depth of 250 m: from 20 m east of it the pull leads north and west alike, and no way up or down."""
    here = begun("tether_tension:north=300,nearness=0.05,depth=250", (0.0, 0.0, 250.0))
    assert here[0] > 0 and np.abs(here[1:3]).max() < 1e-3 * here[0]
    aside = begun("tether_tension:north=300,nearness=0.05,depth=250", (10.0, 10.0, 250.0))
    assert aside[1] < 0 < aside[0] and abs(aside[2]) < 1e-3 * aside[0]
    alike = begun("tether_tension:north=300,east=-300", (0.0, 0.0, 250.0)) / np.sqrt(2.0)
    np.testing.assert_allclose(aside[:3], alike[:3], atol=1e-6)


def test_within_its_slack_a_line_pulls_less_and_far_outside_as_without():
    """Origin 20 m from the point and 20 m deep; the pull is 300 N."""
    setting = "tether_tension:north=300,nearness=0.05,depth=20"
    far, near, at = (10000.0 * np.array([-1.0, 0.0, 0.0]) + [0.0, 0.0, 20.0], np.array([18.0, 0.0, 20.0]), np.array([20.0, 0.0, 20.0]))
    for place, share in ((far, 1.0), (near, 2.0 / np.hypot(2.0, 4.0)), (at, 0.0)):
        np.testing.assert_allclose(begun(f"{setting},slack=4", tuple(place)), share * begun(setting, (0.0, 0.0, 20.0)), rtol=0, atol=1e-5)


def test_the_pull_of_a_tether_that_is_dragged_is_a_steady_pull_at_its_attachment():
    pull = "north=200,east=-80,down=60,nearness=0.03,depth=28,x=-0.7,z=-0.4"
    at_rest = begun(f"tether_drag:{pull}", (3.0, 4.0, 30.0))
    np.testing.assert_allclose(at_rest, begun(f"tether_tension:{pull}", (3.0, 4.0, 30.0)), rtol=0, atol=1e-9)
    assert begun(f"tether_drag:coefficient=800,{pull}", (3.0, 4.0, 30.0))[0] == pytest.approx(at_rest[0], rel=0.02)


def drag_of(v: Array, pull: Array, nearness: float = 0.0, place: tuple[float, float, float] = (0.0, 0.0, 0.0), weight: float = 0.0) -> Array:
    """Force (3,) of a tether of 100 N s2/m2 at a level vehicle at ``place`` (m) that moves with ``v`` (3,), with its ``pull`` (3,) at the origin."""
    asked = (100.0, 0.0, *pull, nearness, 0.0, weight, 0.0, 0.0, 0.0, *place, *v, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
    return np.array(tether_drag.wrench(*asked)[:3])


def test_a_tether_drags_across_the_line_and_hardly_along_it():
    """Morison: |F| = c |v'|^2 against v', the velocity across the line; along a line that pulls with 60 N next to nothing."""
    pull, along = np.array([36.0, 0.0, -48.0]), np.array([0.6, 0.0, -0.8])
    assert np.abs(drag_of(along, pull) - pull).max() < 0.03
    sideways = np.array([0.8, 0.0, 0.6])
    np.testing.assert_allclose(drag_of(0.5 * sideways, pull) - pull, -25.0 * sideways, rtol=1e-9)
    np.testing.assert_allclose(drag_of(0.5 * sideways + 2.0 * along, pull) - pull, -25.0 * sideways, rtol=2e-3, atol=1e-2)


def test_a_line_that_leads_to_a_point_pushes_a_vehicle_aside_that_passes_it():
    """The point is 10 m north of the origin: 10 m east of there the line leads north-west, so that a vehicle that goes north with 1 m/s is dragged by
    c sin 45 of the speed across the line, south and west alike."""
    force = drag_of(np.array([1.0, 0.0, 0.0]), np.array([30.0, 0.0, 0.0]), nearness=0.1, place=(0.0, 10.0, 0.0))
    line = 30.0 * np.array([1.0, -1.0, 0.0]) / np.sqrt(2.0)
    np.testing.assert_allclose(force - line, 100.0 * np.sqrt(0.5) * np.array([-0.5, -0.5, 0.0]), rtol=2e-3, atol=1e-9)


def test_a_tether_of_no_direction_drags_alike_whichever_way_it_moves_and_hangs_down_by_its_weight():
    rng = np.random.default_rng(47)
    for v in rng.normal(size=(20, 3)):
        like = -100.0 * np.linalg.norm(v) * v
        np.testing.assert_allclose(drag_of(v, np.zeros(3)), like, rtol=1e-12)
        np.testing.assert_allclose(drag_of(v, np.zeros(3), weight=8.0), like + np.array([0.0, 0.0, 8.0]), rtol=1e-12)
