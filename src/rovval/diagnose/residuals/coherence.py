"""Coherence of two hypotheses: the largest canonical correlation of their sensitivities (Hotelling 1936)."""

from __future__ import annotations

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.residuals.normal_equations import NormalEquations


def coherence(data: NormalEquations, a: tuple[int, ...], b: tuple[int, ...]) -> float:
    """Coherence of the hypotheses with plant slots ``a`` and ``b``, from 0 (orthogonal) to 1 (this log cannot tell them apart)."""
    both, k = np.concatenate([data.place(a), data.place(b)]), len(a)
    A = data.A[:, both[:, None], both].sum(axis=0)
    left, right = _root(A[:k, :k]), _root(A[k:, k:])
    return float(np.clip(np.linalg.svd(left @ A[:k, k:] @ right, compute_uv=False).max(initial=0.0), 0.0, 1.0))


def _root(A: Array) -> Array:
    """Inverse symmetric square root of ``A`` (k, k), in the directions that are excited."""
    values, vectors = np.linalg.eigh(A)
    keep = values > 1e-10 * max(float(values.max(initial=0.0)), 1e-300)
    return np.asarray((vectors[:, keep] / np.sqrt(values[keep])) @ vectors[:, keep].T)
