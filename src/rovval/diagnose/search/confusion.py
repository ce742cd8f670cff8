"""The confusion group: candidates that this log cannot tell from the best one (isolability; Gertler 1998)."""

from __future__ import annotations

import numpy as np

from rovval.diagnose.criteria import (
    CONFUSED_LEVEL,
    EVIDENCE_PER_PARAMETER,
    FEW_WINDOWS,
    FEW_WINDOWS_GAIN,
    FORM_SHARE,
    FORM_SHARE_MOST,
    TEMPERING_EVIDENCE,
)
from rovval.diagnose.inference.bootstrap import block_resamples
from rovval.diagnose.inference.laplace import resampled_evidence
from rovval.diagnose.problem.problem import Problem
from rovval.diagnose.search.baseline import Candidate

RESAMPLES = 200  # of the bootstrap: resolve `CONFUSED_LEVEL`


def confusion_group(problem: Problem, candidates: list[Candidate], seed: int, block: int = 2) -> tuple[tuple[str, float], ...]:
    """The best candidate and every other that this log does not tell from it, with probabilities, best first.

    A candidate stays in the group if its evidence is as good in more than `CONFUSED_LEVEL` of a paired block bootstrap over windows, or falls
    short by less than the share of the best's that model-form error may cost (`form_share`). Probabilities weigh evidence tempered by
    that share, so that they say how sure the name is, model-form error included.

    Args:
        problem: what the candidates were fitted to.
        candidates: best evidence first.
        seed: of the bootstrap.
        block: windows that are resampled together.
    """
    best = candidates[0]
    draws = block_resamples(problem.window_count, block, np.random.default_rng(seed))[:RESAMPLES]
    counts = np.stack([np.bincount(draw, minlength=problem.window_count) for draw in draws]).astype(float)
    form = form_share(problem.window_count)
    near = [c for c in candidates if c is best or c.evidence > (1 - 2 * form) * best.evidence or _near(c, best, form) or gains_alike(problem, c, best)]
    total = {c.hypothesis.name: resampled_evidence(problem, c.fit.posterior, counts) for c in near}
    lead = total[best.hypothesis.name]
    kept = [
        c for c in near
        if c is best or _near(c, best, form) or gains_alike(problem, c, best) or float((total[c.hypothesis.name] >= lead).mean()) > CONFUSED_LEVEL
    ]  # fmt: skip
    short = [best.evidence * (1 - EVIDENCE_PER_PARAMETER * _saved(c, best)) - c.evidence for c in candidates]
    weight = np.exp(-np.maximum(short, 0.0) / (TEMPERING_EVIDENCE + 0.5 * form * best.evidence))
    probability = {c.hypothesis.name: float(w) for c, w in zip(candidates, weight / weight.sum(), strict=True)}
    return tuple((c.hypothesis.name, probability[c.hypothesis.name]) for c in kept)


def form_share(windows: int) -> float:
    """Share of the evidence that may be owed to model-form error: `FORM_SHARE`, and more where few windows average over it."""
    return min(FORM_SHARE * (1.0 + (FEW_WINDOWS / windows) ** 3), FORM_SHARE_MOST)


def gains_alike(problem: Problem, one: Candidate, best: Candidate) -> bool:
    """Whether a log has too few windows to weigh evidence, and a candidate reduces the gap nearly as much as the best."""
    return problem.window_count < FEW_WINDOWS and one.gain >= FEW_WINDOWS_GAIN * best.gain


def _near(one: Candidate, best: Candidate, form: float) -> bool:
    """Whether a shortfall in evidence may be owed to model-form error, the more so the fewer parameters a candidate has."""
    return one.evidence > (1 - form - EVIDENCE_PER_PARAMETER * _saved(one, best)) * best.evidence


def _saved(one: Candidate, best: Candidate) -> int:
    """How many parameters fewer a candidate has than the best."""
    return max(len(best.hypothesis.slots) - len(one.hypothesis.slots), 0)
