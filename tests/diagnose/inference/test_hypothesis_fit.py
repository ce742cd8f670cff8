"""Fits of hypotheses: what was planted comes back; errors on a bound and of parameters that only place an effect."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from diagnose_case import merlin, own, posed, slot

from rovval.diagnose.hypotheses.hypothesis import columns_of
from rovval.diagnose.hypotheses.library import hypotheses
from rovval.diagnose.inference.hypothesis_fit import fit_hypothesis, standard_errors
from rovval.diagnose.inference.laplace import laplace_evidence
from rovval.diagnose.inference.map_fit import healthy_fit
from rovval.diagnose.problem.problem import pose
from rovval.diagnose.residuals.ridge import Prior
from rovval.diagnose.search.screening import linearised, screened
from rovval.diagnose.windows.multiple_shooting import cut_run


def test_a_drag_that_is_gone_altogether_is_significant_though_it_rests_on_its_bound():
    """The slope that is left on a bound belongs to no window: it widens no interval."""
    p, _ = posed(("linear_drag[sway]:scale=-0.95",))
    where = slot(p, "linear_drag[sway].scale")
    start = p.origin.copy()
    start[where] = -0.95
    fitted = fit_hypothesis(p, start, (where,))
    point, first = fitted.posterior, np.arange(len(fitted.posterior.columns)) == 0
    pushed = replace(point.total, b=point.total.b - first * 0.2 * point.curvature[0, 0])
    on_bound = replace(fitted, posterior=replace(point, total=pushed, bound_side=np.where(first, -1.0, 0.0)))
    assert standard_errors(p, on_bound)[0] < 1.5 * standard_errors(p, fitted)[0]


def test_what_only_places_an_effect_does_not_make_its_size_unsure():
    """Seen from one height, a gain and a height of the ground effect are one number; that it is not nothing is sure all the same."""
    p, _ = posed()
    north, period = (slot(p, f"current_varying.{name}") for name in ("north", "period"))
    beta = p.origin.copy()
    beta[[north, period]] = 0.1, 60.0
    fitted = fit_hypothesis(p, beta, (north, period))
    free, fixed = standard_errors(p, fitted), standard_errors(p, fitted, (period,))
    assert fixed[1] == 0.0 and 0.0 < fixed[0] <= free[0]


@pytest.mark.parametrize(
    ("name", "truth"),
    [
        ("quadratic_drag[surge]", {"scale": 0.4}),
        ("thruster_degraded[HAS]", {"loss": 0.3}),
        ("buoyancy_error", {"force": 60.0}),
        ("inflow_loss", {"loss": 0.25}),
        ("added_mass[translation]", {"scale": 0.8}),
        ("buoyancy_drift", {"rate": 1.0}),
    ],
)
def test_a_fit_recovers_what_was_planted(name, truth):
    setting = f"{name}:" + ",".join(f"{p}={v}" for p, v in truth.items())
    parts = (cut_run(own((setting,), 4, 120.0), merlin(), "fossen", 10.0),)
    library = [h for h in hypotheses(parts)[0] if h.name == name]
    problem = pose(parts, columns_of(library), 0.05)
    done = fit_hypothesis(problem, problem.origin, library[0].slots)
    for own_slot in library[0].slots:
        p = problem.plant.slots[own_slot].parameter
        if p.name in truth:
            assert done.beta[own_slot] == pytest.approx(truth[p.name], abs=0.1 * p.typical)
    assert done.evidence > 20
    assert done.dynamics_loss.sum() < 0.6 * problem.gap.dynamics.c.sum()  # what is left is noise


@pytest.mark.parametrize(("planted", "other"), [("added_mass[translation]", "added_mass[sway]"), ("added_mass[sway]", "added_mass[translation]")])
def test_one_axis_and_several_that_are_off_alike_are_told_apart(planted, other):
    """The one cause leaves the axes' tolerances alone, the other asks for more than they have."""
    parts = (cut_run(own((f"{planted}:scale=0.9",), 4, 120.0), merlin(), "fossen", 10.0),)
    library = [h for h in hypotheses(parts)[0] if h.name in (planted, other)]
    problem = pose(parts, columns_of(library), 0.05)
    evidence = {h.name: fit_hypothesis(problem, problem.origin, h.slots).evidence for h in library}
    assert evidence[planted] > evidence[other] + 20.0


def test_a_number_that_a_calibration_knows_beside_others_only_is_found_and_told_as_if_these_were_right():
    """It knows thrust over drag: both may be off by a half, together, and are off by 0.4 here. What is weaker in this log besides is thrust, by a quarter."""
    drags = [f"{kind}_drag[{axis}]" for kind in ("linear", "quadratic") for axis in ("surge", "sway", "heave", "yaw")]
    p, library = posed(("rpm_scale:scale=0.066", *(f"{drag}:scale=0.4" for drag in drags)), seconds=100.0)
    scale, scaled = slot(p, "rpm_scale.scale"), [slot(p, f"{drag}.scale") for drag in drags]
    alike = np.full((len(scaled) + 1, len(scaled) + 1), 0.999)
    np.fill_diagonal(alike, 1.0)
    calibrated = replace(p, tolerance=Prior(dict(p.tolerance.sd) | {scale: 0.3} | dict.fromkeys(scaled, 0.6), (scale, *scaled), alike))
    healthy = healthy_fit(calibrated)
    found = fit_hypothesis(calibrated, healthy.beta, (scale,))
    assert found.posterior.beta[scale] == pytest.approx(0.066, abs=0.02)
    assert found.beta[scale] == pytest.approx(-0.134, abs=0.03)
    assert found.evidence > laplace_evidence(calibrated, healthy) + 6.0
    weaker = [h for h in library if h.name == "rpm_scale"]
    assert screened(calibrated, linearised(calibrated, weaker, healthy), weaker, ())["rpm_scale"] > 6.0
