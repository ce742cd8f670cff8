"""Cross-validation: folds."""

from __future__ import annotations

import numpy as np

from rovval.diagnose.criteria import HELD_OUT_BLOCK
from rovval.diagnose.problem.cross_validation import make_folds


def test_folds_leave_nothing_to_extrapolate_in_a_long_log():
    folds = make_folds(np.zeros(30, dtype=int))
    tests = np.stack([f.test for f in folds])
    assert (tests.sum(axis=0) == 1).all() and len(folds) == 5
    for fold in folds:
        held = np.flatnonzero(fold.test)
        assert (np.diff(held.reshape(-1, HELD_OUT_BLOCK), axis=1) == 1).all(), "neighbours go together"
    assert [np.flatnonzero(f.test).tolist() for f in make_folds(np.zeros(5, dtype=int))] == [[i] for i in range(5)]
