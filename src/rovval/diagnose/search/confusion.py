"""Can this log tell hypotheses apart? Coherence of their signatures, and groups that a paired bootstrap cannot split."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.criteria import FEW_WINDOWS
from rovval.diagnose.hypotheses.hypothesis import Hypothesis
from rovval.diagnose.inference.bootstrap import _blocks
from rovval.diagnose.inference.hypothesis_fit import Confirmed
from rovval.diagnose.inference.laplace import evidence
from rovval.diagnose.inference.problem import Problem

GROUP_RESAMPLES = 200
FORM = 0.35  # chosen on the tuning set: share of the evidence that may be owed to the form of an equation
MOST_FORM = 0.7  # chosen: the largest share that is owed to form where windows are few
ALIKE = 0.6  # of the best gain: with fewer windows than that, whoever closes as much stays beside the best
PER_PARAMETER = 0.05  # chosen: what each parameter that the best has more may add to it
TEMPER = 4.0  # twice the log Bayes factor that counts as a nat of belief, beside the form's share (chosen on the tuning set)
STRONG, RELIEF = 60.0, 0.2  # evidence from which it is asked what is closed beside slop, and the share that counts (opened logs: wrong ones 0.12 at most)
DENIED = 0.2  # of what the kinematic checks show: a fault of a sensor that adds as much is not there (opened logs: true ones add nothing, false ones 0.3 to 15)
LEVEL = 0.05  # one-sided: a member of the group must be this plausible to be as good as the winner


@dataclass(frozen=True, slots=True)
class Rival:
    """A finalist: its re-simulated fit, its evidence over what stood before, and the share of the gap it closes by itself, held out; the same
    of what the kinematic checks alone show (`closed`), and of what slop leaves, slop settled beside it (`ground`). ``mends``: with much evidence,
    and without it a coefficient is beyond its tolerance, with it none: a drag may be surely wrong and yet be little of a gap that is heave's. ``begun``: of
    what begins in mid-log, the share that it closes from there on."""

    hypothesis: Hypothesis
    fitted: Confirmed
    evidence: float
    gain: float
    kinematic: float
    beside: float = 0.0
    mends: bool = False
    begun: float = 0.0

    @property
    def closes(self) -> float:
        """What it closes with every other coefficient as the file has it, or as slop lets them be, where that is enough to count."""
        return max(self.gain, self.beside) if self.beside >= RELIEF else self.gain


Losses = tuple[Array, Array]


def denied(one: Rival) -> bool:
    """Whether a fault of a sensor makes the kinematic checks worse, which no error of the dynamics touches."""
    return one.hypothesis.effect.place == "sensor" and one.kinematic < -DENIED


def closed(was: Losses, now: Losses) -> tuple[float, float]:
    """Shares of held-out losses (with and without the kinematic checks) that are closed: the larger of the two, and of the checks alone."""
    checks = float((was[0] - was[1]).sum())
    kinematic = 1.0 - float((now[0] - now[1]).sum()) / checks if checks > 0 else 0.0
    return max(float((a - b).sum() / a.sum()) for a, b in zip(was, now, strict=True)), kinematic


def group(problem: Problem, rivals: list[Rival], seed: int, block: int = 2) -> tuple[tuple[str, float], ...]:
    """The best rival and every other that this log does not tell from it, with probabilities, best first.

    A rival stays in the group if its evidence is as good in more than `LEVEL` of a paired block bootstrap over windows, or falls
    short by less than `FORM` of the best (more in short logs): what equations that are only nearly right may cost. Probabilities weigh evidence
    tempered by the same share, so that they say how sure the name is, form of the equations included.
    """
    best = rivals[0]
    draws = _blocks(problem.blocks, block, np.random.default_rng(seed))[:GROUP_RESAMPLES]
    counts = np.stack([np.bincount(draw, minlength=problem.blocks) for draw in draws]).astype(float)
    form = form_share(problem.blocks)
    near = [r for r in rivals if r is best or r.evidence > (1 - 2 * form) * best.evidence or _near(r, best, form) or alike(problem, r, best)]
    total = {r.hypothesis.name: evidence(problem, r.fitted.point, counts) for r in near}
    lead = total[best.hypothesis.name]
    kept = [r for r in near if r is best or _near(r, best, form) or alike(problem, r, best) or float((total[r.hypothesis.name] >= lead).mean()) > LEVEL]
    short = [best.evidence * (1 - PER_PARAMETER * _saved(r, best)) - r.evidence for r in rivals]
    weight = np.exp(-np.maximum(short, 0.0) / (TEMPER + 0.5 * form * best.evidence))
    probability = {r.hypothesis.name: float(w) for r, w in zip(rivals, weight / weight.sum(), strict=True)}
    return tuple((r.hypothesis.name, probability[r.hypothesis.name]) for r in kept)


def form_share(windows: int) -> float:
    """Share of the evidence that may be owed to the form of an equation: `FORM`, and more where few windows average over it."""
    return min(FORM * (1.0 + (FEW_WINDOWS / windows) ** 3), MOST_FORM)


def alike(problem: Problem, rival: Rival, best: Rival) -> bool:
    """Whether a log has too few windows to weigh evidence, and a rival closes nearly as much of the gap as the best."""
    return problem.blocks < FEW_WINDOWS and rival.gain >= ALIKE * best.gain


def _near(rival: Rival, best: Rival, form: float) -> bool:
    """Whether a rival's shortfall in evidence may be owed to the form of its equation, the more so the fewer parameters it has."""
    return rival.evidence > (1 - form - PER_PARAMETER * _saved(rival, best)) * best.evidence


def _saved(rival: Rival, best: Rival) -> int:
    """How many parameters fewer a rival has than the best."""
    return max(len(best.hypothesis.slots) - len(rival.hypothesis.slots), 0)








