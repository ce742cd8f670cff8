"""Sparse regression, the simple method beside which the engine is scored."""

from __future__ import annotations

import numpy as np
import pytest

from rovval.blind.baselines import stlsq
from rovval.blind.plant.spec import AXES
from rovval.blind.planted.catalogue import names


def sparse_case() -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(3)
    x = rng.standard_normal((400, 12))
    return x, 1.5 * x[:, 2] - 0.7 * x[:, 9] + 0.05 * rng.standard_normal(400)


def test_sparse_regression_finds_the_terms():
    x, y = sparse_case()
    assert np.flatnonzero(stlsq.stlsq(x, y)).tolist() == [2, 9]
    assert not stlsq.stlsq(x, 0.01 * y).any()


@pytest.mark.parametrize(
    ("threshold", "ridge", "theirs"),
    [
        (0.1, 0.05, {2: 1.499706563758, 4: 0.130038171903, 6: -0.699970675321}),
        (0.3, 30.0, {2: 1.349825642808, 6: -0.563780217738}),
    ],
)
def test_sparse_regression_is_that_of_pysindy(threshold, ridge, theirs):
    """Coefficients of `pysindy.STLSQ(threshold, alpha=ridge, unbias=False)`, PySINDy 2.1.0, of terms that resemble one another."""
    k = np.arange(400)
    x = np.stack([np.sin((0.3 + 0.11 * j) * k + j) + 0.6 * np.sin(0.05 * k) for j in range(8)], axis=1)
    y = 1.5 * x[:, 2] - 0.7 * x[:, 6] + 0.13 * x[:, 4] + 0.05 * np.cos(1.7 * k**1.1)
    want = np.zeros(8)
    want[list(theirs)] = list(theirs.values())
    np.testing.assert_allclose(stlsq.stlsq(x, y, threshold, ridge), want, atol=1e-8)


@pytest.mark.parametrize(
    ("axis", "term", "expected"),
    [
        ("heave", "constant", "buoyancy_error"),
        ("surge", "u|u|", "quadratic_drag[surge]"),
        ("sway", "HFP", "thruster_degraded[HFP]"),
        ("yaw", "v", "cross_drag"),
    ],
)
def test_terms_have_names(axis, term, expected):
    assert stlsq.effect(axis, term, ("HFP",)) == expected


def test_every_term_stands_for_an_effect():
    grid = {n: np.linspace(-1, 1, 20) for n in (*"uvwpqrzt", "psi")}
    bases = {
        n.partition("[")[0] for n in (stlsq.effect(a, t, ("HFP",)) for a in AXES for t in stlsq.terms(grid, {"HFP": grid["u"]}))
    }
    assert bases <= set(names(foreign=False))
