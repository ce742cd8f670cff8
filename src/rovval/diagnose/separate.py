"""Can this log tell hypotheses apart? Coherence of their signatures, and groups that a paired bootstrap cannot split."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from rovval.data import Array
from rovval.diagnose.confirm import Confirmed, evidence_of
from rovval.diagnose.problem import Problem
from rovval.diagnose.products import Products

RESAMPLES = 500
GROUP_RESAMPLES = 200
FORM = 0.05  # chosen: share of the evidence that may be owed to the form of an equation
LEVEL = 0.05  # one-sided: a member of the group must be this plausible to be as good as the winner


def group(problem: Problem, fitted: Mapping[str, Confirmed], winner: str, seed: int, block: int = 2) -> list[tuple[str, float]]:
    """Every hypothesis that this log does not tell from the winner, with the share of resamples in which it comes first.

    It stays in the group if its evidence is as good in more than `LEVEL` of a paired block bootstrap over windows, or falls short by
    less than `FORM` of the winner's: what equations that are only nearly right may cost. The winner leads.
    """
    draws = _blocks(problem.blocks, block, np.random.default_rng(seed))[:GROUP_RESAMPLES]
    counts = np.stack([np.bincount(draw, minlength=problem.blocks) for draw in draws]).astype(float)
    near = [n for n, c in fitted.items() if c.evidence > (1 - 4 * FORM) * fitted[winner].evidence]
    total = {n: evidence_of(problem, fitted[n].point, len(fitted[n].slots), counts) for n in near}
    members = [
        n for n in near
        if n == winner or float((total[n] >= total[winner]).mean()) > LEVEL or fitted[n].evidence > (1 - FORM) * fitted[winner].evidence
    ]  # fmt: skip
    firsts = np.argmax(np.stack([total[n] for n in members]), axis=0)
    share = {n: float((firsts == i).mean()) for i, n in enumerate(members)}
    rest = sorted((n for n in members if n != winner), key=lambda n: (-share[n], -fitted[n].evidence))
    return [(winner, share[winner]), *((n, share[n]) for n in rest)]


def coherence(data: Products, a: tuple[int, ...], b: tuple[int, ...]) -> float:
    """Largest canonical correlation between the signatures of two hypotheses (0: orthogonal, 1: the same to this log)."""
    A = data.A.sum(axis=0)
    i, j = data.place(a), data.place(b)
    left, right = _root(A[np.ix_(i, i)]), _root(A[np.ix_(j, j)])
    return float(np.clip(np.linalg.svd(left @ A[np.ix_(i, j)] @ right, compute_uv=False).max(initial=0.0), 0.0, 1.0))


def interval(before: Array, after: Array, seed: int, block: int = 2) -> tuple[float, float, float]:
    """Shrinkage 1 - after / before with its 90 % block-bootstrap interval over windows: (value, low, high)."""
    draws = _blocks(len(before), block, np.random.default_rng(seed))
    value = 1.0 - after.sum() / before.sum()
    low, high = np.quantile(1.0 - after[draws].sum(axis=1) / before[draws].sum(axis=1), [0.05, 0.95])
    return float(value), float(low), float(high)


def _blocks(m: int, block: int, rng: np.random.Generator) -> np.ndarray:
    """Circular block bootstrap: indices (resamples, m) of windows in runs of ``block``."""
    starts = rng.integers(0, m, (RESAMPLES, m // block + 1))
    return np.asarray(((starts[..., None] + np.arange(block)) % m).reshape(RESAMPLES, -1)[:, :m])


def _root(A: Array) -> Array:
    """Inverse symmetric root, directions without excitation left out."""
    values, vectors = np.linalg.eigh(A)
    keep = values > 1e-10 * max(float(values.max(initial=0.0)), 1e-300)
    return np.asarray((vectors[:, keep] / np.sqrt(values[keep])) @ vectors[:, keep].T)
