"""Laplace evidence."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from diagnose_case import posed, slot
from scipy.linalg import block_diag
from scipy.optimize import lsq_linear

from rovval.diagnose.inference.laplace import resampled_evidence
from rovval.diagnose.inference.map_fit import map_fit
from rovval.diagnose.residuals.normal_equations import NormalEquations


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


def test_what_is_beyond_tolerance_is_told_from_what_tolerance_does():
    """Beside the posterior of both as numbers of their own: an effect's parameter is off by its tolerance, which goes with two others', and by the effect."""
    p, rng = posed(seconds=60.0)[0], np.random.default_rng(4)
    point, wide, tempering = map_fit(p, p.origin, ()), 1.5, 4.0
    for _ in range(5):
        ways, seen = rng.normal(size=(2, 3, 3))
        tolerance, A, slope = ways @ ways.T, tempering * seen @ seen.T, tempering * rng.normal(size=3)
        prior = np.asarray(tempering * np.linalg.inv(tolerance + np.diag([wide**2, 0.0, 0.0])), dtype=np.float64)
        data = NormalEquations(A[None], slope[None], np.zeros(1), point.columns[:3])
        found = replace(
            point, columns=point.columns[:3], effect_count=1, total=data, precision=prior, tempering=tempering, departure=np.zeros(3), bound_side=np.zeros(3),
        )  # fmt: skip
        apart = np.array([[1.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]])  # the effect, and what tolerance has each number off by
        known = np.linalg.inv(block_diag(1.0 / wide**2, np.linalg.inv(tolerance)) + apart.T @ A @ apart / tempering)
        size, sd = found.effect_beyond_tolerance(np.array([wide]))
        assert size[0] == pytest.approx((known @ apart.T @ slope / tempering)[0]) and sd[0] == pytest.approx(np.sqrt(known[0, 0]))


def test_an_effect_where_all_else_is_as_filed_is_without_what_goes_with_the_others():
    p = posed(seconds=60.0)[0]
    point = map_fit(p, p.origin, (slot(p, "rpm_scale.scale"),))
    k = len(point.columns)
    assert point.effects_given_others() == pytest.approx(np.eye(1, k)), "by itself, where tolerances are independent"
    covariance = np.eye(k)
    covariance[0, 1] = covariance[1, 0] = 0.5
    given = replace(point, precision=np.asarray(np.linalg.inv(covariance), dtype=np.float64)).effects_given_others()
    assert given == pytest.approx(np.eye(1, k) - 0.5 * np.eye(1, k, 1))
