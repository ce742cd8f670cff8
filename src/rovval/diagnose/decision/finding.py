"""All that one pass of the algorithm finds: the problem, what was searched in it, and the decision; and which of two passes is reported."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from rovval.core.data import Array
from rovval.diagnose.decision.verdict import Decision
from rovval.diagnose.effort import ONSET_SEARCHED
from rovval.diagnose.problem.problem import Problem
from rovval.diagnose.residuals.sensor_faults import FittedFault
from rovval.diagnose.search.forward import Selection
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
    than any that was found in the ``whole`` of it."""
    if not late.decision.causes or not late.decision.fit or late.is_event:
        return False
    evidence = evidence_with_onset(whole.problem, late.decision.fit, onset.time, whole.selection.healthy) - onset_cost(whole.problem)
    return late.selection.prior.log_mass(late.decision.causes) + 0.5 * evidence > whole.selection.log_posterior
