"""The search as a whole: on every window of the logs, and where something began during one, on the part from there on."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from rovval.core.data import Array
from rovval.core.errors import BadInput
from rovval.diagnose.decision.verdict import Decision, decide
from rovval.diagnose.hypotheses.hypothesis import columns_of
from rovval.diagnose.hypotheses.library import hypotheses
from rovval.diagnose.hypotheses.observability import excited
from rovval.diagnose.inference.laplace import whole_evidence
from rovval.diagnose.inference.problem import Problem, corrected_residuals, pose
from rovval.diagnose.search.forward import Selection, select
from rovval.diagnose.search.onset import CLEARER, after
from rovval.diagnose.search.switched import switched
from rovval.diagnose.windows.shooting import Stretches

WORTH = 0.2  # of the evidence of the best on the whole log: with less, linearised, what follows a change is not searched (opened logs: 0.25 of a true one)


@dataclass(frozen=True, slots=True)
class Finding:
    """What was posed, found and judged; ``untestable`` hypotheses with the reason; ``before`` the nominal vehicle's residuals; ``since``: seconds
    since the run's start from which the log was searched, None for all of it."""

    problem: Problem
    untestable: Mapping[str, str]
    selection: Selection
    before: list[Array]
    decision: Decision
    since: float | None = None


def find(parts: tuple[Stretches, ...], without: Sequence[str], slop: float, seed: int, say: Callable[[str, float], None]) -> Finding:
    """Search all windows; where the log changes, those after the change as well: what they show is told if, at work from then on, it explains the
    whole log clearly better than anything that was found in all of it."""
    whole = _searched(parts, without, slop, seed, say)
    began = whole.selection.began
    if began is None or _event(whole) or began.evidence < WORTH * _known(whole):
        return whole
    say(f"searching the part from {began.since:.0f} s on", 0.85)
    try:
        late = _searched((after(parts[0], began.since),), without, slop, seed, lambda text, share: None)
    except BadInput:  # too few of its windows can be simulated: the log as a whole was
        return whole
    if not late.decision.causes or not late.decision.fit or _event(late):
        return whole
    healthy = whole.selection.healthy
    beyond = switched(whole.problem, late.decision.fit, began.since, healthy) - whole_evidence(whole.problem, healthy)
    clearer = beyond > _known(whole) + CLEARER
    return replace(late, since=began.since) if clearer else whole


def _searched(parts: tuple[Stretches, ...], without: Sequence[str], slop: float, seed: int, say: Callable[[str, float], None]) -> Finding:
    library, untestable = hypotheses(parts, without=without)
    say(f"simulating every effect of the library on {sum(p.count for p in parts)} windows", 0.05)
    problem = pose(parts, columns_of(library), slop)
    library, silent = excited(problem, library)
    selection = select(problem, library, seed, say)
    say("asking how much any systematic cause could explain", 0.85)
    before = corrected_residuals(problem)
    return Finding(problem, untestable | silent, selection, before, decide(problem, selection, before))


def _event(one: Finding) -> bool:
    """Whether a cause was named that has an onset of its own: that is what changes the log, where it changes."""
    return any(n.hypothesis.effect.begins for n in one.decision.causes)


def _known(whole: Finding) -> float:
    """Evidence of the best that the whole log shows, named or not, over a healthy vehicle."""
    tried = whole.selection.rounds[0] if whole.selection.rounds else ()
    return max([0.0, *(evidence for _, evidence, _ in tried), *([whole.decision.evidence] if whole.decision.causes else [])])
