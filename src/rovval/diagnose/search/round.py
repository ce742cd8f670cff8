"""One round of the search: is there anything beyond what stands, and which hypotheses, settled by re-simulation, may be added to it?"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from rovval.diagnose.hypotheses.hypothesis import Hypothesis, columns_of
from rovval.diagnose.inference.cross_validation import Ring, fit
from rovval.diagnose.inference.laplace import Point
from rovval.diagnose.inference.prior import Prior
from rovval.diagnose.inference.problem import Problem, at
from rovval.diagnose.residuals.normal_equations import Products
from rovval.diagnose.search.admissibility import admissible, possible
from rovval.diagnose.search.baseline import Ground, bare, with_causes
from rovval.diagnose.search.candidates import finalists, freed, prior_of, sharpened
from rovval.diagnose.search.confusion import STRONG, Rival
from rovval.diagnose.search.detection import Detection, detect
from rovval.diagnose.search.joint import LEAST_EVIDENCE, Named, worthy
from rovval.diagnose.search.onset import Beginning, began

FALSE_ALARM = 0.05  # family-wise, over the whole library
PLAIN = 20.0  # twice the log Bayes factor that needs no p-value: where a strong effect is left of the log, null draws hold some of it
PROMISING = 0.5  # of `LEAST_EVIDENCE`, in the linearised model: less is not re-simulated
REMAINS = 0.1  # share of the evidence of what stands from which what closes little by itself may wait for another, if it is strong (chosen)
CANDIDATES = 3  # that are settled to find the one that waits


@dataclass(frozen=True, slots=True)
class Round:
    """The detection of a round, the finalists that may be added, all that could be the cause, and (name, evidence, held-out gain) of all
    that were weighed; in the first, from when on something is at work."""

    detection: Detection
    able: list[Rival]
    rivals: list[Rival]
    told: tuple[tuple[str, float, float], ...]
    began: Beginning | None


def search(problem: Problem, library: list[Hypothesis], open_now: list[Hypothesis], named: list[Named], healthy: Point, seed: int) -> Round:
    """Is there anything beyond what stands, and which of the open hypotheses may be added to it?"""
    chosen = named[-1].fitted.slots if named else ()
    stands = with_causes(named[-1].fitted) if named else bare(problem, healthy)
    data = _bank(problem, library, stands.point)
    detection = _detect(problem, data, open_now, chosen, seed)
    most, start = detection.evidence[detection.best], None if named else began(problem, data, open_now)
    if most < PROMISING * LEAST_EVIDENCE or (detection.p_value(detection.best) > FALSE_ALARM and most < PLAIN):
        return Round(detection, [], [], (), start)
    one, tried = _settled(problem, data, open_now, detection, named, stands, start)
    rest = [h for h in open_now if h.name not in tried]
    if one.able or named or max((detection.evidence[h.label] for h in rest), default=0.0) < LEAST_EVIDENCE:
        return one
    other, _ = _settled(problem, data, rest, detection, named, stands, start)  # which something had kept out that promised much and keeps nothing
    return replace(other, told=tuple(sorted((*one.told, *other.told), key=lambda row: -row[1])))


def _settled(
    problem: Problem, data: Products, library: list[Hypothesis], detection: Detection, named: list[Named], stands: Ground, start: Beginning | None
) -> tuple[Round, set[str]]:
    """The best of a library settled by re-simulation, and which of them may be added; names of those that were settled."""
    weighed = finalists(problem, data, library, detection.evidence, stands, named[-1].fitted.slots if named else ())
    tried = {r.hypothesis.name for r in weighed}
    able = admissible(problem, sharpened(problem, admissible(problem, weighed), stands))
    told = tuple((r.hypothesis.name, r.evidence, r.gain) for r in able or weighed)
    best = [r for r in able if worthy(r, alone=not named)]
    if best:
        return Round(detection, best, able, told, start), tried
    waiting = _waiting(problem, weighed, stands, sum(n.evidence for n in named))
    return Round(detection, waiting, waiting, told, start), tried


def _waiting(problem: Problem, weighed: list[Rival], stands: Ground, evidence: float) -> list[Rival]:
    """The finalist with the most evidence, which closes little by itself, as long as others are still to be found: of two causes that
    offset each other, each alone opens the gap. Whether it is worth its name is asked again in the end (`together`). Of causes that stand with so
    much ``evidence``, the form of the equations alone leaves a share."""
    least = max(STRONG, REMAINS * evidence)
    rivals = [r for r in possible(problem, weighed) if r.evidence >= least][:CANDIDATES]
    return [r for r in possible(problem, sharpened(problem, rivals, stands)) if r.evidence >= least][:1] if rivals else []


def _bank(problem: Problem, library: list[Hypothesis], base: Point) -> Products:
    """Linearise everything about the point reached."""
    asked = columns_of(library)
    data = at(problem, base.beta, tuple(sorted({*asked.slots, *problem.slop.sd, *base.columns})), asked.directions)
    offset = np.array([base.beta[c] - problem.origin[c] if c < len(base.beta) else 0.0 for c in data.columns])
    return replace(data, offset=offset)


def _detect(problem: Problem, data: Products, library: list[Hypothesis], chosen: tuple[int, ...], seed: int) -> Detection:
    """Evidence of each hypothesis on top of slop and of what was chosen before."""
    slots = [c for c in data.columns if c < len(problem.plant.slots)]
    typical = Prior({c: problem.plant.slots[c].parameter.typical for c in slots})
    everything = fit(Ring.of(data, problem.folds), typical, problem.inflation).step
    base = problem.slop.widened(freed(problem, chosen))
    return detect(data, base, problem.slop, {h.label: prior_of(problem, h) for h in library}, problem.inflation, everything, seed)
