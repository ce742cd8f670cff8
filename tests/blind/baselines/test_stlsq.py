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


def test_sparse_regression_is_pysindy_s():
    pysindy = pytest.importorskip("pysindy", reason="pysindy is not installed (`uv pip install pysindy`)")
    x, y = sparse_case()
    theirs = pysindy.STLSQ(threshold=stlsq.THRESHOLD, alpha=stlsq.RIDGE, unbias=False).fit(x, y).coef_
    np.testing.assert_allclose(stlsq.stlsq(x, y), np.ravel(theirs), atol=1e-9)


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
