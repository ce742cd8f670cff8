"""Whether stated probabilities mean what they say: reliability by bins, Brier score, expected calibration error, calibration slope, log score.

A forecast here is what an answer says first with the probability that it states for it; whether it is right is in the label. References: Brier 1950
(score), Cox 1958 (slope of the logistic recalibration), Murphy and Winkler 1977 (reliability), Naeini, Cooper and Hauskrecht 2015 (expected
calibration error), Clopper and Pearson 1934 (intervals of shares).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from rovval.blind.plant.spec import Array
from rovval.blind.scoring.intervals import Z, exact

EDGES = (0.0, 0.25, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.99, 1.0)  # finer where an engine that is worth having states most of its probabilities
LEAST = 1e-3  # a probability nearer to 0 or 1 counts as this in logarithms, so that one log does not decide the score alone (chosen)
FLAT = 1e-9  # a slope is there where the fit has come to rest within this


def calibration(stated: Sequence[float], right: Sequence[bool]) -> dict[str, Any]:
    """Everything that the module's first line names, of forecasts ``stated`` and whether they came true.

    ``skill`` is the share by which the log score (mean natural logarithm of the probability given to what was so, at most 0) is nearer to 0 than that of
    the one constant probability that fits best, the share right; None where all or none are right. ``slope`` is one where probabilities
    mean what they say, below one where they are too sure; None where a fit does not exist (all right, none right, or told apart by the stated
    probability without an exception). Empty of everything but ``n`` without forecasts.
    """
    p, hit = np.asarray(stated, dtype=float), np.asarray(right, dtype=float)
    if not len(p):
        return {"n": 0}
    bins = _bins(p, hit)
    off = sum(row["n"] * abs(row["stated"] - row["right"]["value"]) for row in bins) / len(p)
    score, base = log_score(p, hit), log_score(np.full(len(p), hit.mean()), hit)
    constant = 0.0 < hit.mean() < 1.0
    return {
        "n": len(p), "right": exact(list(right)), "stated": float(p.mean()), "bins": bins,
        "brier": float(np.mean((p - hit) ** 2)), "calibration_error": float(off),
        "slope": slope(p, hit), "log_score": score, "constant_log_score": base if constant else 0.0, "skill": 1.0 - score / base if constant else None,
    }  # fmt: skip


def skill_of_kinds(stated: Sequence[Mapping[str, float]], true: Sequence[str]) -> dict[str, float] | None:
    """Log score (mean logarithm of the probability given to the kind that is true), that of the constant probabilities that fit best (the kinds' shares), and
    the share by which the one is nearer to 0; None where all are of one kind."""
    shares = [count / len(true) for count in Counter(true).values()]
    if len(shares) < 2:
        return None
    score = float(np.mean([np.log(max(p[kind], LEAST)) for p, kind in zip(stated, true, strict=True)]))
    base = float(sum(share * np.log(share) for share in shares))
    return {"log_score": score, "constant_log_score": base, "skill": 1.0 - score / base}


def log_score(p: Array, hit: Array) -> float:
    """Mean logarithm of the probability given to what was so."""
    q = np.clip(p, LEAST, 1.0 - LEAST)
    return float(np.mean(np.where(hit > 0.0, np.log(q), np.log1p(-q))))


def _bins(p: Array, hit: Array) -> list[dict[str, Any]]:
    """Bins that hold a forecast: bounds, count, mean probability stated, share right."""
    at = np.clip(np.searchsorted(EDGES, p, side="right") - 1, 0, len(EDGES) - 2)
    rows = []
    for i, (low, high) in enumerate(pairwise(EDGES)):
        inside = at == i
        if inside.any():
            right = exact(hit[inside].astype(bool).tolist())
            rows.append({"low": low, "high": high, "n": int(inside.sum()), "stated": float(p[inside].mean()), "right": right})
    return rows


def slope(p: Array, hit: Array) -> dict[str, float] | None:
    """Slope b of logit P(right) = a + b logit(stated) by maximum likelihood (Newton), with its 90 % interval by the curvature."""
    q = np.clip(p, LEAST, 1.0 - LEAST)
    x = np.stack([np.ones(len(q)), np.log(q / (1.0 - q))], axis=1)
    if not 0.0 < hit.mean() < 1.0 or np.ptp(x[:, 1]) < FLAT:
        return None
    beta = np.zeros(2)
    for _ in range(50):
        fitted = 1.0 / (1.0 + np.exp(-np.clip(x @ beta, -30.0, 30.0)))
        curve = x.T @ (x * (fitted * (1.0 - fitted))[:, None])
        if np.linalg.cond(curve) > 1.0 / FLAT:
            return None  # told apart without an exception: the likelihood has no maximum
        move = np.linalg.solve(curve, x.T @ (hit - fitted))
        beta = beta + move * min(1.0, 2.0 / max(1e-12, float(np.abs(move).max())))
        if float(np.abs(move).max()) < FLAT:
            half = Z * float(np.sqrt(np.linalg.inv(curve)[1, 1]))
            return {"value": float(beta[1]), "low": float(beta[1]) - half, "high": float(beta[1]) + half}
    return None
