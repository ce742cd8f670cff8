"""The verdict: explained, partly explained, unknown, or no gap. A library effect is not named for being the least bad."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rovval.data import Array
from rovval.diagnose.confirm import Confirmed
from rovval.diagnose.contest import fit
from rovval.diagnose.problem import Problem
from rovval.diagnose.select import FALSE_ALARM, Named, Selection
from rovval.diagnose.unknown import Ceiling

LEAST_OF_CEILING = 0.5  # a cause explains at least half of what any systematic force could (research E.9)
STRUCTURED = 0.15  # a generic force must close this much more before something unknown is claimed (research E.9)


@dataclass(frozen=True, slots=True)
class Judgement:
    """``verdict`` of the contract; the causes that stand, their joint fit, groups and probabilities; the share of the gap that any
    systematic force could close, that slop alone closes, and what is left in words."""

    verdict: str
    named: tuple[Named, ...]
    final: Confirmed | None
    groups: Mapping[str, tuple[tuple[str, float], ...]]
    probability: Mapping[str, float]
    ceiling_share: float
    over_slop: float
    left: dict[str, object] | None


def judge(problem: Problem, selection: Selection, top: Ceiling) -> Judgement:
    """Weigh what was found against what could have been found."""
    gap = float(problem.dynamic.c.sum())
    slop_only = float(fit(problem.dynamic, problem.folds, problem.slop, problem.inflation).loss.sum())
    possible = 1.0 - float(np.minimum(top.loss.sum(), gap)) / gap
    beyond_slop = max(slop_only - float(top.loss.sum()), 0.0) / gap
    closed = 1.0 - float(selection.final.dynamic_loss.sum()) / gap if selection.final else 0.0
    structured = beyond_slop > STRUCTURED and _real(slop_only, problem, top)
    named = selection.named
    if named and closed < LEAST_OF_CEILING * possible:
        named = ()
    if not named:
        verdict = "unknown" if structured else "no_gap"
        left = _left(top, beyond_slop) if structured else None
        return Judgement(verdict, (), None, {}, {}, possible, beyond_slop, left)
    rest = possible - closed
    verdict = "explained" if rest < STRUCTURED else "partly_explained"
    groups = {n.hypothesis.name: n.group for n in named}
    probability = {n.hypothesis.name: _probability(n) for n in named}
    return Judgement(verdict, named, selection.final, groups, probability, possible, beyond_slop, _left(top, rest) if rest >= STRUCTURED else None)


def _real(slop_only: float, problem: Problem, top: Ceiling) -> bool:
    """Whether the generic force's gain over slop is there in most of the log: sign test over windows."""
    base: Array = fit(problem.dynamic, problem.folds, problem.slop, problem.inflation).loss
    better = base - top.loss
    m = len(better)
    return bool(better.sum() > 0 and (better > 0).mean() > 0.5 + 0.82 / np.sqrt(m)) and slop_only > 0


def _left(top: Ceiling, share: float) -> dict[str, object]:
    axes = [axis for axis, gain in top.axes if gain > 0.3 * max(top.axes[0][1], 1e-9)][:3]
    depends = [name for name, gain in top.features if gain > 0.3 * max(top.features[0][1], 1e-9)][:4]
    text = f"a systematic force on {', '.join(axes)} that varies with {', '.join(depends)} would close {100 * share:.0f} % more; no effect of the library is it"
    return {"axes": axes, "depends_on": depends, "share": share, "text": text}


def _probability(named: Named) -> float:
    """Share of bootstrap resamples that the named effect leads, less the chance that detection itself was false."""
    return float(named.group[0][1] * (1.0 - min(named.p_value, FALSE_ALARM)))
