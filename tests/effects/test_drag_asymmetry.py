"""Drag that differs ahead and astern."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from diagnose_case import foreign, merlin, own

from rovval.diagnose import diagnose
from rovval.plant import Inputs, Plant, parse_settings


def test_as_much_both_ways_is_another_quadratic_drag():
    plant, rng = Plant(merlin()), np.random.default_rng(1)
    nu, eta = rng.normal(size=(8, 6)) * 0.4, np.zeros((8, 6))
    still = Inputs(0.1, np.zeros((30, len(plant.vehicle.thrusters))), hold=False)
    moved = [
        plant.simulate(still, np.zeros(8, int), 20, nu, eta, np.tile(parse_settings(plant, [setting]), (8, 1))).nu
        for setting in ("drag_asymmetry[sway]:positive=0.5,negative=0.5", "quadratic_drag[sway]:scale=0.5")
    ]
    assert moved[0] == pytest.approx(moved[1], abs=1e-12)


@pytest.mark.parametrize(("axis", "column"), [("surge", 0), ("sway", 1), ("heave", 2)])
def test_one_way_only_it_acts_that_way_only(axis: str, column: int):
    plant = Plant(merlin())
    nu = np.zeros((2, 6))
    nu[:, column] = [0.5, -0.5]
    still = Inputs(0.1, np.zeros((12, len(plant.vehicle.thrusters))), hold=False)
    end = [
        plant.simulate(still, np.zeros(2, int), 10, nu, np.zeros((2, 6)), np.tile(beta, (2, 1))).nu[:, -1, column]
        for beta in (plant.null, parse_settings(plant, [f"drag_asymmetry[{axis}]:negative=1.0"]))
    ]
    assert end[1][0] == pytest.approx(end[0][0], rel=1e-6) and abs(end[1][1]) < 0.97 * abs(end[0][1])


@pytest.mark.slow
def test_another_plant_s_net_that_opens_astern_is_named_with_its_side(tmp_path: Path):
    [cause] = diagnose([foreign(tmp_path, (("one_sided_drag", "", 1.3),), 31, 300.0)], merlin()).causes
    assert cause.effect == "drag_asymmetry[surge]" and cause.probability > 0.9
    assert cause.parameters["negative"].value == pytest.approx(1.3, abs=0.3) and cause.parameters["positive"].value == pytest.approx(0.0, abs=0.15)


@pytest.mark.slow
def test_drag_that_is_off_both_ways_is_not_told_as_this():
    assert [c.effect for c in diagnose([own(("quadratic_drag[surge]:scale=0.5",), 3, 300.0)], merlin()).causes] == ["quadratic_drag[surge]"]
