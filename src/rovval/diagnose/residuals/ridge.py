"""Ridge regression: normal equations solved under a Gaussian prior (Hoerl and Kennard 1970), and what is left after the solution."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.residuals.normal_equations import NormalEquations

ROUNDING = 1e-20  # of the most informative column: a column that says less is rounding (those of a real log: from 1e-14, rounding up to 1e-30)


@dataclass(frozen=True, slots=True)
class Prior:
    """Gaussian prior of parameters about their nominal values.

    Attributes:
        sd: standard deviation of each by itself, by column, in the parameter's unit. Columns not named are fixed.
        correlated: the c columns that are not independent of one another.
        correlation: their correlations (c, c).
    """

    sd: Mapping[int, float]
    correlated: tuple[int, ...] = ()
    correlation: Array = field(default_factory=lambda: np.eye(0))

    def covariance(self, columns: Sequence[int]) -> Array:
        """Covariance (k, k) of k ``columns``."""
        at, correlation = self._correlated(columns)
        sd = np.array([self.sd[c] for c in columns])
        found = np.diag(sd**2)
        found[np.ix_(at, at)] = correlation * np.outer(sd[at], sd[at])
        return found

    def precision(self, columns: Sequence[int]) -> Array:
        """Inverse of the covariance (k, k) of k ``columns``, whatever the others are."""
        at, correlation = self._correlated(columns)
        sd = np.array([self.sd[c] for c in columns])
        found = np.diag(sd**-2.0)
        found[np.ix_(at, at)] = np.linalg.inv(correlation) / np.outer(sd[at], sd[at])
        return found

    def _correlated(self, columns: Sequence[int]) -> tuple[list[int], Array]:
        """Places among the ``columns`` of those that are not independent, and their correlations."""
        place = {c: i for i, c in enumerate(columns)}
        known = [i for i, c in enumerate(self.correlated) if c in place]
        return [place[self.correlated[i]] for i in known], self.correlation[np.ix_(known, known)]

    def without(self, columns: Collection[int]) -> Prior:
        """The prior with these columns fixed."""
        kept = [i for i, c in enumerate(self.correlated) if c not in columns]
        sd = {c: sd for c, sd in self.sd.items() if c not in columns}
        return Prior(sd, tuple(self.correlated[i] for i in kept), self.correlation[np.ix_(kept, kept)])

    def plus(self, sd: Mapping[int, float]) -> Prior:
        """The prior of the sum of what this is of and of independent departures of standard deviations ``sd``, by column."""
        total = {**self.sd, **{c: float(np.hypot(self.sd.get(c, 0.0), more)) for c, more in sd.items()}}
        share = np.array([self.sd[c] / total[c] for c in self.correlated])
        correlation = self.correlation * np.outer(share, share)
        np.fill_diagonal(correlation, 1.0)
        return Prior(total, self.correlated, correlation)

    def off_by_more(self, sd: Mapping[int, float]) -> Prior:
        """The prior of columns that may be off by as much as they are, and besides, each by itself, by so much that ``sd`` is what they are off by in all.

        Those for which it is less stay as they are.
        """
        return self.plus({c: float(np.sqrt(sd[c] ** 2 - own**2)) for c, own in self.sd.items() if sd.get(c, 0.0) > own})


def ridge_step(data: NormalEquations, prior: Prior, design_effect: float) -> Array:
    """Ridge step (k,) of the columns of ``prior`` that fits all windows."""
    free, ridge, offset = free_columns(data, prior, design_effect)
    found = np.zeros(len(data.columns))
    found[free] = np.linalg.solve(data.A.sum(axis=0)[np.ix_(free, free)] + ridge, data.b.sum(axis=0)[free] - ridge @ offset)
    return found


def free_columns(data: NormalEquations, prior: Prior, design_effect: float) -> tuple[np.ndarray, Array, Array]:
    """Of the f columns that ``prior`` frees: places among ``data.columns`` (f,), ridge (f, f), and departure from the mean of the prior (f,)."""
    columns = tuple(prior.sd)
    free = data.place(columns)
    return free, design_effect * prior.precision(columns), np.zeros(len(free)) if data.offset is None else data.offset[free]


def eliminated(A: Array, b: Array, free: np.ndarray, ridge: Array, pull: Array) -> tuple[Array, Array]:
    """Curvature (k, k) and descent (k,) of the cost in all columns once it is minimised over those that are ``free`` (Schur complement).

    ``A`` (k, k) and ``b`` (k,) are curvature and descent of the data alone, ``ridge`` (f, f) and ``pull`` (f,) curvature and gradient of the free columns'
    prior.
    """
    if not len(free):
        return A, b
    toward = np.linalg.solve(A[np.ix_(free, free)] + ridge, np.concatenate([A[free], (b[free] - pull)[:, None]], axis=1))
    return A - A[:, free] @ toward[:, :-1], b - A[:, free] @ toward[:, -1]


def losses(data: NormalEquations, free: np.ndarray, ridge_step: Array, which: np.ndarray) -> Array:
    """Weighted squared residual (w,) of the windows ``which`` after ``ridge_step`` (f,) in the columns ``free``."""
    A, b = data.A[which][:, free[:, None], free[None, :]], data.b[which][:, free]
    return np.asarray(data.c[which] - 2 * b @ ridge_step + np.einsum("i,wij,j->w", ridge_step, A, ridge_step))


def estimated_design_effect(data: NormalEquations, ridge_step: Array) -> float:
    """Design effect of autocorrelated residuals (Kish 1965): variance of the windows' scores after ``ridge_step`` (k,) over that of white residuals, median
    over the columns that have a sensitivity; never below 1."""
    score = data.b - np.einsum("wij,j->wi", data.A, ridge_step)
    spread = (score**2).mean(axis=0)
    white = np.einsum("wii->wi", data.A).mean(axis=0)
    usable = white > ROUNDING * white.max(initial=0.0)
    return float(max(1.0, np.median(spread[usable] / white[usable]))) if usable.any() else 1.0
