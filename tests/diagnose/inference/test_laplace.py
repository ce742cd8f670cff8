"""Laplace evidence."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from diagnose_case import posed, slot
from scipy.optimize import lsq_linear

from rovval.diagnose.inference.laplace import resampled_evidence
from rovval.diagnose.inference.map_fit import map_fit


def test_evidence_is_linear_in_copies_of_the_log_but_for_the_prior():
    p = posed(("inflow_loss:loss=0.3",), seconds=100.0)[0]
    point = map_fit(p, p.origin, ())
    one, two = resampled_evidence(p, point, np.stack([np.ones(p.window_count), 2 * np.ones(p.window_count)]))
    assert two > one, "twice the data says the same louder"


def test_two_parameters_that_do_the_same_are_seen_together_only():
    """The downward part of a pull from far away and the weight of its line are one force; its northward part is another."""
    p = posed(seconds=100.0)[0]
    slots = tuple(slot(p, f"tether_tension.{name}") for name in ("north", "down", "weight"))
    beta = p.origin.copy()
    beta[list(slots)] = 5.0, 5.0, 1.0
    correlation = map_fit(p, beta, slots).effect_correlation()
    assert np.diag(correlation) == pytest.approx(np.ones(3)) and correlation == pytest.approx(correlation.T, abs=1e-6)
    assert correlation[1, 2] < -0.9
    assert abs(correlation[0, 1]) < 0.7 and abs(correlation[0, 2]) < 0.7


def test_a_step_leaves_no_bound_and_is_the_best_that_does_not():
    """Beside bounded least squares of SciPy; a slope into the allowed side alone does not say which way a column goes beside the others."""
    p, rng = posed(seconds=60.0)[0], np.random.default_rng(4)
    point = map_fit(p, p.origin, ())
    k = len(point.columns)
    for _ in range(20):
        root, slope, side = rng.normal(size=(k + 3, k)), rng.normal(size=k), rng.choice([-1.0, 0.0, 0.0, 1.0], k)
        step = replace(point, bound_side=side).solve(root.T @ root, slope)
        low, high = np.where(side < 0, 0.0, -np.inf), np.where(side > 0, 0.0, np.inf)
        best = lsq_linear(root, np.linalg.lstsq(root.T, slope, rcond=None)[0], (low, high), method="bvls").x
        assert step == pytest.approx(best, abs=1e-6)
