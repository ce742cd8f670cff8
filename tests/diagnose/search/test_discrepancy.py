"""Model discrepancy: what a few generic forces are worth."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from diagnose_case import posed, slot, turned
from scipy.linalg import block_diag

from rovval.diagnose.criteria import GENERIC_SIZES
from rovval.diagnose.inference.map_fit import map_fit
from rovval.diagnose.inference.unlogged_forces import responses_about
from rovval.diagnose.residuals.normal_equations import NormalEquations
from rovval.diagnose.search.discrepancy import GenericForces, expected_forces, forces_beside
from rovval.diagnose.windows.multiple_shooting import cut
from rovval.vehicle import load

AXES = ("surge", "sway", "surge", "yaw", "roll", "heave")


def forces(at_work: dict[int, float]) -> GenericForces:
    """Six forces behind four columns of a fit, some of them at work."""
    rng = np.random.default_rng(0)
    X = rng.normal(size=(30, 12, 4 + len(AXES)))
    r = rng.normal(size=(30, 12)) + sum(size * X[..., 4 + i] for i, size in at_work.items())
    data = NormalEquations(np.einsum("wni,wnj->wij", X, X), np.einsum("wni,wn->wi", X, r), (r**2).sum(axis=1), tuple(range(X.shape[-1])))
    none = np.zeros(len(AXES))
    return GenericForces(tuple((axis, str(i)) for i, axis in enumerate(AXES)), data, 2.0 * np.eye(4), rng.normal(size=4), 1.7, none)


def only(forces: GenericForces, *which: int) -> GenericForces:
    """Some of the forces behind the same columns."""
    keep = [0, 1, 2, 3, *(4 + i for i in which)]
    data = NormalEquations(forces.data.A[:, keep][..., keep], forces.data.b[:, keep], forces.data.c, tuple(keep))
    return replace(forces, names=tuple(forces.names[i] for i in which), expected=forces.expected[list(which)], data=data)


def evidence(forces: GenericForces, size: float) -> float:
    """Of all forces with a prior of this size over none, worked out with the whole matrix."""
    k = len(forces.precision)
    H = forces.data.A.sum(axis=0) + block_diag(forces.precision, np.eye(len(forces.names)) * forces.tempering / size**2)
    slope = forces.data.b.sum(axis=0) - [*forces.pull, *np.zeros(len(forces.names))]
    without = slope[:k] @ np.linalg.solve(H[:k, :k], slope[:k])
    volume = np.linalg.slogdet(H)[1] - np.linalg.slogdet(H[:k, :k])[1] - len(forces.names) * np.log(forces.tempering / size**2)
    return float((slope @ np.linalg.solve(H, slope) - without) / forces.tempering - volume)


def test_those_at_work_are_found_and_pay_for_having_been_chosen():
    """Two of six, against the evidence of just those two worked out with the whole matrix, less the prior of each."""
    worth, names = forces({2: 0.8, 3: 0.9}).sparse()
    assert set(names) == {("surge", "2"), ("yaw", "3")}
    two = only(forces({2: 0.8, 3: 0.9}), 2, 3)
    assert worth == pytest.approx(max(evidence(two, size) for size in GENERIC_SIZES) - 2 * 2.0 * np.log(len(AXES) * 3), abs=0.5)


@pytest.mark.parametrize("size", [0.01, 0.1, 1.0])
def test_each_by_itself_has_the_evidence_of_the_whole_matrix(size: float):
    both = forces({2: 0.8, 3: 0.9})
    found = both.alone(size)
    for i in range(len(AXES)):
        assert found[i] == pytest.approx(evidence(only(both, i), size), abs=1e-6)


def test_of_forces_that_are_expected_only_what_goes_beyond_them_has_evidence():
    """Against the whole matrix with a second column for each force, of which the first has the expected size in both models."""
    expected = np.array([0.0, 0.0, 0.3, 0.3, 0.3, 0.3])
    both = replace(forces({2: 0.8, 3: 0.9}), expected=expected)
    known = np.flatnonzero(expected)
    columns = [0, 1, 2, 3, *(4 + known)]
    for i in range(len(AXES)):
        own = [*columns, 4 + i]
        A, b = both.data.A[:, own][..., own], both.data.b[:, own]
        whole = GenericForces(
            both.names[i : i + 1], NormalEquations(A, b, both.data.c, tuple(range(len(own)))),
            block_diag(both.precision, np.diag(both.tempering / expected[known] ** 2)), np.concatenate([both.pull, np.zeros(len(known))]),
            both.tempering, np.zeros(1),
        )  # fmt: skip
        assert both.alone(1.0)[i] == pytest.approx(evidence(whole, 1.0), abs=1e-6)


def test_what_is_expected_is_worth_nothing_and_ten_times_as_much_is():
    found, expected = forces({2: 0.8, 3: 0.9}), np.zeros(len(AXES))
    assert replace(found, expected=expected + 0.9).sparse() == (-np.inf, ())
    worth, names = replace(found, expected=expected + 0.05).sparse()
    assert 6.0 < worth < found.sparse()[0] and set(names) == {("surge", "2"), ("yaw", "3")}


@pytest.mark.parametrize("answers", [True, False])
def test_a_damping_as_large_as_thrusters_answer_the_motion_with_is_expected(answers: bool):
    """Of yaw, which a pilot steadies against gusts; none where it turns as it likes. What does not damp is never expected."""
    problem, _ = posed()
    runs, _ = cut([turned(2.0, answers)], load("bluerov2_heavy"), "fossen", 10.0)
    names = (("yaw", "r"), ("yaw", "r|r|"), ("yaw", "constant"), ("yaw", "u"), ("roll", "p"))
    found = expected_forces(replace(problem, runs=tuple(runs)), names)
    assert (found[2:] == 0.0).all() and found[0] == found[1]
    assert (found[0] > 0.3) if answers else (found[0] < 0.05)


def test_nothing_at_work_is_worth_nothing():
    worth, names = forces({}).sparse()
    assert worth == -np.inf and names == ()


@pytest.mark.parametrize(("own", "counts"), [(0.95, True), (0.995, False)])
def test_a_force_that_a_coefficient_undoes_is_no_force_of_its_own(own: float, counts: bool):
    """As drag undoes a force that varies with speed: whatever little the two do against each other, however well it fits."""
    rng = np.random.default_rng(1)
    X = rng.normal(size=(30, 12, 2))
    X[..., 1] = own * X[..., 0] + np.sqrt(1.0 - own**2) * X[..., 1]
    r = rng.normal(size=(30, 12)) + 20.0 * (X[..., 1] - own * X[..., 0])
    data = NormalEquations(np.einsum("wni,wnj->wij", X, X), np.einsum("wni,wn->wi", X, r), (r**2).sum(axis=1), (0, 1))
    beside = GenericForces((("surge", "u"),), data, np.full((1, 1), 1e-3), np.zeros(1), 1.0, np.zeros(1))
    assert max(evidence(beside, size) for size in GENERIC_SIZES) > 100.0
    assert bool(beside.sparse()[1]) is counts


def test_forces_on_one_axis_are_those_of_that_axis_alone():
    both = forces({2: 0.8, 3: 0.9})
    found = both.by_axis()
    assert set(found) == set(AXES) and found["surge"] > 6.0 and found["yaw"] > 6.0
    assert max(found["sway"], found["roll"], found["heave"]) < 2.0
    worth, names = both.sparse("yaw")
    assert worth == found["yaw"] and names == (("yaw", "3"),)


def test_in_the_fine_metric_a_force_shows_on_the_axis_of_a_cause_and_none_beside_it():
    p, _ = posed(("cross_drag:yaw_to_sway=0.0,sway_to_yaw=0.3",))
    own = tuple(slot(p, key) for key in ("cross_drag.yaw_to_sway", "cross_drag.sway_to_yaw"))
    fits = [map_fit(p, p.origin, slots) for slots in ((), own)]
    alone, beside = (forces_beside(p, fit, responses_about(p, fit)).fine for fit in fits)
    assert alone["yaw"] > 10.0 and beside["yaw"] < 0.05 * alone["yaw"]
    few = replace(p, components=None)
    assert forces_beside(few, fits[0], responses_about(few, fits[0])).fine == {}, "where windows are too few to tell disturbances from anything"
