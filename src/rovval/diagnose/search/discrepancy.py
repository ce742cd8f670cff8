"""Model discrepancy (Kennedy and O'Hagan 2001): what any systematic cause could explain, as generic forces that depend on speed, attitude, heading,
depth and thrusters.

They are never the explanation. Set free beside what was found and beside coefficients within tolerance, their evidence says how much of the gap is
systematic and still unexplained, so that an effect of the library that is only the least bad is not named; and on which axis and with what the
unexplained force varies. A calibrated vehicle has such forces as large as the logs of its calibration had them (`fit.calibration.discrepancy`); of
these there is no evidence, but of what goes beyond them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import reduce
from operator import add
from typing import NamedTuple

import numpy as np

from rovval.core.channels import AXES
from rovval.core.data import Array
from rovval.diagnose.criteria import GENERIC_SIZES, MATERIAL, MOST_FORCES
from rovval.diagnose.inference.laplace import Posterior
from rovval.diagnose.problem.cross_validation import cross_validate
from rovval.diagnose.problem.problem import Problem, in_fine_metric
from rovval.diagnose.residuals.external_forces import damps, generic_force_responses, typical_wrench
from rovval.diagnose.residuals.normal_equations import Linearisation, NormalEquations, normal_equations
from rovval.diagnose.residuals.nuisances import nuisance_sd
from rovval.diagnose.residuals.ridge import Prior, eliminated
from rovval.diagnose.windows.closed_loop import answered_forces
from rovval.simulation.fitted_tolerances import fitted_discrepancy, kind_of_force


@dataclass(frozen=True, slots=True)
class GenericForces:
    """Generic forces beside the columns of a fit. Evidence here is twice the log Bayes factor of forces over none, at the best of the prior sizes.

    Attributes:
        names: (axis, feature) of each force: what it acts on, and what it varies with.
        data: normal equations of the fit's k columns and of the forces behind them, of the windows that are held out together as of one.
        precision: (k, k) of the prior of the fit's columns.
        pull: (k,) gradient that it adds.
        tempering: what squared residuals are divided by (`problem.Problem.tempering`).
        expected: (f,) standard deviations of the forces that are there anyway (`expected_forces`); 0 where nothing is known of them.
    """

    names: tuple[tuple[str, str], ...]
    data: NormalEquations
    precision: Array
    pull: Array
    tempering: float
    expected: Array

    def alone(self, prior_size: float) -> Array:
        """Evidence (f,) of each force by itself, of that prior standard deviation."""
        return self._of_each(*self._beyond_expected(*self.beside_the_fit()), self.tempering / prior_size**2)

    def by_axis(self) -> dict[str, float]:
        """Evidence of the few forces on each axis that explain most (`sparse`); 0 of an axis on which none does."""
        return {axis: max(self.sparse(axis)[0], 0.0) for axis in dict.fromkeys(axis for axis, _ in self.names)}

    def sparse(self, only: str = "") -> tuple[float, tuple[tuple[str, str], ...]]:
        """(Evidence of the few forces, each of one feature on one axis, that explain most, the names of these): up to `MOST_FORCES`, each beside those before
        and only where it gains, after the prior of one force and one size among all has been paid; minus infinity where none does. Of those on the axis
        ``only``, where one is given.

        One that the fit's columns can undo all but a little of (`MATERIAL`), as drag undoes a force that varies with speed, is none: the two
        against each other hold the simulation to the measured speed, whatever it is that is missing.
        """
        A, b = self.beside_the_fit()
        at_first = np.einsum("wii->i", self.data.A)[len(self.precision) :]
        own = [i for i, (axis, _) in enumerate(self.names) if only in ("", axis) and A[i, i] > MATERIAL * at_first[i]]
        A, b = self._beyond_expected(A, b)
        A, b, names = A[np.ix_(own, own)], b[own], [self.names[i] for i in own]
        ridge, total, found = self.tempering / np.array(GENERIC_SIZES)[:, None] ** 2, 0.0, list[tuple[str, str]]()
        each = 2.0 * np.log(max(len(own) * len(ridge), 1))
        for _ in range(min(MOST_FORCES, len(own))):
            worth = self._of_each(A, b, ridge) - each
            size, best = np.unravel_index(int(np.argmax(worth)), worth.shape)
            if worth[size, best] <= 0.0:
                break
            total += float(worth[size, best])
            found.append(names.pop(int(best)))
            A, b = eliminated(A, b, np.array([best]), np.diag(ridge[size]), np.zeros(1))
            A, b = np.delete(np.delete(A, best, 0), best, 1), np.delete(b, best)
        return total if found else -np.inf, tuple(found)

    def held_out_gain(self) -> float:
        """Share by which all forces reduce the squared error on held-out windows, everything else fixed; 0 where they do not."""
        columns = self.data.columns[len(self.precision) :]
        kept = [cross_validate(self.data, Prior(dict.fromkeys(columns, size)), self.tempering).loss for size in GENERIC_SIZES]
        return max(1.0 - min(kept) / float(self.data.c.sum()), 0.0)

    def beside_the_fit(self) -> tuple[Array, Array]:
        """Curvature (f, f) and slope (f,) of the forces, the fit's columns eliminated with their priors."""
        k = len(self.precision)
        A, b = eliminated(self.data.A.sum(axis=0), self.data.b.sum(axis=0), np.arange(k), self.precision, self.pull)
        return A[k:, k:], b[k:]

    def _beyond_expected(self, A: Array, b: Array) -> tuple[Array, Array]:
        """The same of further forces beside those that are expected, which are eliminated: what goes with the same motion adds to these."""
        known = np.flatnonzero(self.expected)
        toward = np.linalg.solve(A[np.ix_(known, known)] + np.diag(self.tempering / self.expected[known] ** 2), np.column_stack([A[known], b[known]]))
        return A - A[:, known] @ toward[:, :-1], b - A[:, known] @ toward[:, -1]

    def _of_each(self, A: Array, b: Array, ridge: Array | float) -> Array:
        """Evidence of each force by itself; curvature and slope of the forces with all else eliminated."""
        return np.asarray(b**2 / (np.diag(A) + ridge) / self.tempering - np.log1p(np.diag(A) / ridge))


def generic_forces(problem: Problem, point: Posterior) -> GenericForces:
    """Every feature on every axis, simulated about a fit, beside its columns."""
    names, answers = generic_force_responses(problem.runs, point.beta)
    return beside(problem, names, answers, point.linear, point.precision, point.pull, expected_forces(problem, names))


class Beside(NamedTuple):
    """Generic ``forces`` beside a fit: ``evidence`` of a few of them (`GenericForces.sparse`); evidence by axis of all that there is in the ``fine`` metric, in
    which what is left of the gap is no form error, whatever is expected, empty where there is no such metric; and the ``axes`` on which the few act."""

    forces: GenericForces
    evidence: float
    fine: Mapping[str, float]
    axes: tuple[str, ...]


def forces_beside(problem: Problem, point: Posterior, segments: Sequence[Array] = ()) -> Beside:
    """Those beside the fit that ended at ``point``, and, where the responses of its ``segments`` are given (`segment_responses`), those in the fine metric."""
    linear = point.linear
    finer = in_fine_metric(problem, segments, linear) if segments else None
    names, answers = generic_force_responses(problem.runs, point.beta)
    prior, expected = (point.precision, point.pull), expected_forces(problem, names)
    forces = beside(problem, names, answers, linear, *prior, expected)
    evidence, few = forces.sparse()
    all_of_it = beside(finer[0], names, answers, finer[1], *prior, np.zeros(len(names))).by_axis() if finer else {}
    return Beside(forces, evidence, all_of_it, tuple(dict.fromkeys(axis for axis, _ in few)))


def nominal_forces(problem: Problem) -> GenericForces:
    """The same about the nominal vehicle, with nothing beside them: what the gap itself looks like."""
    names, answers = generic_force_responses(problem.runs, problem.origin)
    return beside(problem, names, answers, problem.nominal, np.zeros((0, 0)), np.zeros(0), expected_forces(problem, names))


def expected_forces(problem: Problem, names: Sequence[tuple[str, str]]) -> Array:
    """Standard deviations (f,) of generic forces that are no evidence of something else, in the rms of the thrusters' own force on each axis: those that the
    problem's vehicle has by its calibration, and a damping as large as the one by which thrusters answer the motion within a sample. What pushes the vehicle
    is in the motion that they answer, and is read as a part of that damping (direct identification in closed loop; Ljung 1999, 13.4)."""
    known, wrench = fitted_discrepancy(problem.plant.vehicle), dict(zip(AXES, typical_wrench(problem.runs), strict=True))
    answered = {axis: size / wrench[axis] for axis, size in answered_forces(problem.runs).items()}
    by_name = [(axis, damps(axis, feature)) for axis, feature in names]
    return np.array([np.hypot(known.get(kind_of_force(axis, own), 0.0) / wrench[axis], answered[axis] if own else 0.0) for axis, own in by_name])


def beside(
    problem: Problem, names: tuple[tuple[str, str], ...], answers: Sequence[Array], linear: Sequence[Linearisation], precision: Array, pull: Array,
    expected: Array,
) -> GenericForces:  # fmt: skip
    """Named responses ``answers`` (m, n, c, f) of each run's windows as further columns beside those of ``linear``, whose prior has ``precision`` (k, k) and
    adds the gradient ``pull`` (k,), and beside forces of ``expected`` size (f,)."""
    ids = tuple(range(len(problem.origin), len(problem.origin) + len(names)))
    held = np.stack([fold.test for fold in problem.folds])
    parts = []
    for i, (part, one, answer) in enumerate(zip(problem.runs, linear, answers, strict=True)):
        forces = Linearisation(one.r, answer, one.J, ids, one.valid)
        parts.append(normal_equations(one, part.ok, problem.likelihood.variance, nuisance_sd(part), forces, held[:, problem.run_of_window == i]))
    return GenericForces(names, reduce(add, parts), precision, pull, problem.tempering, expected)
