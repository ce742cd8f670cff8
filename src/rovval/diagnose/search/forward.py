"""Forward search over sets of causes: the most probable set is extended by one cause at a time, and its causes are then weighed beside each other.

Every model that is fitted is kept with its evidence and its prior mass; which of them is believed is decided elsewhere (`decision`). The search only has
to meet the probable ones. It goes one cause beyond the best set, since of two causes that offset each other neither explains the logs alone, and one beyond a
cause that may well be the form error of the others. And it goes a second way, from the next best single cause, where that is not far behind. Where a set beyond
the best one fits better, each of its causes is taken out again: the first may have been no more than the nearest to those that came after it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import log

import numpy as np

from rovval.diagnose.criteria import BETWEEN_CAUSES, NAMED_FROM
from rovval.diagnose.effort import MOST_CAUSES, NEGLIGIBLE, SETS_WEIGHED
from rovval.diagnose.hypotheses.hypothesis import Hypothesis, prior_of
from rovval.diagnose.inference.gap import tolerated_share
from rovval.diagnose.inference.laplace import Posterior, laplace_evidence
from rovval.diagnose.inference.map_fit import refit_healthy
from rovval.diagnose.inference.shrinkage import explainable_left, form_error
from rovval.diagnose.problem.cross_validation import by_fold, compare_held_out
from rovval.diagnose.problem.problem import Problem
from rovval.diagnose.residuals.normal_equations import NormalEquations
from rovval.diagnose.residuals.ridge import Prior
from rovval.diagnose.search.baseline import Candidate, baseline_of, healthy_baseline
from rovval.diagnose.search.candidates import candidates
from rovval.diagnose.search.joint import refitted, settled, with_relatives, without_each
from rovval.diagnose.search.model import Model, ModelPrior
from rovval.diagnose.search.onset import suspected_onset
from rovval.diagnose.search.plausible import plausible
from rovval.diagnose.search.screening import linearised, screened

Row = tuple[str, float, float]  # a candidate's name, evidence over its baseline, and reduction of the gap


@dataclass(frozen=True, slots=True)
class Selection:
    """What a search met.

    Attributes:
        models: every model that was fitted, the healthy vehicle first.
        best: the most probable of them, its fit with sensitivities.
        healthy: the fit of coefficients within tolerance, without causes.
        ranking: every hypothesis with the reduction of the gap that it makes by itself, held out: the causes first, then by that.
        steps: candidates of each step that had any, on the way from the best single cause.
        onset: from when on (s since the run's start) something seems to be at work that was not there before; None where nothing does.
        prior: prior mass of any set of causes.
        library: hypotheses that competed, with their initial points.
    """

    models: tuple[Model, ...]
    best: Model
    healthy: Posterior
    ranking: tuple[tuple[str, float], ...]
    steps: tuple[tuple[Row, ...], ...]
    onset: float | None
    prior: ModelPrior
    library: tuple[Hypothesis, ...]

    @property
    def log_posterior(self) -> float:
        """That of the most probable model."""
        return max(m.log_posterior for m in self.models)


def search(
    problem: Problem, library: list[Hypothesis], initialised: list[Hypothesis], healthy: Posterior, progress: Callable[[str, float], None],
    most: int = MOST_CAUSES,
) -> Selection:
    """The models that may explain the logs.

    Args:
        problem: the estimation problem.
        library: hypotheses that compete, as the problem was linearised in.
        initialised: the same with the initial points that the log suggests.
        healthy: fit of coefficients within tolerance, without causes.
        progress: called with what is being done and the share of the work that is done (0 to 1).
        most: causes at once that are sought.
    """
    over = _Space(problem, ModelPrior.of(library), initialised, healthy)
    nothing = Model((), None, laplace_evidence(problem, healthy), over.prior.log_mass(()))
    first = met = _grown(over, _Met([nothing], [], None), nothing, most, progress)
    if rival := _rival(first):
        met = _grown(over, first, refitted(problem, rival), most, progress)
    progress("weighing the causes beside each other", 0.7)
    healthy, models, best = _exchanged(over, met)
    rows = tuple(tuple((c.hypothesis.name, c.evidence, c.gain) for c in step) for step in first.tried)
    return Selection(tuple(models), best, healthy, _ranking(problem, library, best, rows), rows, first.onset, over.prior, tuple(initialised))


@dataclass(frozen=True, slots=True)
class _Space:
    """What is searched: sets of the hypotheses of a ``library``, with their ``prior`` mass, beside a ``healthy`` vehicle."""

    problem: Problem
    prior: ModelPrior
    library: list[Hypothesis]
    healthy: Posterior


@dataclass(frozen=True, slots=True)
class _Met:
    """What a search met so far: models, the healthy vehicle first, of which the best one of each step has its sensitivities; candidates of each step that had
    any; when something seems to begin (s); and the library as it was last linearised."""

    models: list[Model]
    tried: list[list[Candidate]]
    onset: float | None
    linear: NormalEquations | None = None

    @property
    def best(self) -> Model:
        """The most probable of the models."""
        return max(self.models, key=lambda m: m.log_posterior)

    @property
    def beyond(self) -> list[Model]:
        """The best models of steps that have one cause more than the most probable model, and fit better."""
        best = self.best
        stepped = [m for m in self.models if m.fit and m.fit.posterior.whitened]
        return [m for m in stepped if len(m.causes) == len(best.causes) + 1 and m.evidence > best.evidence]


def _grown(over: _Space, met: _Met, front: Model, most: int, progress: Callable[[str, float], None]) -> _Met:
    """What was met and what is met on the way from ``front`` on, to which one cause after the other is added, up to ``most``."""
    models, tried, onset, linear, doubted, best = list(met.models), list(met.tried), met.onset, met.linear, False, met.best
    for number in range(len(front.causes), most):
        progress(f"adding each of {len(over.library)} hypotheses to {number} causes", 0.7 - 0.4 * 0.7**number)
        found, suspected, linear = _extended(over, front, best.log_posterior + log(NEGLIGIBLE), linear)
        onset = suspected if front.fit is None else onset
        if not found:
            break
        tried.append(found)
        added = settled(over.problem, [_model(over.prior, front, c) for c in found], 1)
        models += added
        before, front = front, max(added, key=lambda m: m.log_posterior)
        best = max(best, front, key=lambda m: m.log_posterior)
        before_doubted, doubted = doubted, _looks_like_form_error(over.problem, before, front)
        if front.log_posterior < best.log_posterior + log(NEGLIGIBLE) or len(front.causes) > len(best.causes) + 1 or (doubted and before_doubted):
            break
    return _Met(models, tried, onset, linear)


def _rival(met: _Met) -> Model | None:
    """The most probable single cause that is not in the best set, from which the search goes another way: a cause of many parameters may stand for two of few,
    neither of which is as probable as it. None where it is negligible beside the best single one, as coarsely as causes are compared (`BETWEEN_CAUSES`)."""
    single = [m for m in met.models if len(m.causes) == 1]
    others = [m for m in single if not m.names & met.best.names]
    if not others:
        return None
    rival = max(others, key=lambda m: m.log_posterior)
    near = max(m.log_posterior for m in single) + log(NEGLIGIBLE) / BETWEEN_CAUSES
    return rival if rival.log_posterior > near else None


def _extended(over: _Space, front: Model, least: float, near: NormalEquations | None) -> tuple[list[Candidate], float | None, NormalEquations]:
    """Candidates for one cause more than ``front`` has, none where none promises a log posterior of ``least``; the onset that the log suggests; and the library
    linearised there, as it was ``near`` by where that holds."""
    problem, chosen = over.problem, front.fit.slots if front.fit else ()
    baseline = baseline_of(front.fit) if front.fit else healthy_baseline(problem, over.healthy)
    data = linearised(problem, over.library, baseline.posterior, near)
    open_now = [h for h in over.library if not any(h.is_one_with(cause) for cause in front.causes)]
    promised = screened(problem, data, open_now, chosen)
    onset = None if front.fit else suspected_onset(problem, data, open_now)
    needed = {h.label: 2.0 * (least - over.prior.log_mass((*front.causes, h))) - baseline.evidence for h in open_now}
    if not any(h.evident or promised[h.label] > needed[h.label] for h in open_now):
        return [], onset, data
    found = [c for c in candidates(problem, data, open_now, promised, needed, baseline, chosen) if plausible(problem, c)]
    return found, onset, data


def _looks_like_form_error(problem: Problem, before: Model, after: Model) -> bool:
    """Whether the last cause of a model leaves so much of what the model ``before`` it leaves of held-out windows that it would not be named: it may well be
    the form error of that. A first one may be that of what is missing in the library, and is doubted where it leaves all of them as they were, or worse."""
    left = [np.array([fit.dynamics_loss.sum(), fit.loss.sum()]) for fit in (before.fit, after.fit) if fit]
    shares = explainable_left(problem, left)
    if len(shares) < 2:
        return bool(shares[-1].min() >= 1.0)
    without, beside = shares
    return form_error(beside / without, tolerated_share(problem) / without) > 1.0 - NAMED_FROM


def _model(prior: ModelPrior, front: Model, one: Candidate) -> Model:
    """The model that a candidate is."""
    causes = (*front.causes, one.hypothesis)
    return Model(causes, one.fit, one.fit.evidence, prior.log_mass(causes), careful=bool(one.fit.posterior.whitened))


def _exchanged(over: _Space, met: _Met) -> tuple[Posterior, list[Model], Model]:
    """The healthy fit, tried from where it is beside the causes, too; the models with those that came of taking causes out, of the best set and of those of one
    cause more that fit better, and of exchanging them; and the best of them."""
    problem, models, best = over.problem, met.models, met.best
    if best.fit is None:
        return over.healthy, models, best
    healthy = refit_healthy(problem, over.healthy, best.fit.posterior, best.fit.slots)
    models = [Model((), None, laplace_evidence(problem, healthy), models[0].log_prior), *models[1:]]
    known, beyond = {m.names for m in models}, met.beyond
    while len(best.causes) > 1 or beyond:
        fewer = [one for whole in (best, *beyond) for one in without_each(problem, over.prior, whole)]
        known |= {m.names for m in fewer}
        exchanged, beyond = with_relatives(problem, over.prior, over.library, best, known, met.linear), []
        models = settled(problem, [*models, *fewer, *exchanged], 1)
        better = max(models, key=lambda m: m.log_posterior)
        if better.fit is None or better.log_posterior <= best.log_posterior:
            break
        best = better
    models = settled(problem, models, SETS_WEIGHED)
    return healthy, models, max((m for m in models if m.fit), key=lambda m: m.log_posterior)


def _ranking(problem: Problem, library: list[Hypothesis], best: Model, steps: Sequence[Sequence[Row]]) -> tuple[tuple[str, float], ...]:
    """Every hypothesis with the reduction of the gap that it makes by itself, held out, coefficients as filed: the causes first, then the others by
    that, fitted by re-simulation for the first step's candidates, linearised for the rest."""
    priors = {h.label: prior_of(problem, h) for h in library}
    _, fits = compare_held_out(by_fold(problem.gap.total, problem.folds), Prior({}), priors, problem.design_effect)
    gap, share = float(problem.gap.total.c.sum()), dict[str, float]()
    for h in library:
        share[h.name] = max(1.0 - fits[h.label].loss / gap, share.get(h.name, -np.inf))
    share |= {name: gain for name, _, gain in (steps[0] if steps else ())}
    leading = dict.fromkeys(h.name for h in best.causes)
    others = sorted((name for name in share if name not in leading), key=lambda name: -share[name])  # equals in the order of the library
    return tuple((name, share[name]) for name in (*leading, *others))
