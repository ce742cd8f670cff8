"""Normal equations of each window in a weighted metric, nuisance parameters marginalised.

With V = diag(variance) + J Sigma0 J^T (variance: noise, tolerance and unexplained residual of a channel at a time in the window), every
linear question, held-out gains, coherence, bootstrap, is answered from A = S^T V^-1 S, b = S^T V^-1 r and c = r^T V^-1 r of
each window (Woodbury identity; where the prior on the initial state is flat, the efficient score of van der Vaart 1998, 25.4).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg.lapack import dtrtri

from rovval.core.data import Array
from rovval.core.large_arrays import columns_first, joined, zeros


@dataclass(frozen=True, slots=True)
class NormalEquations:
    """Normal equations of m windows in k parameters: a step d costs c - 2 b.d + d.A d.

    Attributes:
        A: S^T V^-1 S of each window (m, k, k).
        b: S^T V^-1 r of each window (m, k).
        c: r^T V^-1 r of each window (m,).
        columns: the plant's slot numbers of the k parameters.
        offset: how far each parameter is from the mean of its prior (k,); None where all are at it.
    """

    A: Array
    b: Array
    c: Array
    columns: tuple[int, ...]
    offset: Array | None = None

    def place(self, slots: tuple[int, ...]) -> np.ndarray:
        """Positions of plant slots among the columns."""
        where = {column: i for i, column in enumerate(self.columns)}
        return np.array([where[s] for s in slots], dtype=int)

    def part(self, which: slice) -> NormalEquations:
        """Those of the windows ``which``."""
        return replace(self, A=self.A[which], b=self.b[which], c=self.c[which])

    def summed(self) -> NormalEquations:
        """Those of all windows in one (1, ...)."""
        return replace(self, A=self.A.sum(axis=0, keepdims=True), b=self.b.sum(axis=0, keepdims=True), c=self.c.sum(keepdims=True))

    def after(self, step: Array) -> NormalEquations:
        """Those after a ``step`` (k,), in the linearised model."""
        toward = self.A @ step
        return replace(self, b=self.b - toward, c=self.c - 2.0 * self.b @ step + toward @ step)

    def __add__(self, other: NormalEquations) -> NormalEquations:
        A = np.add(self.A, other.A, out=zeros(*self.A.shape))
        return NormalEquations(A, self.b + other.b, self.c + other.c, self.columns, self.offset)


def concatenated(parts: list[NormalEquations]) -> NormalEquations:
    """Normal equations of the windows of several runs, in their order."""
    if len(parts) == 1:
        return replace(parts[0], offset=None)
    return NormalEquations(
        joined(*(p.A for p in parts)),
        np.concatenate([p.b for p in parts]),
        np.concatenate([p.c for p in parts]),
        parts[0].columns,
    )


def gathered(parts: Iterable[NormalEquations], m: int) -> NormalEquations:
    """Normal equations of ``m`` windows in all, of which ``parts`` are made a few windows at a time, in their order."""
    at, found = 0, NormalEquations(zeros(0, 0, 0), np.zeros((0, 0)), np.zeros(0), ())
    for part in parts:
        if not at:
            k = len(part.columns)
            found = NormalEquations(zeros(m, k, k), np.zeros((m, k)), np.zeros(m), part.columns)
        here = slice(at, at + len(part.c))
        found.A[here], found.b[here], found.c[here], at = part.A, part.b, part.c, here.stop
    return found


@dataclass(frozen=True, slots=True)
class WhitenedColumns:
    """Sensitivities ``x`` (m, n c, k) over the standard errors of the samples, and ``y`` = q^T x (m, s, k) for the nuisances q of `Whitened`."""

    x: Array
    y: Array

    def onto(self, scaled: Array, z: Array) -> Array:
        """S^T V^-1 r (m, k) of residuals over the standard errors ``scaled`` (m, n c), ``z`` = q^T r (m, s)."""
        return _onto(self.x, scaled) - _onto(self.y, z)


@dataclass(frozen=True, slots=True)
class Whitened:
    """A linearisation in the metric V = diag(variance) + J Sigma0 J^T, from which normal equations of many residuals are quick.

    Attributes:
        r, J, columns, valid: as of `Linearisation`.
        root: inverse standard error of each sample (m, n c); 0 where nothing was measured.
        q: nuisances (m, n c, s) over the standard errors, orthogonalised so that S^T V^-1 S = x^T x - y^T y.
        blocks: sensitivities to the k columns and maybe to others, some of them shared with other linearisations; those in a window that is not
            ``valid`` are none.
        place: where each of the columns stands in the blocks, one behind the other (k,).
        A: S^T V^-1 S (m, k, k).
    """

    r: Array
    J: Array
    columns: tuple[int, ...]
    valid: np.ndarray
    root: Array
    q: Array
    blocks: tuple[WhitenedColumns, ...]
    place: np.ndarray
    A: Array

    @property
    def linear(self) -> Linearisation:
        """The linearisation itself; sensitivities are 0 where nothing was measured."""
        m, n, c = self.r.shape
        S = columns_first(m, n, c, columns=len(self.columns))
        for w in np.flatnonzero(self.valid):
            root = np.where(self.root[w] > 0, self.root[w], 1.0)
            x = np.concatenate([block.x[w].T for block in self.blocks])[self.place].T
            S[w] = (x / root[:, None]).reshape(n, c, -1)
        return Linearisation(self.r, S, self._where_valid(self.J), self.columns, self.valid)

    def after(self, step: Array) -> Linearisation:
        """Residuals after a ``step`` (k,), in the linearised model, and the nuisances: a linearisation without columns."""
        ends = np.cumsum([block.x.shape[-1] for block in self.blocks])
        each = np.zeros(int(ends[-1]))
        each[self.place] = step
        moved = sum(block.x @ own for block, own in zip(self.blocks, np.split(each, ends[:-1]), strict=True))
        left = self.r - self._where_valid(np.divide(moved, self.root, out=np.zeros_like(self.root), where=self.root > 0.0)).reshape(self.r.shape)
        return Linearisation(left, np.zeros((*left.shape, 0)), self._where_valid(self.J), (), self.valid)

    def normal_equations(self, r: Array) -> NormalEquations:
        """Normal equations of other residuals ``r`` (m, n, c) with these sensitivities."""
        scaled = r.reshape(self.root.shape) * self.root
        z = self._where_valid(_onto(self.q, scaled))
        b = self._where_valid(np.concatenate([block.onto(scaled, z) for block in self.blocks], axis=1)[:, self.place])
        return NormalEquations(self.A, b, (scaled**2).sum(axis=1) - (z**2).sum(axis=1), self.columns)

    def _where_valid(self, values: Array) -> Array:
        """Values of every window (m, ...), zero in windows that stop."""
        return values if self.valid.all() else np.where(self.valid.reshape(-1, *[1] * (values.ndim - 1)), values, 0.0)


def normal_equations(
    linear: Linearisation, ok: np.ndarray, variance: Array, spread: Array, further: Linearisation | None = None, groups: np.ndarray | None = None
) -> NormalEquations:
    """Normal equations of every window of ``linear``, or of all windows of each group as of one.

    Args:
        linear: residuals and sensitivities.
        ok: where residuals hold a measurement (m, n, c).
        variance: white part of their covariance (n, c).
        spread: prior standard deviation (s,) of the first s nuisances, which are marginalised; the others are left out.
        further: sensitivities of the same windows to further columns, behind these.
        groups: which windows are of which group (f, m), each of one.
    """
    columns = linear.columns if further is None else (*linear.columns, *further.columns)
    f, k = len(linear.r) if groups is None else len(groups), len(columns)
    A, b, c = zeros(f, k, k), np.zeros((f, k)), np.zeros(f)
    for w, g in enumerate(np.arange(f) if groups is None else np.argmax(groups, axis=0)):
        root, q, x, y = _window(linear, w, ok, variance, spread)
        if further is not None:
            x = np.concatenate([x.T, further.S[w].reshape(len(root), -1).T * root]).T
            y = q.T @ x
        r = linear.r[w].reshape(-1) * root
        z = q.T @ r
        A[g] += x.T @ x - y.T @ y
        b[g] += x.T @ r - y.T @ z
        c[g] += r @ r - z @ z
    return NormalEquations(A, b, c, columns)


def whiten(linear: Linearisation, ok: np.ndarray, variance: Array, spread: Array) -> Whitened:
    """A linearisation in the metric, kept for normal equations with further residuals; arguments as of `normal_equations`."""
    m, n, k = len(linear.r), linear.r[0].size, linear.S.shape[-1]
    root, q, x = np.empty((m, n)), zeros(m, n, len(spread)), columns_first(m, n, columns=k)
    y, A = np.empty((m, len(spread), k)), zeros(m, k, k)
    for w in range(m):
        root[w], q[w], x[w], y[w] = _window(linear, w, ok, variance, spread)
        A[w] = x[w].T @ x[w] - y[w].T @ y[w]
    return Whitened(linear.r, linear.J, linear.columns, linear.valid, root, q, (WhitenedColumns(x, y),), np.arange(k), A)


def with_frozen_columns(own: Linearisation, other: Whitened, columns: tuple[int, ...]) -> Whitened:
    """A linearisation with further ``columns`` whose sensitivities, and those to the nuisances, are taken from another one at a point nearby."""
    there, k, m = np.array([other.columns.index(c) for c in columns], dtype=int), len(own.columns), len(own.r)
    x = columns_first(m, other.root.shape[1], columns=k)
    x[:] = own.S.reshape(*other.root.shape, k) * other.root[..., None]
    mine = WhitenedColumns(x, _gram(other.q, x))
    place = np.concatenate([np.arange(k), k + other.place[there]])
    A = zeros(m, k + len(there), k + len(there))
    A[:, k:, k:] = other.A[:, there][..., there]
    if k:
        products = np.concatenate([_gram(x, block.x) - _gram(mine.y, block.y) for block in (mine, *other.blocks)], axis=-1)
        A[:, :k] = products[..., place]
        A[:, k:, :k] = np.swapaxes(A[:, :k, k:], 1, 2)
    A[~own.valid] = 0.0  # the other's slopes there are of a window that ran
    return Whitened(own.r, other.J, (*own.columns, *columns), own.valid, other.root, other.q, (mine, *other.blocks), place, A)


def _window(linear: Linearisation, w: int, ok: np.ndarray, variance: Array, spread: Array) -> tuple[Array, Array, Array, Array]:
    """Of one window: inverse standard errors (n c,), orthogonalised nuisances q (n c, s), scaled sensitivities x (n c, k), and q^T x (s, k)."""
    root = np.where(ok[w], 1.0 / np.sqrt(variance), 0.0).reshape(-1)
    x = linear.S[w].reshape(len(root), -1) * root[:, None]
    j = linear.J[w].reshape(len(root), -1)[:, : len(spread)] * root[:, None] * spread
    inverse, _ = dtrtri(np.linalg.cholesky(np.eye(j.shape[1]) + j.T @ j), lower=1)  # well conditioned: no smaller than one
    q = j @ inverse.T
    return root, q, x, q.T @ x


def _onto(a: Array, b: Array) -> Array:
    """a^T b of every window: (m, n, k), (m, n) -> (m, k)."""
    return np.asarray((b[:, None, :] @ a)[:, 0])


def _gram(a: Array, b: Array) -> Array:
    """a^T b of every window: (m, n, k), (m, n, l) -> (m, k, l)."""
    return np.asarray(np.swapaxes(a, 1, 2) @ b)


def nuisance_corrected(linear: Linearisation, ok: np.ndarray, variance: Array, spread: Array) -> Array:
    """Residuals (m, n, c) less their MAP fit by the first s nuisances of each window; arguments as of `normal_equations`."""
    out = np.array(linear.r)
    root = 1.0 / np.sqrt(variance)
    for w in range(len(out)):
        weight = np.where(ok[w], root, 0.0).reshape(-1, 1)
        j = linear.J[w].reshape(len(weight), -1)[:, : len(spread)]
        jw = j * weight * spread
        x0 = np.linalg.solve(np.eye(jw.shape[1]) + jw.T @ jw, jw.T @ (linear.r[w].reshape(-1, 1) * weight))
        out[w] = (linear.r[w].reshape(-1, 1) - (j * spread) @ x0).reshape(out[w].shape)
    return np.where(ok, out, 0.0)


@dataclass(frozen=True, slots=True)
class Linearisation:
    """A linear model of the residuals of m windows of n samples of c channels about one parameter point: r - S d - J x for a step d.

    A simulation that stops holds its last state. A window in which that happens at the point itself costs what it errs and has no sensitivities;
    where it happens a finite difference away, that sensitivity is zero in that window.

    Attributes:
        r: residuals, measured minus simulated (m, n, c), in the channel's unit.
        S: sensitivity of the simulation to each parameter (m, n, c, k).
        J: sensitivity of the simulation to each nuisance parameter (m, n, c, s): initial states, sensor drift, then disturbances.
        columns: the plant's slot numbers of the k parameters.
        valid: windows (m,) in which the simulation does not stop.
    """

    r: Array
    S: Array
    J: Array
    columns: tuple[int, ...]
    valid: np.ndarray
