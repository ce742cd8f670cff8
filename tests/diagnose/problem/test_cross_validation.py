"""Cross-validation: folds, and ridge fits that are scored on what they did not see."""

from __future__ import annotations

import numpy as np
import pytest

from rovval.core.data import Array
from rovval.diagnose.criteria import HELD_OUT_BLOCK
from rovval.diagnose.problem.cross_validation import (
    Fold,
    by_fold,
    compare_held_out,
    cross_validate,
    make_folds,
)
from rovval.diagnose.residuals.normal_equations import NormalEquations
from rovval.diagnose.residuals.ridge import Prior


def test_folds_leave_nothing_to_extrapolate_in_a_long_log():
    folds = make_folds(np.zeros(30, dtype=int))
    tests = np.stack([f.test for f in folds])
    assert (tests.sum(axis=0) == 1).all() and len(folds) == 5
    for fold in folds:
        held = np.flatnonzero(fold.test)
        assert (np.diff(held.reshape(-1, HELD_OUT_BLOCK), axis=1) == 1).all(), "neighbours go together"
    assert [np.flatnonzero(f.test).tolist() for f in make_folds(np.zeros(5, dtype=int))] == [[i] for i in range(5)]


def test_held_out_loss_is_that_of_ridge_regression_on_held_out_windows():
    rng, m, n, k, design_effect = np.random.default_rng(2), 10, 12, 5, 3.0
    S, r = rng.normal(size=(m, n, k)), rng.normal(size=(m, n))
    data = NormalEquations(np.einsum("wni,wnj->wij", S, S), np.einsum("wni,wn->wi", S, r), (r**2).sum(axis=1), tuple(range(k)))
    folds, prior = make_folds(np.zeros(m, dtype=int)), Prior({1: 0.5, 3: 2.0})

    def brute(train: np.ndarray) -> Array:
        X = np.concatenate([S[train][:, :, [1, 3]].reshape(-1, 2), np.sqrt(design_effect) * np.diag([2.0, 0.5])])
        return np.asarray(np.linalg.lstsq(X, np.concatenate([r[train].ravel(), [0, 0]]), rcond=None)[0])

    held = sum(((r[f.test] - S[f.test][:, :, [1, 3]] @ brute(f.train)) ** 2).sum() for f in folds)
    sums = by_fold(data, folds)
    base, named = compare_held_out(sums, Prior({1: 0.5}), {"both": Prior({3: 2.0})}, design_effect)
    assert named["both"].loss == pytest.approx(held)
    assert base.loss == pytest.approx(cross_validate(sums, Prior({1: 0.5}), design_effect).loss)
    assert cross_validate(sums, prior, design_effect).loss == pytest.approx(held)
    np.testing.assert_allclose(named["both"].step[[1, 3]], brute(np.ones(m, dtype=bool)))


def test_folds_hold_logs_out_where_there_are_enough():
    def tests(folds: tuple[Fold, ...]) -> list[list[int]]:
        return [np.flatnonzero(f.test).tolist() for f in folds]

    assert tests(make_folds(np.array([0, 0, 1, 1, 2]))) == [[0, 1], [2, 3], [4]]
    assert tests(make_folds(np.zeros(6, dtype=int))) == [[0, 1], [2], [3], [4], [5]]
    assert all(not (f.train & f.test).any() and (f.train | f.test).all() for f in make_folds(np.zeros(7, dtype=int)))
