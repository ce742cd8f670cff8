"""Model discrepancy: what single generic forces and a few of them are worth."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rovval.diagnose.residuals.normal_equations import NormalEquations
from rovval.diagnose.search.discrepancy import GenericForces


def test_one_force_alone_is_worth_what_it_is_with_the_others_held():
    """Against the evidence of that force alone, worked out with the whole matrix; on the axes asked for."""
    rng = np.random.default_rng(0)
    axes = ("surge", "sway", "surge", "yaw", "roll", "heave")
    X = rng.normal(size=(30, 12, 4 + len(axes)))
    r = rng.normal(size=(30, 12)) + 0.8 * X[..., 6]
    data = NormalEquations(np.einsum("wni,wnj->wij", X, X), np.einsum("wni,wn->wi", X, r), (r**2).sum(axis=1), tuple(range(X.shape[-1])))
    beside = GenericForces(tuple((axis, str(i)) for i, axis in enumerate(axes)), data, np.full(4, 2.0), rng.normal(size=4), 1.7)
    one_by_one = {axis: max(beside.evidence([axis], str(i)) for i, a in enumerate(axes) if a == axis) for axis in axes}
    assert beside.single(["surge"]) == pytest.approx(one_by_one["surge"]) == pytest.approx(beside.single())
    assert beside.single(["sway", "yaw"]) == pytest.approx(max(one_by_one["sway"], one_by_one["yaw"], 0.0))
    assert beside.single() > beside.evidence(), "many that gain nothing cost more than the one gains"


def test_a_few_forces_are_worth_what_they_are_one_after_another():
    """Two of six at work; each of equal prior size, against the evidence of just those two, worked out with the whole matrix."""
    rng = np.random.default_rng(0)
    axes = ("surge", "sway", "surge", "yaw", "roll", "heave")
    X = rng.normal(size=(30, 12, 4 + len(axes)))
    r = rng.normal(size=(30, 12)) + 0.8 * X[..., 6] + 0.9 * X[..., 7]
    data = NormalEquations(np.einsum("wni,wnj->wij", X, X), np.einsum("wni,wn->wi", X, r), (r**2).sum(axis=1), tuple(range(X.shape[-1])))
    beside = GenericForces(tuple((axis, str(i)) for i, axis in enumerate(axes)), data, np.full(4, 2.0), rng.normal(size=4), 1.7)
    of_two = X[..., [0, 1, 2, 3, 6, 7]]
    two = NormalEquations(np.einsum("wni,wnj->wij", of_two, of_two), np.einsum("wni,wn->wi", of_two, r), data.c, tuple(range(6)))
    assert beside.single(most=2) == pytest.approx(replace(beside, names=beside.names[2:4], data=two).evidence())
    assert beside.single() < beside.single(most=2) <= beside.single(most=4) < beside.single(most=2) + 8.0, "the others are noise"


def test_a_force_that_the_cause_itself_could_be_is_not_held_against_it():
    """A coefficient that tolerance keeps in place leaves the force to others; as a cause it is free, and the force is the same thing."""
    rng = np.random.default_rng(1)
    X = rng.normal(size=(30, 12, 2))
    X[..., 1] = X[..., 0] + 0.1 * X[..., 1]
    r = rng.normal(size=(30, 12)) + 0.5 * X[..., 0]
    data = NormalEquations(np.einsum("wni,wnj->wij", X, X), np.einsum("wni,wn->wi", X, r), (r**2).sum(axis=1), (7, 8))
    beside = GenericForces((("surge", "u"),), data, np.full(1, 1e3), np.zeros(1), 1.0)
    assert beside.single(causes=(3,)) == beside.single() > 20.0
    assert beside.single(causes=(7,)) == 0.0


@pytest.mark.parametrize(("own", "counts"), [(0.95, True), (0.995, False)])
def test_a_force_that_a_coefficient_undoes_is_no_force_of_its_own(own: float, counts: bool):
    """As drag undoes a force that varies with speed: whatever little the two do against each other, however well it fits."""
    rng = np.random.default_rng(1)
    X = rng.normal(size=(30, 12, 2))
    X[..., 1] = own * X[..., 0] + np.sqrt(1.0 - own**2) * X[..., 1]
    r = rng.normal(size=(30, 12)) + 20.0 * (X[..., 1] - own * X[..., 0])
    data = NormalEquations(np.einsum("wni,wnj->wij", X, X), np.einsum("wni,wn->wi", X, r), (r**2).sum(axis=1), (0, 1))
    beside = GenericForces((("surge", "u"),), data, np.full(1, 1e-3), np.zeros(1), 1.0)
    assert beside.evidence() > 100.0
    assert beside.single() == (pytest.approx(beside.evidence()) if counts else 0.0)
