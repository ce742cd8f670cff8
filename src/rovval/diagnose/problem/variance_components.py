"""Noise of the sensors and disturbances as large as is most likely for what a fit leaves (variance components by maximum likelihood: Harville 1977).

Both are found together, by expectation and maximisation (Dempster, Laird and Rubin 1977), extrapolated (Varadhan and Roland 2008).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from rovval.core.channels import AXES
from rovval.core.data import Array
from rovval.diagnose.criteria import LEAST_NOISE, SEGMENT_CORRELATION
from rovval.diagnose.effort import (
    COMPONENT_CYCLES,
    COMPONENT_WINDOWS,
    COMPONENT_WORTH,
    INITIAL_CORRELATION,
    INITIAL_DISTURBANCE,
    LARGEST_CHANGE,
)
from rovval.diagnose.problem.disturbance import LEAST, covariance, inverse, moments
from rovval.diagnose.residuals.normal_equations import Linearisation
from rovval.diagnose.residuals.nuisances import initial_state_sd
from rovval.diagnose.windows.windows import Windows


@dataclass(frozen=True, slots=True)
class Components:
    """Standard deviations of noise and disturbances.

    Attributes:
        share: of the force on each axis (6,), as a share of the thrusters' rms.
        correlation: of that force from one segment of a window to the next (6,).
        noise: of each channel (c,), in its unit.
    """

    share: Array
    correlation: Array
    noise: Array

    def root(self) -> Array:
        """Square root (6 s, 6 s) of the forces' covariance in the segments of a window, in squared shares of the thrusters' rms."""
        return np.asarray(np.linalg.cholesky(covariance(self.share, self.correlation)), dtype=float)

    def packed(self) -> Array:
        """As a vector (12 + c,) without bounds."""
        return np.concatenate([np.log(np.maximum(self.share, LEAST)), np.log(self.correlation / (1.0 - self.correlation)), np.log(self.noise)])

    @classmethod
    def initial(cls, noise: Array) -> Components:
        """Where the search for them begins, where nothing but some ``noise`` (c,) of each channel is known."""
        return cls(np.full(len(AXES), INITIAL_DISTURBANCE), np.full(len(AXES), INITIAL_CORRELATION), noise)

    @classmethod
    def unpacked(cls, x: Array) -> Components:
        """The reverse, correlations within their limits (`SEGMENT_CORRELATION`)."""
        axes = len(AXES)
        return cls(np.exp(x[:axes]), np.clip(1.0 / (1.0 + np.exp(-x[axes : 2 * axes])), *SEGMENT_CORRELATION), np.exp(x[2 * axes :]))


@dataclass(frozen=True, slots=True)
class _Equations:
    """Normal equations of each of c channels by itself, of unit variance, in the nuisances of m windows: ``starts`` initial states and sensor drifts, in
    standard deviations of their prior, then forces in s segments on six axes: ``A`` (c, m, k, k), ``b`` (c, m, k), ``c`` (c, m), of ``count`` samples (c, m).
    No channel has less noise than ``least`` (c,)."""

    A: Array
    b: Array
    c: Array
    count: Array
    starts: int
    least: Array


def evenly_spread(runs: Sequence[Windows]) -> slice:
    """The windows of each run that components are found from (`COMPONENT_WINDOWS`)."""
    return slice(None, None, max(1, -(-sum(windows.count for windows in runs) // COMPONENT_WINDOWS)))


def variance_components(runs: Sequence[Windows], left: Sequence[Linearisation], segments: Sequence[Array], begin: Components) -> Components:
    """The components under which the residuals of ``left`` are most likely, of some windows of all runs (`evenly_spread`), searched for from ``begin`` on.

    ``segments`` are the responses (m, n, c, 6 s) to forces of the thrusters' rms (`disturbance.segment_responses`).
    """
    data = _equations(runs, left, segments, evenly_spread(runs))
    before, x = -np.inf, replace(begin, noise=np.maximum(begin.noise, data.least)).packed()
    for _ in range(COMPONENT_CYCLES):
        _, one = _round(data, Components.unpacked(x))
        likely, two = _round(data, one)
        once, twice = one.packed() - x, two.packed() - 2.0 * one.packed() + x
        length = max(float(np.linalg.norm(once)) / max(float(np.linalg.norm(twice)), LEAST), 1.0)
        step = np.clip(2.0 * length * once + length**2 * twice, -LARGEST_CHANGE, LARGEST_CHANGE)
        further, three = _round(data, Components.unpacked(x + step))
        x = three.packed() if further >= likely else two.packed()
        if max(likely, further) - before < COMPONENT_WORTH:
            break
        before = max(likely, further)
    return Components.unpacked(x)


def _equations(runs: Sequence[Windows], left: Sequence[Linearisation], segments: Sequence[Array], which: slice) -> _Equations:
    """Those of the windows ``which`` of each run."""
    A, b, c, count = list[Array](), list[Array](), list[Array](), list[Array]()
    starts, least = len(initial_state_sd(runs[0])), np.array([LEAST_NOISE[name] for name in runs[0].channels])
    for windows, one, forces in zip(runs, left, segments, strict=True):
        sd = initial_state_sd(windows)
        for w in range(windows.count)[which]:
            ok = windows.ok[w].T
            J = np.concatenate([one.J[w, ..., : len(sd)] * sd, forces[w]], axis=-1).transpose(1, 0, 2) * ok[..., None]
            r = np.where(ok, one.r[w].T, 0.0)
            A.append(J.transpose(0, 2, 1) @ J)
            b.append((J.transpose(0, 2, 1) @ r[..., None])[..., 0])
            c.append((r**2).sum(axis=1))
            count.append(ok.sum(axis=1).astype(float))
    return _Equations(np.stack(A, axis=1), np.stack(b, axis=1), np.stack(c, axis=1), np.stack(count, axis=1), starts, least)


def _round(data: _Equations, at: Components) -> tuple[float, Components]:
    """Log likelihood of components, but for a constant, and those of the next round: second moments of the forces, and of what is left of each channel, with
    the posterior of the nuisances given the components."""
    channels, m, k, _ = data.A.shape
    weight = at.noise**-2.0
    A, b = (weight @ data.A.reshape(channels, -1)).reshape(m, k, k), np.tensordot(weight, data.b, 1)
    prior = np.eye(k)
    prior[data.starts :, data.starts :] = np.linalg.inv(covariance(at.share, at.correlation))
    cover, smaller = inverse(A + prior)
    mean = np.einsum("wij,wj->wi", cover, b)
    samples = data.count.sum(axis=1)
    volume = smaller + m * float(np.linalg.slogdet(prior)[1]) - 2.0 * float(samples @ np.log(at.noise))
    likely = 0.5 * (volume - float((weight @ data.c).sum()) + float((b * mean).sum()))
    second = cover + mean[:, :, None] * mean[:, None, :]
    left = data.c.sum(axis=1) - 2.0 * np.einsum("cwi,wi->c", data.b, mean) + data.A.reshape(channels, -1) @ second.reshape(-1)
    noise = np.maximum(np.sqrt(left / np.maximum(samples, 1.0)), data.least)
    return likely, Components(*moments(second[:, data.starts :, data.starts :]), noise)
