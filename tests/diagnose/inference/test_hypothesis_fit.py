"""Fits of hypotheses: errors on a bound and of parameters that only place an effect."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from diagnose_case import posed, slot

from rovval.diagnose.inference.hypothesis_fit import fit_hypothesis, standard_errors


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
    north, phase, period = (slot(p, f"current_varying.{name}") for name in ("north", "phase", "period"))
    beta = p.origin.copy()
    beta[[north, phase, period]] = 0.1, 0.4, 60.0
    fitted = fit_hypothesis(p, beta, (north, phase, period))
    free, fixed = standard_errors(p, fitted), standard_errors(p, fitted, (phase, period))
    assert (fixed[1:] == 0.0).all() and 0.0 < fixed[0] <= free[0]
