"""Dependence: what a size may go with, and that a size which goes with nothing is said to."""

from __future__ import annotations

import numpy as np
import pytest
from diagnose_case import merlin, own, posed

from rovval.diagnose.inference.map_fit import map_fit
from rovval.diagnose.search.dependence import covariates, dependence
from rovval.diagnose.windows.multiple_shooting import cut


def test_covariates_are_of_one_scale_over_all_runs():
    runs, _ = cut([own(), own((), 7)], merlin(), "fossen", 10.0)
    found = covariates(runs)
    assert len(found) == 2 and set(found[0]) == set(found[1]) > {"u", "|u|", "depth", "time", "thrusters' speed"}
    for name in found[0]:
        inside = [one[name][w.samples().reshape(-1)] for one, w in zip(found, runs, strict=True)]
        values = np.concatenate(inside)
        assert values.mean() == pytest.approx(0.0, abs=1e-9) and values.std() == pytest.approx(1.0)


def test_a_size_that_is_one_all_through_speaks_against_every_covariate():
    problem, library = posed(("quadratic_drag[surge]:scale=1.0",))
    h = next(h for h in library if h.name == "quadratic_drag[surge]")
    found = dependence(problem, map_fit(problem, problem.origin, h.slots), [h])
    assert found is not None and {effect for effect, _ in found.names} == {h.name}
    assert found.alone(0.8).max() < 0.0


def test_nothing_goes_with_anything_without_causes():
    problem, _ = posed()
    assert dependence(problem, map_fit(problem, problem.origin, ()), ()) is None


def test_a_cause_is_not_held_to_one_size_along_what_it_is_placed_in():
    problem, library = posed()
    some = [h for h in library if h.name in ("density_gradient", "buoyancy_drift", "linear_drag[surge]")]
    found = dependence(problem, map_fit(problem, problem.origin, tuple(s for h in some for s in h.slots)), some)
    assert found is not None
    asked = {name: {c for effect, c in found.names if effect == name} for name in ("density_gradient", "buoyancy_drift", "linear_drag[surge]")}
    assert asked["linear_drag[surge]"] - asked["density_gradient"] == {"depth"} and asked["linear_drag[surge]"] - asked["buoyancy_drift"] == {"time"}
