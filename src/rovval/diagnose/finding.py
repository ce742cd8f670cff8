"""The search as a whole: on every window of the logs, and where something began during one, on the part from there on."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from rovval.data import Array
from rovval.diagnose.excited import excited
from rovval.diagnose.library import hypotheses
from rovval.diagnose.problem import Problem, corrected_residuals, pose
from rovval.diagnose.select import Selection, select
from rovval.diagnose.since import CLEARER, MORE, after
from rovval.diagnose.stretches import Stretches
from rovval.diagnose.verdict import Judgement, judge
from rovval.errors import BadInput

WORTH = 0.5  # of the evidence asked for, linearised: with less, what follows a change is not searched (opened logs: 0.54 of one that was there)


@dataclass(frozen=True, slots=True)
class Finding:
    """What was posed, found and judged; ``untestable`` hypotheses with the reason; ``before`` the nominal vehicle's residuals; ``since``: seconds
    since the run's start from which the log was searched, None for all of it."""

    problem: Problem
    untestable: Mapping[str, str]
    selection: Selection
    before: list[Array]
    judgement: Judgement
    since: float | None = None


def find(parts: tuple[Stretches, ...], without: Sequence[str], slop: float, seed: int, say: Callable[[str, float], None]) -> Finding:
    """Search all windows; where the log changes, those after the change as well, which are told if they explain clearly more."""
    whole = _searched(parts, without, slop, seed, say)
    began = whole.selection.began
    if began is None or _event(whole) or began.evidence < WORTH * _asked(whole):
        return whole
    say(f"searching the part from {began.since:.0f} s on", 0.85)
    try:
        late = _searched((after(parts[0], began.since),), without, slop, seed, lambda text, share: None)
    except BadInput:  # too few of its windows can be simulated: the log as a whole was
        return whole
    told = late.judgement.causes > _asked(whole, late) and late.judgement.named and not _event(late)
    return replace(late, since=began.since) if told else whole


def _searched(parts: tuple[Stretches, ...], without: Sequence[str], slop: float, seed: int, say: Callable[[str, float], None]) -> Finding:
    library, untestable = hypotheses(parts, without=without)
    say(f"simulating every effect of the library on {sum(p.count for p in parts)} windows", 0.05)
    problem = pose(parts, library, slop)
    library, silent = excited(problem, library)
    selection = select(problem, library, seed, say)
    say("asking how much any systematic cause could explain", 0.85)
    before = corrected_residuals(problem)
    return Finding(problem, untestable | silent, selection, before, judge(problem, selection, before))


def _event(one: Finding) -> bool:
    """Whether a cause was named that has an onset of its own: that is what changes the log, where it changes."""
    return any(n.hypothesis.effect.begins for n in one.judgement.named)


def _asked(whole: Finding, late: Finding | None = None) -> float:
    """Evidence from which what follows a change is clearer than anything that the whole log shows, named or not. Where the whole log names nothing and
    what was found after the change is what comes first there, too, there is nothing else to outdo."""
    tried = whole.selection.rounds[0] if whole.selection.rounds else ()
    known = max([0.0, *(evidence for _, evidence, _ in tried), *([whole.judgement.causes] if whole.judgement.named else [])])
    same = late is not None and not whole.judgement.named and [n.hypothesis.name for n in late.judgement.named] == [name for name, _, _ in tried[:1]]
    return known + CLEARER if same else max(MORE * known, known + CLEARER)
