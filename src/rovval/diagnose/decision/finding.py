"""All that one pass of the algorithm finds: the problem, what was searched in it, and the decision; and which of two passes is reported."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import inf, log

from rovval.core.data import Array
from rovval.diagnose.decision.posterior import log_varying
from rovval.diagnose.decision.resemblance import Left, gap_left, gap_left_from, none_of_the_library
from rovval.diagnose.decision.verdict import Decision
from rovval.diagnose.effort import ONSET_SEARCHED
from rovval.diagnose.problem.problem import Problem
from rovval.diagnose.residuals.sensor_faults import FittedFault
from rovval.diagnose.search.forward import Selection
from rovval.diagnose.search.model import Names, best_of_each_set
from rovval.diagnose.search.onset import Onset, evidence_with_onset, onset_cost


@dataclass(frozen=True, slots=True)
class Finding:
    """One pass of the algorithm.

    Attributes:
        problem: the estimation problem that was posed.
        untestable: effects and hypotheses that the log cannot test, with the reason.
        selection: what the search found.
        residuals: the nominal vehicle's, per run (windows, samples, channels).
        faults: of sensors, each fitted to the parity residuals by itself.
        decision: the verdict.
        since: s since the run's start from which the log was searched; None for all of it.
    """

    problem: Problem
    untestable: Mapping[str, str]
    selection: Selection
    residuals: list[Array]
    faults: tuple[FittedFault, ...]
    decision: Decision
    since: float | None = None

    @property
    def is_event(self) -> bool:
        """Whether a cause was named that has an onset of its own: that is what changes the log, where it changes."""
        return any(h.effect.begins for h in self.decision.causes)

    @property
    def onset(self) -> Onset | None:
        """From when on the log is worth a search of its own; None where it is not."""
        onset = self.selection.onset
        if onset is None or self.is_event:
            return None
        return onset if self.decision.verdict != "explained" or onset.evidence >= ONSET_SEARCHED * self.decision.evidence else None


def more_probable(late: Finding, whole: Finding, onset: Onset) -> bool:
    """Whether the causes that a search ``late`` of the windows from an onset on found, at work from then on, are a more probable model of the whole log
    than any that was found in the ``whole`` of it, what resembles causes and is none taken off each (`resemblance`), and those of which the sizes vary."""
    fit, problem, names = late.decision.fit, whole.problem, frozenset(h.name for h in late.decision.causes)
    if not fit or late.is_event:
        return False
    evidence = evidence_with_onset(problem, fit, onset.time, whole.selection.healthy) - onset_cost(problem)
    found = late.selection.prior.log_mass(late.decision.causes) + 0.5 * evidence + _log_known(names, gap_left_from(problem, names, fit, onset.time))
    left, varying = gap_left(problem, whole.selection.models), whole.decision.varying
    others = [m.log_posterior + (_log_known(m.names, left) if m.names else 0.0) for m in whole.selection.models]
    for some, m in best_of_each_set(whole.selection.models).items():
        if some in varying:
            form, alike = log_varying(m, varying[some])
            others += [form, *alike.values()]
    return found > max(others)


def _log_known(names: Names, left: Left) -> float:
    """Logarithm of the probability that what looks like causes is of the library."""
    known = 1.0 - none_of_the_library(names, left)
    return log(known) if known > 0.0 else -inf
