"""Normal equations and whitened linearisations against the full covariance."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rovval.core.data import Array
from rovval.diagnose.residuals.normal_equations import (
    Linearisation,
    gathered,
    normal_equations,
    nuisance_corrected,
    whiten,
    with_frozen_columns,
)


def random_linear(seed: int = 0, m: int = 6, n: int = 9, c: int = 3, k: int = 4, s: int = 2) -> tuple[Linearisation, np.ndarray, Array, Array]:
    rng = np.random.default_rng(seed)
    linear = Linearisation(
        rng.normal(size=(m, n, c)), rng.normal(size=(m, n, c, k)), rng.normal(size=(m, n, c, s)), tuple(range(10, 10 + k)), np.ones(m, dtype=bool)
    )
    return linear, rng.random((m, n, c)) > 0.2, rng.uniform(0.5, 2, (n, c)), rng.uniform(0.1, 3, s)


def test_products_are_the_inner_products_of_the_full_covariance():
    """A, b, c with V = diag(variance) + J Sigma J^T inverted as a whole over the samples that hold a value."""
    linear, ok, variance, spread = random_linear()
    got = normal_equations(linear, ok, variance, spread)
    for w in range(len(ok)):
        keep = ok[w].ravel()
        J, S, r = (x[w].reshape(keep.size, -1)[keep] for x in (linear.J, linear.S, linear.r))
        V = np.diag(variance.ravel()[keep]) + (J * spread**2) @ J.T
        weighed = np.linalg.solve(V, np.concatenate([S, r], axis=1))
        np.testing.assert_allclose(got.A[w], S.T @ weighed[:, :-1], rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(got.b[w], S.T @ weighed[:, -1], rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(got.c[w], (r.T @ weighed[:, -1:])[0, 0], rtol=1e-9)


def test_slopes_that_stand_still_give_the_same_products():
    """Own columns beside those of a linearisation nearby, in its metric, with another residual: as if all were made anew; a window that stops
    there has no slopes, its nuisances with them, and costs what it errs."""
    near, ok, variance, spread = random_linear(3)
    own = replace(random_linear(4, k=2)[0], columns=(11, 3), valid=np.arange(6) != 4)
    own.S[4] = 0.0
    got = with_frozen_columns(own, whiten(near, ok, variance, spread), (13, 10))
    S, J = np.concatenate([own.S, near.S[..., [3, 0]]], axis=-1), near.J.copy()
    S[4], J[4] = 0.0, 0.0
    whole = Linearisation(own.r, S, J, (11, 3, 13, 10), own.valid)
    want, there = normal_equations(whole, ok, variance, spread), got.normal_equations(own.r)
    assert there.columns == want.columns
    np.testing.assert_allclose(got.linear.S, S * ok[..., None], rtol=1e-12)
    assert there.c[4] == pytest.approx(((own.r[4] ** 2 / variance) * ok[4]).sum())
    for one, other in ((there.A, want.A), (there.b, want.b), (there.c, want.c)):
        np.testing.assert_allclose(one, other, rtol=1e-9, atol=1e-9)
    other_r = np.random.default_rng(5).normal(size=own.r.shape)
    moved = normal_equations(replace(whole, r=other_r), ok, variance, spread)
    np.testing.assert_allclose(got.normal_equations(other_r).b, moved.b, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(got.normal_equations(other_r).c, moved.c, rtol=1e-9, atol=1e-9)


def test_sums_of_groups_further_columns_and_a_few_windows_at_a_time_are_the_same_products():
    linear, ok, variance, spread = random_linear(6)
    whole = normal_equations(linear, ok, variance, spread)
    first, more = replace(linear, S=linear.S[..., :2], columns=linear.columns[:2]), replace(linear, S=linear.S[..., 2:], columns=linear.columns[2:])
    held = np.array([np.arange(len(ok)) % 2 == 0, np.arange(len(ok)) % 2 == 1])
    grouped = normal_equations(first, ok, variance, spread, more, held)
    assert grouped.columns == whole.columns
    again = gathered((whole.part(slice(w, w + 1)) for w in range(len(ok))), len(ok))
    for name in ("A", "b", "c"):
        one, sums, at_once = (getattr(data, name) for data in (whole, grouped, again))
        np.testing.assert_allclose(sums, np.stack([one[which].sum(axis=0) for which in held]), rtol=1e-9, atol=1e-9)
        np.testing.assert_array_equal(at_once, one)


def test_a_step_leaves_what_the_sensitivities_leave():
    near, ok, variance, spread = random_linear(7)
    near = replace(near, r=np.where(ok, near.r, 0.0), valid=np.arange(len(ok)) != 2)
    step = np.random.default_rng(8).normal(size=len(near.columns))
    white, want = whiten(near, ok, variance, spread), near.r - np.where((ok & near.valid[:, None, None]), near.S @ step, 0.0)
    np.testing.assert_allclose(white.after(step).r, want, rtol=1e-9, atol=1e-9)
    moved, anew = normal_equations(near, ok, variance, spread).after(step), normal_equations(replace(near, r=near.r - near.S @ step), ok, variance, spread)
    np.testing.assert_allclose(moved.b, anew.b, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(moved.c, anew.c, rtol=1e-9, atol=1e-9)


def test_start_states_are_taken_out_as_ridge_regression_does():
    linear, ok, variance, spread = random_linear(1)
    got = nuisance_corrected(linear, ok, variance, spread)
    root = (np.where(ok, 1.0, 0.0) / np.sqrt(variance)).reshape(len(ok), -1)
    for w in range(len(ok)):
        J, r = linear.J[w].reshape(root.shape[1], -1), linear.r[w].ravel()
        stacked = np.concatenate([J * root[w][:, None], np.diag(1 / spread)])
        x = np.linalg.lstsq(stacked, np.concatenate([r * root[w], np.zeros(len(spread))]), rcond=None)[0]
        np.testing.assert_allclose(got[w], np.where(ok[w], (r - J @ x).reshape(ok[w].shape), 0.0), atol=1e-9)
