"""Coherence of hypotheses."""

from __future__ import annotations

import numpy as np
import pytest

from rovval.diagnose.residuals.coherence import coherence
from rovval.diagnose.residuals.normal_equations import (
    NormalEquations,
)


def test_coherence_knows_the_same_and_the_foreign():
    x = np.random.default_rng(3).normal(size=(200, 3))
    S = np.concatenate([x, x[:, :1] * 2], axis=1)[None]
    data = NormalEquations(np.einsum("wni,wnj->wij", S, S), np.zeros((1, 4)), np.zeros(1), (0, 1, 2, 3))
    assert coherence(data, (0,), (3,)) == pytest.approx(1.0)
    assert coherence(data, (0,), (1,)) == pytest.approx(abs(float(np.asarray(np.corrcoef(x.T))[0, 1])), abs=0.05)
    assert coherence(data, (0, 1), (1, 2)) == pytest.approx(1.0)
