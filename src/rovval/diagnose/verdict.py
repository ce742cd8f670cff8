"""The verdict: explained, partly explained, unknown, or no gap. A library effect is not named for being the least bad."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rovval.data import Array
from rovval.diagnose.confirm import Confirmed, slop_loss
from rovval.diagnose.problem import Problem
from rovval.diagnose.select import FALSE_ALARM, LEAST_EVIDENCE, Named, Selection
from rovval.diagnose.unknown import Ceiling, ceiling

LEAST_OF_CEILING = 0.5  # a cause takes at least half of the systematic gap that slop leaves (research E.9)
BEYOND, FAR_ABOVE_NOISE = 2.0, 20.0  # times the null's evidence, times the sensors' noise (chosen; healthy logs of the tuning set do not pass)
STRUCTURED = 0.15  # of the gap: a generic force must close this much more before something unknown is claimed (research E.9)


@dataclass(frozen=True, slots=True)
class Judgement:
    """``verdict`` of the contract; the causes that stand, their joint fit, groups and probabilities; the shares of the gap that slop
    alone, any systematic force, and the causes with slop beside them close; what is left in words."""

    verdict: str
    named: tuple[Named, ...]
    final: Confirmed | None
    groups: Mapping[str, tuple[tuple[str, float], ...]]
    probability: Mapping[str, float]
    slop_share: float
    ceiling_share: float
    cause_share: float
    left: dict[str, object] | None


def judge(problem: Problem, selection: Selection, axes: dict[str, dict[str, object]]) -> Judgement:
    """Weigh what was found against what could have been found."""
    gap = float(problem.dynamic.c.sum())
    by_slop = slop_loss(problem, problem.origin)
    top = ceiling(problem, problem.origin)
    named, final = selection.named, selection.final
    with_cause = slop_loss(problem, final.beta) if final else by_slop
    rest = ceiling(problem, final.beta) if final else top
    structure, remains = _beyond(by_slop, top), _beyond(with_cause, rest)
    slop_share, ceiling_share, cause_share = (1.0 - float(x.sum()) / gap for x in (by_slop, np.minimum(top.loss, by_slop), with_cause))
    parity_led = bool(named) and float((problem.data.c - problem.dynamic.c).sum()) > gap
    insufficient = remains / gap > STRUCTURED and remains > (1 - LEAST_OF_CEILING) * max(structure, 1e-12)
    if named and final and not parity_led and insufficient:
        named, final, remains, rest = (), None, structure, top
    real = remains / gap > STRUCTURED and _most_windows(with_cause if final else by_slop, rest.loss)
    left = _left(rest, remains / gap) if real else None
    if not named:
        if not real and slop_share < LEAST_OF_CEILING and _plain_to_see(selection, axes):
            left = _formless(axes)
        return Judgement("unknown" if left else "no_gap", (), None, {}, {}, slop_share, ceiling_share, cause_share, left)
    groups = {n.hypothesis.name: n.group for n in named}
    probability = {n.hypothesis.name: _probability(n) for n in named}
    return Judgement("partly_explained" if real else "explained", named, final, groups, probability, slop_share, ceiling_share, cause_share, left)


def _plain_to_see(selection: Selection, axes: dict[str, dict[str, object]]) -> bool:
    """Whether a gap that nothing explains is still no healthy log's: beyond slop by evidence, and far above the sensors' noise."""
    times = [float(str(row["rms"])) / max(float(str(row["floor_rms"])), 1e-12) for row in axes.values()]
    beyond = selection.last_p <= FALSE_ALARM and selection.last_evidence > BEYOND * max(selection.null_evidence, LEAST_EVIDENCE)
    return beyond and max(times, default=0.0) > FAR_ABOVE_NOISE


def _formless(axes: dict[str, dict[str, object]]) -> dict[str, object]:
    ordered = sorted(axes, key=lambda axis: -float(str(axes[axis]["share"])))[:2]
    text = (
        f"the gap in {' and '.join(ordered)} is far beyond noise and slop, but no effect of the library and no smooth force closes it; "
        "the simulated motion may diverge within a window (shorten --window), or the cause acts in events"
    )
    return {"axes": ordered, "depends_on": [], "share": 0.0, "text": text}


def _beyond(base: Array, top: Ceiling) -> float:
    """What a generic force closes of a loss on held-out windows beyond ``base``."""
    return max(float((base - top.loss).sum()), 0.0)


def _most_windows(base: Array, loss: Array) -> bool:
    """Whether the generic force helps in most of the log and not by a few windows: one-sided sign test at 5 %."""
    return bool((base > loss).mean() > 0.5 + 0.82 / np.sqrt(len(base)))


def _left(top: Ceiling, share: float) -> dict[str, object]:
    axes = [axis for axis, gain in top.axes if gain > 0.3 * max(top.axes[0][1], 1e-9)][:3]
    depends = [name for name, gain in top.features if gain > 0.3 * max(top.features[0][1], 1e-9)][:4]
    text = f"a systematic force on {', '.join(axes)} that varies with {', '.join(depends)} would close {100 * share:.0f} % more; no effect of the library is it"
    return {"axes": axes, "depends_on": depends, "share": share, "text": text}


def _probability(named: Named) -> float:
    """Share of bootstrap resamples that the named effect leads, less the chance that detection itself was false."""
    return float(named.group[0][1] * (1.0 - min(named.p_value, FALSE_ALARM)))
