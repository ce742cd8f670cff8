"""Disturbances that nobody logged: slowly varying forces on each axis, as large and as slow as the log itself shows them to be.

Under an autopilot the thrusters answer whatever pushes the vehicle. A replay gets their answers without the push, and errs by both; unless
the push is a nuisance of the fit, that error is read as a fault of the model (closed-loop identification: Ljung 1999, section 13.4).
The force is constant in each of `PIECES` parts of a window, normal, and forgets itself in a time of its own; both are found by expectation
and maximisation (Dempster et al. 1977) on what the whole library and the environment leave.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from scipy.linalg import block_diag

from rovval.core.channels import AXES
from rovval.core.data import Array
from rovval.diagnose.inference.cross_validation import step
from rovval.diagnose.inference.prior import Prior
from rovval.diagnose.residuals.external_forces import forced, generic, typical_wrench
from rovval.diagnose.residuals.normal_equations import Products, joined, products
from rovval.diagnose.residuals.sensitivities import Linear, state_spread
from rovval.diagnose.windows.shooting import Stretches

PIECES = 12  # of a window in which a force holds still: 0.8 s of 10 s, well below the period at which a small ROV rolls
ROUNDS = 10  # of expectation and maximisation
FIRST, FIRST_S = 0.1, 1.0  # guesses: of the thrusters' own rms on an axis, and the time in which a force forgets itself
CORRELATION = (0.02, 0.98)  # limits of the latter
ENVIRONMENT = ("constant", "cos heading", "sin heading", "depth", "time")  # systematic forces that are no disturbance
GENERIC = 0.1  # prior size of a generic force, as a share of the same
COVERED = 0.05  # of the noise's variance: a part of a disturbance that does less than this changes no weight
LEAST = 1e-6  # of the same: smaller is none


@dataclass(frozen=True, slots=True)
class Disturbance:
    """``rms`` force (6,) N and N m of each axis, and the time (6,) s in which it forgets itself; ``pushed`` per run (m, n, c, d) is what they do
    to the windows, in independent parts of one standard deviation."""

    rms: Array
    memory_s: Array
    pushed: tuple[Array, ...]


@dataclass(frozen=True, slots=True)
class Answers:
    """What the windows answer, per run, to unit pushes in each piece of them (m, n, c, 6 * PIECES) and to steady forces of the environment
    (m, n, c, f), each as large as the thrusters' rms ``wrench`` (6,)."""

    wrench: Array
    pushed: tuple[Array, ...]
    steady: tuple[Array, ...]


def answers(parts: Sequence[Stretches], beta: Array) -> Answers:
    """Simulate them about ``beta``."""
    wrench = typical_wrench(parts)
    pushed = tuple(forced(part, beta, [(axis, series * wrench[AXES.index(axis)]) for axis, series in pushes(part)]) for part in parts)
    return Answers(wrench, pushed, tuple(generic(parts, beta, ENVIRONMENT)[1]))


def calm() -> Disturbance:
    """No disturbance, because none was looked for."""
    return Disturbance(np.zeros(len(AXES)), np.zeros(len(AXES)), ())


def undisturbed(to: Answers) -> Disturbance:
    """What the search for disturbances begins with."""
    return Disturbance(FIRST * to.wrench, np.full(len(AXES), FIRST_S), ())


def disturbance(
    parts: Sequence[Stretches], to: Answers, left: Sequence[Linear], variance: Array, inflation: float, before: Disturbance
) -> Disturbance:
    """Fit the disturbances to what ``left`` (its residuals) holds beyond steady forces, noise of ``variance`` (n, c), from those of ``before``."""
    steady = _seen(parts, left, to.steady, variance)
    strength = step(steady, Prior(dict.fromkeys(steady.columns, GENERIC)), inflation)
    less = [replace(one, r=np.where(part.ok, one.r - S @ strength, 0.0)) for part, one, S in zip(parts, left, to.steady, strict=True)]
    piece_s = (parts[0].steps + 1) * parts[0].run.dt / PIECES
    size, memory = _fitted(_seen(parts, less, to.pushed, variance), before.rms / to.wrench, np.exp(-piece_s / before.memory_s))
    mixed = np.linalg.cholesky(_covariance(size, memory))
    return Disturbance(size * to.wrench, -piece_s / np.log(memory), tuple(one @ mixed for one in to.pushed))


def pushes(part: Stretches) -> list[tuple[str, Array]]:
    """Unit force on each axis, on in one piece of every window: (axis, series on the run's grid)."""
    return [(axis, on) for axis in AXES for on in pieces(part)]


def pieces(part: Stretches, count: int = PIECES) -> list[Array]:
    """One in a piece of every window and nothing elsewhere, piece by piece, on the run's grid."""
    edges = np.linspace(0, part.steps + 1, count + 1).round().astype(int)
    found = [np.zeros(len(part.run)) for _ in range(count)]
    for on, (low, high) in zip(found, pairwise(edges), strict=True):
        on[(part.start[:, None] + np.arange(low, high)).reshape(-1)] = 1.0
    return found


def _seen(parts: Sequence[Stretches], left: Sequence[Linear], S: Sequence[Array], variance: Array) -> Products:
    """Products of residuals with other answers, start states marginalised."""
    return joined([
        products(replace(one, S=each, columns=tuple(range(each.shape[-1]))), part.ok, variance, state_spread(part))
        for part, one, each in zip(parts, left, S, strict=True)
    ])  # fmt: skip


def shown(parts: Sequence[Stretches], pushed: Sequence[Array], variance: Array) -> tuple[Array, ...]:
    """The same covariance in fewer columns: each window's principal parts, without those that noise of ``variance`` covers."""
    found, most = list[list[Array]](), 0
    for part, one in zip(parts, pushed, strict=True):
        found.append([])
        for w in range(part.count):
            weighted = np.where(part.ok[w], 1.0 / np.sqrt(variance), 0.0)[..., None] * one[w]
            power, way = np.linalg.eigh(np.einsum("tci,tcj->ij", weighted, weighted, optimize=True))
            found[-1].append(one[w] @ way[:, power > COVERED])
            most = max(most, found[-1][-1].shape[-1])
    return tuple(np.stack([np.pad(x, ((0, 0), (0, 0), (0, most - x.shape[-1]))) for x in one]) for one in found)


def _fitted(data: Products, size: Array, memory: Array) -> tuple[Array, Array]:
    """Standard deviation (6,) of the forces as shares of the thrusters' rms, and their correlation (6,) from one piece to the next."""
    for _ in range(ROUNDS):
        cover = np.linalg.inv(data.A + np.linalg.inv(_covariance(size, memory)))
        mean = np.einsum("wij,wj->wi", cover, data.b)
        square = (cover + mean[:, :, None] * mean[:, None, :]).mean(axis=0).reshape(len(AXES), PIECES, len(AXES), PIECES)
        own = np.einsum("aiaj->aij", square)
        alone, next_one = np.einsum("aii->a", own) / PIECES, np.einsum("aii->a", own[:, :-1, 1:]) / (PIECES - 1)
        size, memory = np.sqrt(alone), np.clip(next_one / alone, *CORRELATION)
    return size, memory


def _covariance(size: Array, memory: Array) -> Array:
    """(6 P, 6 P): the correlation of two pieces of an axis falls geometrically with what is between them (Ornstein and Uhlenbeck 1930)."""
    apart = np.abs(np.subtract.outer(np.arange(PIECES), np.arange(PIECES)))
    return np.asarray(block_diag(*[max(s, LEAST) ** 2 * m**apart for s, m in zip(size, memory, strict=True)]))
