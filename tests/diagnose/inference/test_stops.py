"""A simulation that stops: a step away it costs its own slope there and nothing else, at the point itself the window costs what it errs."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from diagnose_case import merlin, own

from rovval.core.data import Array
from rovval.core.errors import BadInput
from rovval.diagnose.inference.map_fit import map_fit
from rovval.diagnose.problem.problem import pose
from rovval.diagnose.residuals import sensitivities as engine
from rovval.diagnose.residuals.perturbations import Columns
from rovval.diagnose.residuals.sensitivities import linearise
from rovval.diagnose.windows.multiple_shooting import cut_run
from rovval.diagnose.windows.windows import Windows


@pytest.fixture(scope="module")
def part() -> Windows:
    return cut_run(own(("buoyancy_error:force=60",), 5, 120.0), merlin(), "fossen", 10.0)


def stopping(monkeypatch: pytest.MonkeyPatch, stops: Any) -> None:
    """The simulations of which ``stops(beta, nu0, windows)`` (b,) is true hold their first state and say that they stopped."""
    run = engine.simulate_windows

    def held(stretches: Windows, beta: Array, nu0: Array, eta0: Array, which: np.ndarray) -> tuple[Array, np.ndarray]:
        out, fine = run(stretches, beta, nu0, eta0, which)
        bad = stops(beta, nu0, which)
        out[bad] = out[bad][:, :1]
        return out, fine & ~bad

    monkeypatch.setattr(engine, "simulate_windows", held)


def buoyancy(part: Windows) -> int:
    return next(i for i, s in enumerate(part.plant.slots) if s.key == "buoyancy_error.force")


def test_a_step_away_it_costs_its_own_slope_only(part, monkeypatch):
    force, drag = buoyancy(part), next(i for i, s in enumerate(part.plant.slots) if s.key == "quadratic_drag[surge].scale")
    whole = linearise(part, part.plant.null, (force, drag))
    stopping(monkeypatch, lambda beta, nu0, which: (which == 3) & (beta[:, force] > 0))
    got = linearise(part, part.plant.null, (force, drag))
    assert got.valid.all()
    assert not got.S[3, ..., 0].any()
    others = np.arange(part.count) != 3
    np.testing.assert_array_equal(got.S[others], whole.S[others])
    for same in ("r", "J"):
        np.testing.assert_array_equal(getattr(got, same), getattr(whole, same))
    np.testing.assert_array_equal(got.S[..., 1], whole.S[..., 1])


def test_at_the_point_the_window_costs_what_it_errs_and_is_fitted_out_of(part, monkeypatch):
    """A window never counts less for having stopped: who looks for the cause would be led to where the simulation breaks down."""
    force = buoyancy(part)
    problem = pose((part,), Columns(), 0.05)
    stopping(monkeypatch, lambda beta, nu0, which: (which == 3) & (beta[:, force] < 5.0))
    start = problem.origin.copy()
    start[force] = 0.1
    one = linearise(part, start, (force,))
    assert not one.valid[3] and not one.S[3].any() and not one.J[3].any() and np.abs(one.r[3]).max() > 0.05
    reached = map_fit(problem, start, (force,))
    assert reached.beta[force] == pytest.approx(60.0, abs=8.0)
    assert all(linear.valid.all() for linear in reached.linear)


def test_windows_in_which_the_vehicle_itself_stops_are_not_compared_and_said(part, monkeypatch):
    stopping(monkeypatch, lambda beta, nu0, which: which == 3)
    problem = pose((part,), Columns(), 0.05)
    assert problem.runs[0].stopped == 1 and not problem.runs[0].ok[3].any()
    assert problem.gap.dynamics.c[3] == 0.0 and (np.delete(problem.gap.dynamics.c, 3) > 0.0).all()
    stopping(monkeypatch, lambda beta, nu0, which: which > 1)
    with pytest.raises(BadInput, match="the simulation stops in 10 of 12 windows, at least 3 have to run"):
        pose((part,), Columns(), 0.05)
