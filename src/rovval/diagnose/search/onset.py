"""Onset of a cause that has none of its own among its parameters: from when on it seems to be at work, and what it is then worth on the whole log.

A cause that is there half of the time is fitted with half of its size, and its nearest relative, which moves in that half only, may fit as well.
In the linearised model every window could be the first with the cause in it (likelihood ratio over all change points; Basseville and Nikiforov 1993):
it must have more evidence from there on than on the whole log, beyond what the choice of the window costs (`onset_cost`): the windows before deny it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import log

import numpy as np
from scipy.linalg import block_diag

from rovval.core.data import Array, Flags
from rovval.core.large_arrays import zeros
from rovval.diagnose.criteria import FEW_WINDOWS, LEAST_WINDOWS
from rovval.diagnose.effort import NEGLIGIBLE, ONSETS_TRIED
from rovval.diagnose.hypotheses.hypothesis import Hypothesis, prior_of
from rovval.diagnose.inference.gap import parity_errors, weighted_errors
from rovval.diagnose.inference.hypothesis_fit import HypothesisFit, only_places
from rovval.diagnose.inference.laplace import Posterior, promised_evidence
from rovval.diagnose.inference.map_fit import moved_within_bounds, posterior_at
from rovval.diagnose.problem.prior import wide_sd
from rovval.diagnose.problem.problem import Problem, corrected_of, corrected_residuals, equations_with_frozen, gap_equations_of
from rovval.diagnose.residuals.normal_equations import NormalEquations, Whitened
from rovval.diagnose.residuals.ridge import Prior, eliminated, free_columns
from rovval.diagnose.residuals.sensitivities import linearise
from rovval.diagnose.search.model import Model, Part
from rovval.diagnose.windows.windows import Windows

Near = tuple[Whitened, ...] | None  # sensitivities of a fit nearby; None: to be taken anew
Known = tuple[Near, Near]  # of all but the causes, with these at work and without
ANEW: Known = (None, None)


@dataclass(frozen=True, slots=True)
class Stretch:
    """Normal equations of neighbouring windows, summed, coefficients within tolerance eliminated: ``A`` (k, k), ``b`` (k,)."""

    A: Array
    b: Array

    @classmethod
    def of(cls, data: NormalEquations, windows: slice, tolerance: Prior, tempering: float) -> Stretch:
        """Coefficients are fitted on these windows alone."""
        free, ridge, offset = free_columns(data, tolerance, tempering)
        return cls(*eliminated(data.A[windows].sum(axis=0), data.b[windows].sum(axis=0), free, ridge, ridge @ offset))

    def explained(self, at: np.ndarray, prior: Prior, tempering: float) -> float:
        """Twice the log Bayes factor of a hypothesis with the columns ``at`` over none."""
        ridge = tempering / np.array(list(prior.sd.values())) ** 2
        H, slope = self.A[np.ix_(at, at)] + np.diag(ridge), self.b[at]
        return float(slope @ np.linalg.solve(H, slope) / tempering - np.linalg.slogdet(H)[1] + np.log(ridge).sum())


def suspected_onset(problem: Problem, data: NormalEquations, library: Sequence[Hypothesis]) -> float | None:
    """From when on (s since the run's start) something is at work that was not there before; None where nothing says so, and for several logs, each of
    which would have an onset of its own. ``data`` is the library linearised at the healthy fit."""
    if len(problem.runs) > 1 or problem.window_count < LEAST_WINDOWS + FEW_WINDOWS:
        return None
    priors = {h.label: prior_of(problem, h) for h in library if not h.effect.begins}
    whole = Stretch.of(data, slice(None), problem.tolerance, problem.tempering)
    always = {label: whole.explained(data.place(tuple(prior.sd)), prior, problem.tempering) for label, prior in priors.items()}
    first, last = LEAST_WINDOWS, problem.window_count - FEW_WINDOWS
    step = max(1, (last - first) // ONSETS_TRIED)
    found = {k: _evidence_from(problem, data, priors, always, k) for k in range(first, last + 1, step)}
    best = max(found, key=lambda k: found[k])
    near = range(max(first, best - step + 1), min(last, best + step - 1) + 1) if found[best] else ()
    found |= {k: _evidence_from(problem, data, priors, always, k) for k in near if k not in found}
    best = max(found, key=lambda k: found[k])
    windows = problem.runs[0]
    return float(windows.start[best] * windows.run.dt) if found[best] else None


def _evidence_from(problem: Problem, data: NormalEquations, priors: Mapping[str, Prior], always: Mapping[str, float], k: int) -> float:
    """Most evidence of a hypothesis in the windows from the ``k``-th on, of those with clearly more than on the whole log that the windows before deny;
    0 where there is none."""
    after = Stretch.of(data, slice(k, None), problem.tolerance, problem.tempering)
    best = 0.0
    for label, prior in priors.items():
        at = data.place(tuple(prior.sd))
        evidence = after.explained(at, prior, problem.tempering)
        if evidence > max(best, max(always[label], 0.0) + onset_cost(problem)):
            best = evidence
    return best


def onset_cost(problem: Problem) -> float:
    """What a cause that begins during the log pays for beginning in one of its windows rather than another, in twice the log of the prior."""
    return 2.0 * float(np.log(problem.window_count))


def windows_from(windows: Windows, time: float) -> Windows:
    """The windows of a run from ``time`` (s since its start) on."""
    return windows.some(windows.start * windows.run.dt >= time)


def with_onset(
    problem: Problem, causes: Sequence[Hypothesis], log_prior: float, part: Part, healthy: Posterior, beside: Model | None = None
) -> Model:
    """The model in which ``causes`` fitted to a part of the log are at work from its beginning on, and a healthy vehicle is before, on every window; from
    where the linearisation is made it takes one more step, and gains nothing by that linearisation alone.

    The windows before are the same of all causes that begin there. So these are compared with each other in the part, under the noise model of its own windows:
    where a model of other causes is given that begin there (``beside``), the evidence over it is that in the part.
    """
    switch, point, evidence = _best_switched(problem, part.fit, part.since, healthy)
    stepped = switch.stepped(problem, point).at(np.concatenate(_before(problem, part.since)))
    if stepped.cost() < point.cost():
        point, evidence = stepped, min(evidence, promised_evidence(problem, stepped))
    evidence -= onset_cost(problem)
    if beside and beside.part:
        evidence = beside.evidence + part.fit.evidence - beside.part.fit.evidence
    fit = replace(_on_every_window(problem, part.fit, part.since), posterior=point, evidence=evidence)
    return Model(tuple(causes), fit, evidence, log_prior, careful=True, part=part)


def evidence_with_onset(problem: Problem, fit: HypothesisFit, time: float, healthy: Posterior) -> float:
    """Twice the log Bayes factor over the nominal vehicle, on every window, of the causes of a ``fit`` at work from ``time`` (s) on and of a healthy vehicle
    before; that they begin in one window rather than another is not paid for. Quickly: sensitivities to all but the causes are those of the two fits."""
    return _best_switched(problem, fit, time, healthy, (fit.posterior.whitened or None, healthy.whitened or None))[2]


def moved_onset(problem: Problem, late: HypothesisFit, time: float, healthy: Posterior) -> float:
    """When (s) the causes of a fit to the windows from ``time`` on begin: at the most probable of all windows, where that makes ``time`` negligible."""
    windows = problem.runs[0]
    times = (windows.start * windows.run.dt)[LEAST_WINDOWS : problem.window_count - FEW_WINDOWS + 1]
    switches = _switches(problem, late, healthy, (None, healthy.whitened or None))  # good enough to tell one window from another
    evidence = {float(t): max(promised_evidence(problem, one.at(np.concatenate(_before(problem, t)))) for one in switches) for t in times}
    best = max(evidence, key=lambda t: evidence[t])
    return best if evidence[best] > evidence.get(time, -np.inf) - 2.0 * log(NEGLIGIBLE) else time


def _best_switched(problem: Problem, late: HypothesisFit, time: float, healthy: Posterior, known: Known = ANEW) -> tuple[_Switch, Posterior, float]:
    """The linearisation in which the causes of ``late`` at work from ``time`` (s) on have the most evidence, their posterior, and that evidence, less what its
    start gains over the ``healthy`` fit without any cause: every fit is local, and a cause must not gain by another start alone."""
    switches, nothing, never = _switches(problem, late, healthy, known), promised_evidence(problem, healthy), np.ones(problem.window_count, dtype=bool)
    first = np.concatenate(_before(problem, time))
    points = [one.at(first) for one in switches]
    started = [max(promised_evidence(problem, one.at(never)) - nothing, 0.0) for one in switches]
    evidence = [promised_evidence(problem, point) - gained for point, gained in zip(points, started, strict=True)]
    best = int(np.argmax(evidence))
    return switches[best], points[best], evidence[best]


def _switches(problem: Problem, late: HypothesisFit, healthy: Posterior, known: Known) -> list[_Switch]:
    """Coefficients and sensors that are healthy are the same all through the log: where they are beside the causes of ``late``, or where they are at the
    ``healthy`` fit."""
    own, sized = list(late.slots), [s for s in late.slots if not only_places(problem, s)]  # what only places the causes has no null value
    beside, alone, none = late.posterior.beta, healthy.beta.copy(), healthy.beta.copy()
    without = beside.copy()
    alone[own], without[sized], none[own] = beside[own], healthy.beta[sized], beside[own]
    none[sized] = healthy.beta[sized]
    return [_Switch.of(problem, late.slots, (now, then), known) for now, then in ((beside, without), (alone, none))]


def _before(problem: Problem, time: float) -> list[Flags]:
    """Which windows (m,) of each run begin before ``time`` (s)."""
    return [part.start * part.run.dt < time for part in problem.runs]


def _on_every_window(problem: Problem, late: HypothesisFit, time: float) -> HypothesisFit:
    """The fit ``late``, and of the windows before ``time`` (s) the vehicle as its file has it: losses, and errors by part."""
    linear, before = [linearise(windows, late.beta, ()) for windows in problem.runs], _before(problem, time)
    first = np.concatenate(before)
    nominal, found = corrected_residuals(problem), corrected_of(problem, linear)
    switched = [np.where(then[:, None, None], old, new) for then, old, new in zip(before, nominal, found, strict=True)]
    dynamics, total = gap_equations_of(problem, late.beta, linear)
    parity = parity_errors(problem, problem.origin, before), parity_errors(problem, late.beta, [~then for then in before])
    return replace(
        late,
        loss=np.where(first, problem.gap.total.c, total.c),
        dynamics_loss=np.where(first, problem.gap.dynamics.c, dynamics.c),
        parts=weighted_errors(problem, switched) | {name: size + parity[1][name] for name, size in parity[0].items()},
    )


@dataclass(frozen=True, slots=True)
class _Switch:
    """All windows linearised about causes at work (``begun``) and about a vehicle without them (``before``). A coefficient that the causes take is one of the
    vehicle's own, with its tolerance, before they do (``taken``, positions of columns). ``precision`` is that of the prior of all columns and these, times
    the tempering."""

    begun: Posterior
    before: Posterior
    taken: tuple[int, ...]
    precision: Array

    @classmethod
    def of(cls, problem: Problem, own: tuple[int, ...], points: tuple[Array, Array], known: Known) -> _Switch:
        """About two ``points`` (p,): with the causes, of slots ``own``, at work, and without; sensitivities to all else are those ``known`` of each."""
        others = tuple(c for c in problem.tolerance.sd if c not in own)
        begun, before = (posterior_at(problem, at, (*own, *others), len(own), near) for at, near in zip(points, known, strict=True))
        taken = tuple(i for i, slot in enumerate(own) if slot in problem.tolerance.sd)
        return cls(begun, before, taken, _precision(problem, own, others, taken))

    def stepped(self, problem: Problem, point: Posterior) -> _Switch:
        """Linearised anew where one more step leads to from ``point``, a posterior of this linearisation; the same where a simulation stops there."""
        (step, _), columns, own = point.simulated_step(), self.begun.columns, self.begun.effect_count
        without = [*columns[own:], *(columns[i] for i in self.taken)]  # what moves before the causes are at work
        points = [
            (self.begun, moved_within_bounds(problem, self.begun.beta, columns, step[: len(columns)])),
            (self.before, moved_within_bounds(problem, self.before.beta, without, step[own:])),
        ]
        if any(equations_with_frozen(problem, beta, one.whitened) is None for one, beta in points):
            return self
        begun, before = (posterior_at(problem, beta, one.columns, one.effect_count) for one, beta in points)
        return replace(self, begun=begun, before=before)

    def at(self, first: Flags) -> Posterior:
        """The causes at work but in the windows ``first`` (m,)."""
        begun, taken, k = self.begun, list(self.taken), len(self.begun.columns)
        columns = (*begun.columns, *(begun.columns[i] for i in taken))
        late, early = np.eye(k + len(taken), k), np.eye(k + len(taken), k)
        early[: begun.effect_count] = 0.0
        early[np.arange(k, k + len(taken)), taken] = 1.0

        def switched(old: NormalEquations, new: NormalEquations) -> NormalEquations:
            A, b = zeros(len(first), len(columns), len(columns)), np.zeros((len(first), len(columns)))
            for w, is_early in enumerate(first):
                data, way = (old, early) if is_early else (new, late)
                A[w], b[w] = way @ data.A[w] @ way.T, data.b[w] @ way.T
            return NormalEquations(A, b, np.where(first, old.c, new.c), columns)

        none = np.zeros(len(taken))
        return replace(
            begun,
            columns=columns, whitened=(),
            dynamics=switched(self.before.dynamics, begun.dynamics), total=switched(self.before.total, begun.total),
            precision=self.precision,
            departure=np.concatenate([begun.departure, self.before.departure[taken]]),
            bound_side=np.concatenate([begun.bound_side, none]), tangent_only=np.concatenate([begun.tangent_only, none > 0]),
        )  # fmt: skip


def _precision(problem: Problem, own: tuple[int, ...], others: tuple[int, ...], taken: tuple[int, ...]) -> Array:
    """Precision, times the tempering, of the prior of the causes' parameters (slots ``own``), of ``others``, and of those of the former that have a tolerance
    (``taken``, positions) before the causes are at work: in each of these a cause adds to what tolerance has it off by all through the log."""
    k, wide = len(own), np.array(list(wide_sd(problem.plant, own).values()))
    within = [*(own[i] for i in taken), *others]
    sums = block_diag(np.eye(k), np.roll(np.eye(len(within)), -len(taken), axis=0))
    sums[list(taken), k + np.arange(len(taken))] = 1.0
    covariance = sums @ block_diag(np.diag(wide**2), problem.tolerance.covariance(within)) @ sums.T
    sd = np.sqrt(np.diag(covariance))
    return np.asarray(problem.tempering * np.linalg.inv(covariance / np.outer(sd, sd)) / np.outer(sd, sd))
