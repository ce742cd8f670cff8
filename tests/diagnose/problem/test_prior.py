"""The prior: tolerances under an autopilot."""

from __future__ import annotations

from dataclasses import replace

import pytest

from rovval import vehicle
from rovval.diagnose.problem.prior import loosened_by_closed_loop, tolerance_prior
from rovval.plant import Plant


def test_only_what_turns_about_a_steadied_axis_is_loosened():
    plant = Plant(vehicle.load("bluerov2_heavy"), "fossen")
    tight = tolerance_prior(plant, 0.05)
    loose = loosened_by_closed_loop(tight, plant, {"roll": 3.0, "pitch": 0.0})
    wider = {plant.slots[s].key for s in tight.sd if loose.sd[s] > tight.sd[s]}
    assert wider == {f"{e}[roll].scale" for e in ("linear_drag", "quadratic_drag", "added_mass", "inertia_error")} | {
        f"cg_offset.{x}" for x in "xyz"
    }
    by_key = {plant.slots[s].key: loose.sd[s] / tight.sd[s] for s in tight.sd}
    assert by_key["cg_offset.z"] == pytest.approx(4.0) and by_key["cg_offset.x"] == by_key["cg_offset.y"] == pytest.approx(2.0)
    assert replace(tight).sd == tolerance_prior(plant, 0.05).sd, "nothing was changed in place"
