"""Inner products of residual and sensitivities per window, in a weighted metric with the initial states marginalised.

With V = diag(variance) + J Sigma0 J^T (variance: noise, slop and unexplained residual of a channel at a time in the window), every
linear question, held-out gains, coherence, bootstrap, is answered from A = S^T V^-1 S, b = S^T V^-1 r and c = r^T V^-1 r of
each window (Woodbury identity; `research`: efficient-score projection with a finite prior on the initial state).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rovval.data import Array
from rovval.diagnose.linearise import Linear


@dataclass(frozen=True, slots=True)
class Products:
    """Per window: ``A`` (m, k, k), ``b`` (m, k), ``c`` (m,); ``columns`` are the plant's slot numbers of the k parameters; ``offset`` (k,)
    how far each is from where its prior stands (None: all at it)."""

    A: Array
    b: Array
    c: Array
    columns: tuple[int, ...]
    offset: Array | None = None

    def place(self, slots: tuple[int, ...]) -> np.ndarray:
        """Positions of plant slots among the columns."""
        where = {column: i for i, column in enumerate(self.columns)}
        return np.array([where[s] for s in slots], dtype=int)

    def __add__(self, other: Products) -> Products:
        return Products(self.A + other.A, self.b + other.b, self.c + other.c, self.columns, self.offset)


def joined(parts: list[Products]) -> Products:
    """Windows of several runs behind one another."""
    return Products(
        np.concatenate([p.A for p in parts]),
        np.concatenate([p.b for p in parts]),
        np.concatenate([p.c for p in parts]),
        parts[0].columns,
    )


def products(linear: Linear, ok: np.ndarray, variance: Array, spread: Array) -> Products:
    """Products of every window; ``variance`` (n, c), ``spread`` (s,) standard error of its first nuisances, which are marginalised."""
    m, k = len(linear.r), linear.S.shape[-1]
    A, b, c = np.zeros((m, k, k)), np.zeros((m, k)), np.zeros(m)
    root = 1.0 / np.sqrt(variance)
    for w in range(m):
        if not linear.valid[w]:
            continue
        weight = np.where(ok[w], root, 0.0).reshape(-1, 1)
        x = np.concatenate([linear.S[w].reshape(len(weight), k), linear.r[w].reshape(-1, 1)], axis=1) * weight
        j = linear.J[w].reshape(len(weight), -1)[:, : len(spread)] * weight * spread
        gram = x.T @ x
        cross = j.T @ x
        gram -= cross.T @ np.linalg.solve(np.eye(j.shape[1]) + j.T @ j, cross)
        A[w], b[w], c[w] = gram[:k, :k], gram[:k, k], gram[k, k]
    return Products(A, b, c, linear.columns)


def elsewhere(linear: Linear, r: Array, ok: np.ndarray, variance: Array, spread: Array) -> tuple[Array, Array]:
    """``b`` (m, k) and ``c`` (m,) of another residual ``r`` (m, n, c), the slopes as they were: a fifth of the work of `products`."""
    m, k = len(r), linear.S.shape[-1]
    b, c = np.zeros((m, k)), np.zeros(m)
    root = 1.0 / np.sqrt(variance)
    for w in np.flatnonzero(linear.valid):
        weight = np.where(ok[w], root, 0.0).reshape(-1)
        x, j = r[w].reshape(-1) * weight, linear.J[w].reshape(len(weight), -1) * weight[:, None] * spread
        x = weight * (x - j @ np.linalg.solve(np.eye(j.shape[1]) + j.T @ j, j.T @ x))
        b[w], c[w] = x @ linear.S[w].reshape(len(weight), k), x @ r[w].reshape(-1)
    return b, c


def start_corrected(linear: Linear, ok: np.ndarray, variance: Array, spread: Array) -> Array:
    """Residual (m, n, c) with the best of the first nuisances of each window, as many as ``spread`` has, taken out."""
    out = np.array(linear.r)
    root = 1.0 / np.sqrt(variance)
    for w in range(len(out)):
        weight = np.where(ok[w], root, 0.0).reshape(-1, 1)
        j = linear.J[w].reshape(len(weight), -1)[:, : len(spread)]
        jw = j * weight * spread
        x0 = np.linalg.solve(np.eye(jw.shape[1]) + jw.T @ jw, jw.T @ (linear.r[w].reshape(-1, 1) * weight))
        out[w] = (linear.r[w].reshape(-1, 1) - (j * spread) @ x0).reshape(out[w].shape)
    return np.where(ok, out, 0.0)
