"""A file that is off in many numbers: what it explains beside no cause, and beside causes.

Which numbers are off is found one at a time in the linearisation about a fit, as in automatic relevance determination (MacKay 1992), and paid for; what
they explain is then found by re-simulation.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import log

import numpy as np

from rovval.diagnose.criteria import FILE_WIDTH, PRIOR_FILE, PRIOR_HEALTHY
from rovval.diagnose.effort import MOST_CAUSES, NEGLIGIBLE, SCREENED_WITHIN, SETS_WEIGHED
from rovval.diagnose.inference.laplace import Posterior, laplace_evidence, promised_evidence
from rovval.diagnose.inference.map_fit import map_fit, map_refit
from rovval.diagnose.problem.problem import Problem
from rovval.diagnose.search.forward import Selection
from rovval.diagnose.search.model import Names


def file_evidence(problem: Problem, selection: Selection) -> dict[Names, float]:
    """Twice the log Bayes factor, over the file as it is, of one that is off (`FILE_WIDTH`) in more numbers than causes are sought, those of the causes
    beside it counted, or in a few that no effect which competes is about: beside no cause, and beside each of the most probable sets of causes; in the
    linearisation alone where that promises nothing (`NEGLIGIBLE`, `SCREENED_WITHIN`) beside the most probable model."""
    causes = sorted((m for m in selection.models if m.fit and not m.part), key=lambda m: -m.log_posterior)[:SETS_WEIGHED]
    least = 2.0 * (selection.log_posterior + log(NEGLIGIBLE) - log(PRIOR_FILE / PRIOR_HEALTHY)) - SCREENED_WITHIN
    found = dict[Names, float]()
    for model in (selection.models[0], *causes):
        point = model.fit.posterior if model.fit else selection.healthy
        if file := numbers_off(problem, selection, point, len(model.causes)):
            found[model.names] = _fitted(problem, point, file) if file.evidence > least - 2.0 * model.log_prior else file.evidence
    return found


def numbers_off(problem: Problem, selection: Selection, point: Posterior, causes: int) -> Departures | None:
    """The numbers of the file that are off beside a fit, the ``point``, of so many ``causes``: those that explain most; None where none explain anything."""
    compete = {s for name, _ in selection.ranking for s in problem.plant.hypotheses[name]}
    others = [s for s in problem.tolerance.sd if s not in point.columns[: point.effect_count]]
    many = departures(problem, point, others)[MOST_CAUSES - causes :]
    few = departures(problem, point, [s for s in others if s not in compete])
    return max((*many, *few), key=lambda one: one.evidence, default=None)


def _fitted(problem: Problem, point: Posterior, file: Departures) -> float:
    """Evidence of a file that is off, fitted by re-simulation from where the linearisation begins: far from there it says little."""
    wide = problem.tolerance.off_by_more({s: FILE_WIDTH * problem.tolerance.sd[s] for s in file.slots})
    there = replace(problem, tolerance=wide)
    fit = map_refit(there, point) if point.whitened else map_fit(there, point.beta, point.columns[: point.effect_count])
    return laplace_evidence(there, fit) - file.cost


@dataclass(frozen=True, slots=True)
class Departures:
    """A file that is off in some numbers.

    Attributes:
        slots: the numbers.
        evidence: twice the log Bayes factor over the file as it is, less what it costs.
        cost: twice the log of the number of choices among which these were made.
    """

    slots: tuple[int, ...]
    evidence: float
    cost: float


def departures(problem: Problem, point: Posterior, among: Sequence[int]) -> list[Departures]:
    """Files of which one, two, three ... of the numbers ``among`` (slots) are off by as much as `FILE_WIDTH` has it: those that explain most.

    It ends where one more explains no more. In the linearisation about a fit, the ``point`` (automatic relevance determination; MacKay 1992); a variance that
    is larger changes the precision of the prior, and so the curvature, by a matrix of rank one (Sherman and Morrison 1950).
    """
    moves = (point.bound_side == 0) | (point.solve(point.curvature, point.descent) != 0.0)  # what stays on its bound at the best step is held there
    precision, evidence, found = point.precision, promised_evidence(problem, point), list[Departures]()
    more = (FILE_WIDTH**2 - 1.0) * np.diag(np.linalg.inv(precision))  # variance of a number that is off, beside its own
    each = 2.0 * float(np.log(max(len(among), 1)))
    columns = [i for s in among if moves[i := point.columns.index(s)]]
    A, b = point.total.A.sum(axis=0), point.total.b.sum(axis=0)
    while columns:
        toward = precision[:, columns]
        larger = 1.0 + more[columns] * precision[columns, columns]
        freed, off = more[columns] / larger, point.departure @ toward
        inverse = np.linalg.inv((A + precision)[np.ix_(moves, moves)])
        step = (b - precision @ point.departure)[moves] @ inverse @ toward[moves]
        own = np.einsum("ij,ij->j", toward[moves], inverse @ toward[moves])
        left = 1.0 - freed * own
        gained = freed * off * (off + 2.0 * step + freed * off * own) + freed / left * (step + freed * off * own) ** 2
        worth = gained / problem.tempering - np.log(left) - np.log(larger) - each
        best = int(np.argmax(worth))
        if len(found) > MOST_CAUSES and worth[best] <= 0.0:
            break
        evidence += float(worth[best])
        chosen = (*(found[-1].slots if found else ()), point.columns[columns[best]])
        found.append(Departures(chosen, evidence, len(chosen) * each))
        precision = precision - freed[best] * np.outer(toward[:, best], toward[:, best])
        del columns[best]
    return found
