"""The prior: tolerances under an autopilot."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from diagnose_case import LIBRARY, logged, merlin, own

from rovval import vehicle
from rovval.blind.plant.spec import Planted
from rovval.blind.second.flight import fly
from rovval.diagnose import diagnose
from rovval.diagnose.problem.prior import loosened_by_closed_loop, prior_mean, tolerance_prior
from rovval.diagnose.windows.multiple_shooting import cut
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
    assert by_key["linear_drag[roll].scale"] == pytest.approx(16.0) and by_key["quadratic_drag[roll].scale"] == pytest.approx(4.0)
    assert replace(tight).sd == tolerance_prior(plant, 0.05).sd, "nothing was changed in place"


def test_a_depth_is_expected_where_the_log_was_and_a_bottom_below_it():
    """All else is expected to be as the file has it."""
    run = own((), 5, 100.0)
    parts, _ = cut([run], merlin(), "fossen", 10.0)
    mean = {s.key: prior_mean(s.parameter, parts, s.parameter.null) for s in parts[0].plant.slots}
    z = run.get("z")
    assert mean["density_gradient.depth"] == mean["tether_tension.depth"] == pytest.approx(float(np.median(z)))
    assert 0.5 < mean["ground_effect.seabed"] - z.max() < 2.0
    others = [s for s in parts[0].plant.slots if s.parameter.role not in ("datum", "level", "bottom")]
    assert all(mean[s.key] == s.parameter.null for s in others)


@pytest.mark.slow
def test_a_change_with_depth_is_expected_to_be_zero_near_the_depths_of_the_log(tmp_path: Path):
    """A log of plant b, from a set that was opened: with any depth as good as another the vertical thrusters had been blamed for it (0.98)."""
    flight = fly(LIBRARY / "merlin.toml", "square", [Planted("density_gradient", None, 2.126)], 1626879146, 300.0, 0.05)
    found = diagnose([logged(flight, tmp_path / "log.csv")], merlin())
    assert [c.effect for c in found.causes] == ["density_gradient"]
    z = flight.measured["Depth"]
    assert z.min() - 1.0 < found.causes[0].parameters["depth"].value < z.max() + 1.0
