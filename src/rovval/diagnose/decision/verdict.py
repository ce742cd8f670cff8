"""The verdict: explained, partly explained, unknown, or no gap. It is decided here and nowhere else.

What was found is asked what `weigh` asks, and is named if it passes.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

from rovval.core.data import Array
from rovval.diagnose.decision.questions import BROKEN, of_sensor
from rovval.diagnose.decision.unexplained import Accounted, Unexplained, accounted, open_gap, unexplained
from rovval.diagnose.decision.weigh import HOLDS, REAL, Weighed, weigh
from rovval.diagnose.inference.hypothesis_fit import Confirmed
from rovval.diagnose.inference.prior import STRAINED
from rovval.diagnose.inference.problem import Problem
from rovval.diagnose.search.discrepancy import Forces, bare_forces, forces
from rovval.diagnose.search.forward import Selection
from rovval.diagnose.search.joint import Named, jointly
from rovval.diagnose.search.round import FALSE_ALARM

COMPANY = 0.4  # of the probability of a further cause: what one cause leaves unexplained has other names, too (opened sets: 16 of 45 such names were right)
NEAR = 0.05  # of the gap, held out: an effect that closes less is not near the truth, whatever its evidence (chosen)


Verdict = Literal["no_gap", "explained", "partly_explained", "unknown"]


@dataclass(frozen=True, slots=True)
class Decision:
    """What a diagnosis decides.

    Attributes:
        verdict: ``no_gap``, ``explained``, ``partly_explained`` or ``unknown``.
        causes: the causes that are isolated, in the order found; empty for ``no_gap`` and ``unknown``.
        fit: their joint fit; None without causes.
        groups: of each cause the names that this log does not tell from it (itself first) with their probabilities.
        probability: of each cause.
        evidence: twice the log Bayes factor of the causes over the healthy vehicle; of ``unknown`` and ``no_gap`` of those that were rejected.
        generic_instead: the same of generic forces in the causes' place.
        generic_beside: the same of generic forces beside the causes, over the causes.
        departure: largest standardised departure of a coefficient that is no cause's, in standard deviations of its prior.
        accounted: what of the gap needs no cause.
        unexplained: what is left; None where nothing is.
    """

    verdict: Verdict
    causes: tuple[Named, ...]
    fit: Confirmed | None
    groups: Mapping[str, tuple[tuple[str, float], ...]]
    probability: Mapping[str, float]
    evidence: float
    generic_instead: float
    generic_beside: float
    departure: float
    accounted: Accounted
    unexplained: Unexplained | None


def decide(problem: Problem, selection: Selection, before: list[Array]) -> Decision:
    """The verdict on what a search found; ``before`` are the nominal vehicle's residuals."""
    general = forces(problem, selection.healthy)
    weighed = weigh(problem, selection, selection.final, general, before) if selection.final else None
    if weighed and weighed.unsteady and not weighed.least_bad:
        selection, weighed = _steady(problem, selection, weighed, general, before)
    if selection.final and weighed and weighed.parity_led and weighed.least_bad:
        selection = _only(problem, selection, tuple(n for n in selection.named if of_sensor(n)))
        weighed = replace(weighed, remains=True)
    if selection.final and weighed and (weighed.parity_led or not weighed.least_bad):
        return _isolated(problem, selection, selection.final, weighed)
    return _not_isolated(problem, selection, weighed, general, before)


def _isolated(problem: Problem, selection: Selection, final: Confirmed, weighed: Weighed) -> Decision:
    groups = {n.hypothesis.name: n.group for n in selection.named}
    gone = [name for name in weighed.unsteady if name not in groups]
    rest = unexplained(problem, weighed.rest, final.point, gone) if weighed.remains else None
    surest = max(selection.named, key=lambda n: n.evidence)
    probability = {n.hypothesis.name: _probability(n) * (1.0 if n is surest or of_sensor(n) else COMPANY) for n in selection.named}
    verdict: Verdict = "partly_explained" if weighed.remains else "explained"
    figures = weighed.total, weighed.instead, weighed.beside, weighed.strain
    return Decision(verdict, selection.named, final, groups, probability, *figures, accounted(problem, selection.healthy), rest)


def _not_isolated(problem: Problem, selection: Selection, weighed: Weighed | None, general: Forces, before: list[Array]) -> Decision:
    """An unknown cause where something is surely at work (a force, a strain, an effect that nearly fits) or where the gap stays open; else no gap."""
    total, skill, unsteady = (weighed.total, weighed.skill, weighed.unsteady) if weighed else (0.0, True, ())
    anything, strained = general.evidence(), selection.healthy.strain()
    tried = max((worth if gain > NEAR else worth / 3 for _, worth, gain in selection.rounds[0]), default=0.0) if selection.rounds else 0.0
    nearly = skill and (max(total, tried) > REAL or bool(unsteady))
    real = nearly or (anything > REAL and general.share(problem.folds) > HOLDS) or strained > BROKEN
    known = accounted(problem, selection.healthy)
    rest = unexplained(problem, bare_forces(problem), selection.healthy, unsteady) if real else open_gap(problem, known, before)
    return Decision("unknown" if rest else "no_gap", (), None, {}, {}, total, anything, anything, strained, known, rest)


def _steady(problem: Problem, selection: Selection, weighed: Weighed, general: Forces, before: list[Array]) -> tuple[Selection, Weighed]:
    """What stands without the causes that do not hold still; they are told as what is left."""
    kept = tuple(n for n in selection.named if n.hypothesis.name not in weighed.unsteady)
    if not kept:
        return selection, replace(weighed, least_bad=True)
    selection = _only(problem, selection, kept)
    assert selection.final is not None
    again = weigh(problem, selection, selection.final, general, before)
    least_bad = again.least_bad or bool(again.unsteady) or again.strain > STRAINED  # what went took up the strain: another cause is there
    return selection, replace(again, remains=True, least_bad=least_bad, unsteady=weighed.unsteady)


def _only(problem: Problem, selection: Selection, kept: tuple[Named, ...]) -> Selection:
    """The selection with the causes ``kept`` alone, fitted again."""
    final = selection.final
    if final is None or not kept or len(kept) == len(selection.named):
        return selection
    return replace(selection, named=kept, final=jointly(problem, final, [n.hypothesis for n in kept]))


def _probability(named: Named) -> float:
    """Share of belief that the named effect has in its group, less the chance that detection itself was false."""
    return float(named.group[0][1] * (1.0 - min(named.p_value, FALSE_ALARM)))
