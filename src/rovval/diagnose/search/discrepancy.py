"""Model discrepancy (Kennedy and O'Hagan 2001): what any systematic cause could explain, as generic forces that depend on speed, attitude, heading,
depth and thrusters.

They are never the explanation. Set free beside what was found and beside coefficients within tolerance, their evidence says how much of the gap is
systematic and still unexplained, so that an effect of the library that is only the least bad is not named; and on which axis and with what the
unexplained force varies.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rovval.core.data import Array
from rovval.core.large_arrays import side_by_side
from rovval.diagnose.criteria import GENERIC_SIZES, MATERIAL, MOST_FORCES
from rovval.diagnose.inference.laplace import Posterior
from rovval.diagnose.problem.cross_validation import Fold, held_out_losses
from rovval.diagnose.problem.problem import Problem, in_fine_metric
from rovval.diagnose.residuals.external_forces import generic_force_responses
from rovval.diagnose.residuals.normal_equations import Linearisation, NormalEquations, concatenated, normal_equations
from rovval.diagnose.residuals.nuisances import nuisance_sd
from rovval.diagnose.residuals.ridge import Prior, eliminated


@dataclass(frozen=True, slots=True)
class GenericForces:
    """Generic forces beside the columns of a fit. Evidence here is twice the log Bayes factor of forces over none, at the best of the prior sizes.

    Attributes:
        names: (axis, feature) of each force: what it acts on, and what it varies with.
        data: normal equations of the fit's k columns and of the forces behind them.
        precision: (k,) of the priors of the fit's columns.
        pull: (k,) gradient that those priors add.
        tempering: what squared residuals are divided by (`problem.Problem.tempering`).
    """

    names: tuple[tuple[str, str], ...]
    data: NormalEquations
    precision: Array
    pull: Array
    tempering: float

    def alone(self, prior_size: float) -> Array:
        """Evidence (f,) of each force by itself, of that prior standard deviation."""
        k = len(self.precision)
        A, b = self._eliminated(self.precision)
        return self._of_each(A[k:, k:], b[k:], self.tempering / prior_size**2)

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
        k = len(self.precision)
        A, b = self._eliminated(self.precision)
        at_first = np.einsum("wii->i", self.data.A)
        own = [k + i for i, (axis, _) in enumerate(self.names) if only in ("", axis) and A[k + i, k + i] > MATERIAL * at_first[k + i]]
        A, b, names = A[np.ix_(own, own)], b[own], [self.names[i - k] for i in own]
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

    def held_out_gain(self, folds: Sequence[Fold]) -> float:
        """Share by which all forces reduce the squared error on held-out windows, everything else fixed; 0 where they do not."""
        k = len(self.precision)
        columns, whole = self.data.columns[k:], float(self.data.c.sum())
        kept = [float(held_out_losses(self.data, folds, Prior(dict.fromkeys(columns, size)), self.tempering).sum()) for size in GENERIC_SIZES]
        return max(1.0 - min(kept) / whole, 0.0)

    def _eliminated(self, precision: Array) -> tuple[Array, Array]:
        """Curvature and slope of everything, the fit's columns with priors of ``precision`` eliminated."""
        free = np.arange(len(precision))
        return eliminated(self.data.A.sum(axis=0), self.data.b.sum(axis=0), free, np.diag(precision), self.pull)

    def _of_each(self, A: Array, b: Array, ridge: Array | float) -> Array:
        """Evidence of each force by itself; curvature and slope of the forces with all else eliminated."""
        return np.asarray(b**2 / (np.diag(A) + ridge) / self.tempering - np.log1p(np.diag(A) / ridge))


def generic_forces(problem: Problem, point: Posterior) -> GenericForces:
    """Every feature on every axis, simulated about a fit, beside its columns."""
    names, answers = generic_force_responses(problem.runs, point.beta)
    return beside(problem, names, answers, point.linear, point.precision, point.precision * point.departure)


def forces_beside(problem: Problem, point: Posterior) -> tuple[float, dict[str, float]]:
    """(Evidence of a few generic forces beside a fit (`GenericForces.sparse`), the same by axis in the fine metric, in which what is left of the gap is no form
    error; empty where there is no such metric)."""
    fine = in_fine_metric(problem, point.beta, point.linear)
    names, answers = generic_force_responses(problem.runs, point.beta)
    prior = point.precision, point.precision * point.departure
    evidence = beside(problem, names, answers, point.linear, *prior).sparse()[0]
    return evidence, beside(fine[0], names, answers, fine[1], *prior).by_axis() if fine else {}


def nominal_forces(problem: Problem) -> GenericForces:
    """The same about the nominal vehicle, with nothing beside them: what the gap itself looks like."""
    names, answers = generic_force_responses(problem.runs, problem.origin)
    return beside(problem, names, answers, problem.nominal, np.zeros(0), np.zeros(0))


def beside(
    problem: Problem, names: tuple[tuple[str, str], ...], answers: Sequence[Array], linear: Sequence[Linearisation], precision: Array, pull: Array
) -> GenericForces:
    """Named responses ``answers`` (m, n, c, f) of each run's windows as further columns beside those of ``linear``, whose priors have ``precision`` and add the
    gradient ``pull`` (k,)."""
    ids = tuple(range(len(problem.origin), len(problem.origin) + len(names)))
    parts = []
    for part, one, answer in zip(problem.runs, linear, answers, strict=True):
        both = Linearisation(one.r, side_by_side(one.S, answer), one.J, (*one.columns, *ids), one.valid)
        parts.append(normal_equations(both, part.ok, problem.likelihood.variance, nuisance_sd(part)))
    return GenericForces(names, concatenated(parts), precision, pull, problem.tempering)
