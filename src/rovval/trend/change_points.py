"""Whether a series of dives has changed, when, and by how much: models of a constant, of steps and of ramps, compared by their evidence.

A series is ``y_i = a + sum_k b_k c_k(t_i) + e_i``; a column ``c`` is a step from a dive on, or a ramp that grows from a dive to the end of the
series, where it is 1. The errors have heavy tails (Student t of `TAILS` degrees of freedom: Lange, Little and Taylor 1989) and may be correlated
from dive to dive (of the first order). The prior of a size is Cauchy's, in units of the scatter (Jeffreys 1961, 5.2), that of the scatter scale-free,
and every dive is as likely a change as every other. The evidence is Laplace's at the maximum, with Fisher's information.

The expectation of a Bayes factor against the constant is 1 where the series is constant; it therefore exceeds K with a probability of 1 / K at most
(Ville 1939), and prior odds of ``rate / N`` keep the false alarms of N series together below ``rate``, however many dives there are.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import lgamma, log, pi
from typing import Literal

import numpy as np
from scipy.special import ndtri, stdtr

from rovval.core.data import Array

Kind = Literal["step", "ramp"]
Begin = tuple[Kind, int]
KINDS: tuple[Kind, ...] = ("step", "ramp")
TAILS = 4.0  # degrees of freedom of the errors
CORRELATIONS = (0.0, 0.25, 0.5, 0.75)  # from one dive to the next: the same site, load or pilot; as likely each
MOST_PLACES = 120  # dives at which a change is tried: of a longer series every second, third, ...
AT_ONCE = 16  # places that are tried together: all of them take 300 MB for ten thousand dives
ROUNDS = 12  # of reweighted least squares; the evidence then moves by less than 0.1
ALIKE = 1e-9  # columns of which less than this share of their squares differs are one
NORMAL_90 = 1.6449  # half-width of a 90 % interval in standard deviations


@dataclass(frozen=True, slots=True)
class Change:
    """One change: its kind, with the probability of this kind; likeliest dive of its begin and the 90 % interval of that; size by the end of the series
    (of a step: at once) and, of a ramp, per unit of time, each with mean and standard deviation. ``evidence`` is the log of the Bayes factor."""

    kind: Kind
    sure_of_kind: float
    place: int
    places: tuple[int, int]
    size: tuple[float, float]
    rate: tuple[float, float]
    evidence: float


def changes(t: Array, y: Array, least_scatter: float, prior_odds: float) -> tuple[Change, ...]:
    """The changes of a series ``y`` (n,) over ascending times ``t`` (n,), in the order of their begin; () where it is as constant as not.

    ``least_scatter`` is what two values differ by for no reason, in the unit of ``y``; ``prior_odds`` are those of one more change.
    """
    chosen: list[Change] = []
    while True:
        found = _one_more(t, y, _begins(chosen), least_scatter)
        added = [found] if found and found.evidence + log(prior_odds) > 0 else _pair(t, y, _begins(chosen), least_scatter, prior_odds)
        if not added:
            return tuple(sorted(chosen, key=lambda c: c.place))
        chosen += added
        for i, one in enumerate(chosen):  # beside a new one an earlier one may stand elsewhere
            chosen[i] = _one_more(t, y, _begins(c for c in chosen if c is not one), least_scatter) or one


def _begins(chosen: Iterable[Change]) -> list[Begin]:
    return [(c.kind, c.place) for c in chosen]


def _pair(t: Array, y: Array, chosen: Sequence[Begin], least: float, prior_odds: float) -> list[Change]:
    """Two changes that show only beside each other, as growth and its cleaning off; [] where they are not evident. The first is the one of the pair
    that fits best by least squares; its evidence with the place as it is, times the prior of that place, is never more than with all places."""
    places = _begin_places(t, chosen)
    if len(y) < len(chosen) + 6 or len(places) < 2:
        return []
    given = _design(t, chosen)
    columns = np.stack([_column(t, kind, j) for kind, j in places], axis=1)
    columns -= given @ (np.linalg.pinv(given) @ columns)  # what is apart from those chosen
    gram, along = columns.T @ columns, columns.T @ y
    own = np.diag(gram)
    det = own[:, None] * own[None] - gram**2
    gain = own[None] * along[:, None] ** 2 + own[:, None] * along[None] ** 2 - 2 * gram * np.outer(along, along)
    apart_enough = det > ALIKE * own[:, None] * own[None]
    if not apart_enough.any():
        return []
    first = places[int(np.unravel_index(np.argmax(np.where(apart_enough, gain, 0.0) / np.where(apart_enough, det, 1.0)), gain.shape)[0])]
    before, with_first = (_evidence(design[None], y, least)[0] for design in (given, _design(t, [*chosen, first])))
    second = _one_more(t, y, [*chosen, first], least)
    prior = -log(len(KINDS) * sum(kind == first[0] for kind, _ in places))
    if second is None or _log_sum(with_first) - _log_sum(before) + prior + second.evidence + 2 * log(prior_odds) <= 0:
        return []
    other = _one_more(t, y, [*chosen, (second.kind, second.place)], least)
    return [other, second] if other else []


def _one_more(t: Array, y: Array, chosen: Sequence[Begin], least: float) -> Change | None:
    """The likeliest kind and place of one change beside those ``chosen``; None where the series is too short for any."""
    given = _design(t, chosen)
    places = _begin_places(t, chosen)
    if len(y) < given.shape[1] + 3 or not places:  # level, scatter and the size of the change leave no dive to judge by
        return None
    before = _evidence(given[None], y, least)[0]
    parts = [places[i : i + AT_ONCE] for i in range(0, len(places), AT_ONCE)]
    designs = (np.stack([np.column_stack([given, _column(t, kind, j)]) for kind, j in part]) for part in parts)
    log_evidence, size, spread = map(np.concatenate, zip(*(_evidence(design, y, least) for design in designs), strict=True))
    prior = np.array([-log(len(KINDS) * sum(k == kind for k, _ in places)) for kind, _ in places])
    joint = log_evidence + prior[:, None]  # (places, correlations)
    weight = np.exp(joint - joint.max())
    by_kind = {kind: sum(float(w.sum()) for w, (k, _) in zip(weight, places, strict=True) if k == kind) for kind in KINDS}
    kind = max(KINDS, key=lambda k: by_kind[k])
    ours = [i for i, (k, _) in enumerate(places) if k == kind]
    where, w = np.array([places[i][1] for i in ours]), weight[ours] / weight[ours].sum()
    before_it = np.cumsum(w.sum(axis=1)) - w.sum(axis=1)
    low, high = (int(where[before_it <= q].max()) for q in (0.05, 0.95))
    between = int(np.diff(where).max(initial=1)) - 1  # dives that were not tried
    likeliest = int(where[np.argmax(w.sum(axis=1))])
    span = (t[-1] - t[where])[:, None] if kind == "ramp" else np.ones((len(where), 1))
    return Change(
        kind, by_kind[kind] / sum(by_kind.values()), likeliest, (max(low - between, 0), min(high + between, len(t) - 1)), _moments(w, size[ours], spread[ours]),
        _moments(w, size[ours] / span, spread[ours] / span), _log_sum(joint) - _log_sum(before),
    )  # fmt: skip


def _design(t: Array, begins: Sequence[Begin]) -> Array:
    """(n, k) the level and a column a change."""
    return np.stack([np.ones(len(t)), *(_column(t, kind, place) for kind, place in begins)], axis=1)


def _column(t: Array, kind: Kind, place: int) -> Array:
    """(n,) what a change of size 1 adds."""
    column: Array = (t >= t[place]).astype(float) if kind == "step" else np.maximum(t - t[place], 0.0) / (t[-1] - t[place])
    return column


def _begin_places(t: Array, chosen: Sequence[Begin]) -> list[Begin]:
    """The changes that can be told from those ``chosen`` and from the level: a ramp of the last dive alone is a step."""
    found: list[Begin] = [(kind, j) for kind in KINDS for j in _places(t, kind)]
    if not found:
        return []
    given = _design(t, chosen)
    columns = _design(t, found)[:, 1:]
    left = columns - given @ (np.linalg.pinv(given) @ columns)
    return [begin for begin, share in zip(found, (left**2).sum(axis=0) / (columns**2).sum(axis=0), strict=True) if share > ALIKE]


def _places(t: Array, kind: Kind) -> list[int]:
    """Dives at which a change can begin: the first of each time, for a step not the first of all, for a ramp not the last."""
    firsts = np.flatnonzero(np.diff(t, prepend=-np.inf) > 0)
    firsts = firsts[1:] if kind == "step" else firsts[:-1]
    return [int(j) for j in firsts[:: -(-len(firsts) // MOST_PLACES) or 1]]


def _evidence(designs: Array, y: Array, least: float) -> tuple[Array, Array, Array]:
    """Log evidence of each of ``designs`` (m, n, k) under each correlation, and mean and standard deviation of the last coefficient; (m, correlations)."""
    n, k = designs.shape[1:]
    beta, error, scale = _fitted(designs, y, least)
    fit = n * (lgamma((TAILS + 1) / 2) - lgamma(TAILS / 2) - 0.5 * log(TAILS * pi) - np.log(scale)) - (TAILS + 1) / 2 * np.log1p(error**2 / TAILS).sum(axis=1)
    fit = fit - np.log(pi * scale[:, None] * (1 + (beta[:, 1:] / scale[:, None]) ** 2)).sum(axis=1)  # the prior of the sizes
    score = np.sign(error) * -ndtri(stdtr(TAILS, -np.abs(error)))
    log_evidence, spread = np.empty((len(designs), len(CORRELATIONS))), np.empty((len(designs), len(CORRELATIONS)))
    for j, r in enumerate(CORRELATIONS):
        whitened = _whitened(designs, r)
        # Fisher's information of a location under Student's t; that of the logarithm of its scale is 2 n TAILS / (TAILS + 3)
        information = (TAILS + 1) / (TAILS + 3) * np.swapaxes(whitened, 1, 2) @ whitened / scale[:, None, None] ** 2
        sign, volume = np.linalg.slogdet(information)
        volume = np.where(sign > 0, volume, np.inf) + log(2 * n * TAILS / (TAILS + 3))
        log_evidence[:, j] = fit + _together(score, r) + 0.5 * (k + 1) * log(2 * pi) - 0.5 * volume - log(len(CORRELATIONS))
        spread[:, j] = np.sqrt(np.linalg.pinv(information, hermitian=True)[:, -1, -1])
    return log_evidence, np.repeat(beta[:, -1:], len(CORRELATIONS), axis=1), spread


def _fitted(x: Array, y: Array, least: float) -> tuple[Array, Array, Array]:
    """Coefficients (m, k), errors (m, n) in units of their scale, and scale (m,) of the designs ``x`` (m, n, k): the maximum of the likelihood."""
    weight = np.ones(x.shape[:2])
    for _ in range(ROUNDS):
        weighted = x * weight[:, :, None]
        beta = _solved(weighted, x, y)
        error = y - (x @ beta[:, :, None])[:, :, 0]
        scale = np.maximum(np.sqrt((weight * error**2).mean(axis=1)), least)
        weight = (TAILS + 1) / (TAILS + (error / scale[:, None]) ** 2)
    return beta, error / scale[:, None], scale


def _whitened(x: Array, r: float) -> Array:
    """Rows (m, n, k) without what the row before them tells of them, in units of what is left (Prais and Winsten 1954)."""
    return np.concatenate([x[:, :1], (x[:, 1:] - r * x[:, :-1]) / (1 - r * r) ** 0.5], axis=1)


def _together(score: Array, r: float) -> Array:
    """Log density (m,) of normal scores (m, n) that are correlated from one to the next, over that of independent ones: a Gaussian copula, in
    which a single outlier is one, and not the begin of another level (Song 2000)."""
    new = (score[:, 1:] - r * score[:, :-1]) ** 2 / (1 - r * r)
    density: Array = 0.5 * (score[:, 1:] ** 2 - new - log(1 - r * r)).sum(axis=1)
    return density


def _solved(weighted: Array, x: Array, y: Array) -> Array:
    """Coefficients (m, k) of weighted least squares; two columns that are alike share theirs."""
    beta: Array = (np.linalg.pinv(np.swapaxes(weighted, 1, 2) @ x, hermitian=True) @ (np.swapaxes(weighted, 1, 2) @ y)[:, :, None])[:, :, 0]
    return beta


def _moments(weight: Array, mean: Array, spread: Array) -> tuple[float, float]:
    """Mean and standard deviation of a mixture of normal distributions."""
    centre = float((weight * mean).sum())
    return centre, float(np.sqrt((weight * (spread**2 + (mean - centre) ** 2)).sum()))


def _log_sum(x: Array) -> float:
    top = float(x.max())
    return top + log(float(np.exp(x - top).sum()))
