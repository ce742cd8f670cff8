"""Whether what is at work began during the log, of effects that have no onset of their own: the part after it is then diagnosed by itself.

A cause that is there half of the time is fitted with half of its size, and its nearest relative, which moves in that half only, may fit as well.
In the linearised model every window could be the first with the cause in it; it must have clearly more evidence there than on the whole log, and the
windows before must deny that it was there.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.hypotheses.hypothesis import Hypothesis
from rovval.diagnose.inference.cross_validation import free_of, settled
from rovval.diagnose.inference.prior import Prior
from rovval.diagnose.inference.problem import Problem
from rovval.diagnose.residuals.normal_equations import Products
from rovval.diagnose.search.candidates import prior_of
from rovval.diagnose.windows.shooting import Stretches

BEFORE, AFTER = 3, 6  # windows without and with it, at least (chosen)
HINTED, AGAINST = 10.0, 20.0  # twice the log Bayes factor, linearised: of the part over the whole, and of the windows before against it (chosen)
CLEARER = 20.0  # the same of what was found in the part, at work from then on, over what was found in the whole: on the same windows (chosen)
TRIED = 12  # first windows with it that are tried, evenly spread, before those about the best of them (chosen)


@dataclass(frozen=True, slots=True)
class _Part:
    """Sums over some windows, slop taken out: what a hypothesis explains there is read off its own columns."""

    A: Array
    b: Array

    @classmethod
    def of(cls, data: Products, windows: slice, slop: Prior, inflation: float) -> _Part:
        """Slop settles on these windows alone."""
        free, ridge, offset = free_of(data, slop, inflation)
        return cls(*settled(data.A[windows].sum(axis=0), data.b[windows].sum(axis=0), free, ridge, ridge @ offset))


@dataclass(frozen=True, slots=True)
class Beginning:
    """Seconds since the run's start from which something seems to be at work, and its linearised evidence there."""

    since: float
    evidence: float


def began(problem: Problem, data: Products, library: Sequence[Hypothesis]) -> Beginning | None:
    """From where on something is at work that was not there before; None where nothing says so, and for several logs, each of which has a
    beginning of its own. ``data`` is the library linearised where healthy coefficients settled."""
    if len(problem.parts) > 1 or problem.blocks < BEFORE + AFTER:
        return None
    priors = {h.label: prior_of(problem, h) for h in library if not h.effect.begins}
    whole = _Part.of(data, slice(None), problem.slop, problem.inflation)
    always = {name: _explained(whole, data.place(tuple(prior.sd)), prior, problem.inflation)[0] for name, prior in priors.items()}
    first, last = BEFORE, problem.blocks - AFTER
    step = max(1, (last - first) // TRIED)
    found = {k: _begins(problem, data, priors, always, k) for k in range(first, last + 1, step)}
    at = max(found, key=lambda k: found[k])
    near = range(max(first, at - step + 1), min(last, at + step - 1) + 1) if found[at] else ()
    found |= {k: _begins(problem, data, priors, always, k) for k in near if k not in found}
    at = max(found, key=lambda k: found[k])
    part = problem.parts[0]
    return Beginning(float(part.start[at] * part.run.dt), found[at]) if found[at] else None


def _begins(problem: Problem, data: Products, priors: Mapping[str, Prior], always: Mapping[str, float], k: int) -> float:
    """Most evidence of a hypothesis in the windows from the ``k``-th on, of those with more than on the whole log that the windows before deny."""
    after = _Part.of(data, slice(k, None), problem.slop, problem.inflation)
    before = _Part.of(data, slice(k), problem.slop, problem.inflation)
    best = 0.0
    for name, prior in priors.items():
        at = data.place(tuple(prior.sd))
        evidence, size = _explained(after, at, prior, problem.inflation)
        if evidence > max(best, max(always[name], 0.0) + HINTED) and _worth(before, at, size) < -AGAINST * problem.inflation:
            best = evidence
    return best


def _explained(part: _Part, at: np.ndarray, prior: Prior, inflation: float) -> tuple[float, Array]:
    """Twice the log Bayes factor of a hypothesis, whose columns are ``at``, over slop in some windows, and its size there."""
    ridge = inflation / np.array(list(prior.sd.values())) ** 2
    H, slope = part.A[np.ix_(at, at)] + np.diag(ridge), part.b[at]
    size = np.linalg.solve(H, slope)
    return float(slope @ size / inflation - np.linalg.slogdet(H)[1] + np.log(ridge).sum()), size


def _worth(part: _Part, at: np.ndarray, size: Array) -> float:
    """What a hypothesis of a given size takes from the loss of some windows."""
    return float(2.0 * part.b[at] @ size - size @ part.A[np.ix_(at, at)] @ size)


def after(part: Stretches, since: float) -> Stretches:
    """The windows of a run from ``since`` (s) on."""
    kept = part.start * part.run.dt >= since
    return replace(part, start=part.start[kept], nu0=part.nu0[kept], eta0=part.eta0[kept], y=part.y[kept], ok=part.ok[kept])
