"""Disturbances that nobody logged: slowly varying forces on each axis, as large and as slow as the log itself shows them to be.

Under an autopilot the thrusters answer whatever pushes the vehicle. A replay gets their answers without the push, and errs by both; unless the push
is a nuisance of the fit, that error is read as a fault of the model (closed-loop identification: Ljung 1999, section 13.4). The force on an axis is
an Ornstein-Uhlenbeck process (Uhlenbeck and Ornstein 1930), constant in each of `DISTURBANCE_SEGMENTS` segments of a window; its standard deviation and its
correlation time are found by expectation and maximisation (Dempster, Laird and Rubin 1977) on what the whole library and steady forces of the
environment leave.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from scipy.linalg import block_diag
from scipy.linalg.lapack import dpotrf, dpotri

from rovval.core.channels import AXES
from rovval.core.data import Array
from rovval.core.large_arrays import zeros
from rovval.diagnose.criteria import MATERIAL, SEGMENT_CORRELATION, STEADY_FORCE_SD
from rovval.diagnose.effort import DISTURBANCE_ROUNDS, DISTURBANCE_SEGMENTS, INITIAL_DISTURBANCE, INITIAL_MEMORY_S
from rovval.diagnose.residuals.external_forces import force_sensitivities, generic_force_responses, typical_wrench
from rovval.diagnose.residuals.normal_equations import Linearisation, NormalEquations, concatenated, normal_equations
from rovval.diagnose.residuals.nuisances import initial_state_sd
from rovval.diagnose.residuals.ridge import Prior, ridge_step
from rovval.diagnose.windows.windows import Windows

ENVIRONMENT = ("constant", "cos heading", "sin heading", "depth", "time")  # systematic forces that are no disturbance
LEAST = 1e-6  # of the thrusters' rms on an axis: smaller is none, and a covariance stays invertible


@dataclass(frozen=True, slots=True)
class Disturbance:
    """Forces that nobody logged.

    Attributes:
        rms: standard deviation of the force on each axis (6,), N and N m.
        memory_s: time (6,) in which the force on each axis loses a share 1 - 1/e of its correlation, in seconds.
        response: what they do to the windows of each run (m, n, c, d), in d independent parts of one standard deviation.
    """

    rms: Array
    memory_s: Array
    response: tuple[Array, ...]


@dataclass(frozen=True, slots=True)
class UnitResponses:
    """What forces of the thrusters' rms on each axis do to the residual channels.

    Attributes:
        wrench: rms of the thrusters on each axis (6,), N and N m.
        segments: response of each run's windows (m, n, c, 6 s) to such a force on one axis in one of their s segments.
        steady: response of each run's windows (m, n, c, f) to steady forces of the environment.
    """

    wrench: Array
    segments: tuple[Array, ...]
    steady: tuple[Array, ...]


def unit_responses(runs: Sequence[Windows], beta: Array) -> UnitResponses:
    """Simulate the responses about ``beta`` (k,)."""
    wrench = typical_wrench(runs)
    return UnitResponses(wrench, segment_responses(runs, beta, wrench), tuple(generic_force_responses(runs, beta, ENVIRONMENT)[1]))


def segment_responses(runs: Sequence[Windows], beta: Array, wrench: Array) -> tuple[Array, ...]:
    """Response of each run's windows (m, n, c, 6 s) about ``beta`` (k,) to a force of ``wrench`` (6,), N and N m, on one axis in one of their s segments."""
    return tuple(
        force_sensitivities(windows, beta, [(axis, series * wrench[AXES.index(axis)]) for axis, series in unit_forces(windows)])
        for windows in runs
    )


def no_disturbance() -> Disturbance:
    """No disturbance, because none was looked for."""
    return Disturbance(np.zeros(len(AXES)), np.zeros(len(AXES)), ())


def initial_disturbance(responses: UnitResponses) -> Disturbance:
    """The guess that expectation and maximisation begins with."""
    return Disturbance(INITIAL_DISTURBANCE * responses.wrench, np.full(len(AXES), INITIAL_MEMORY_S), ())


def estimate_disturbance(
    runs: Sequence[Windows], responses: UnitResponses, left: Sequence[Linearisation], variance: Array, design_effect: float,
    before: Disturbance,
) -> Disturbance:  # fmt: skip
    """Fit the disturbances to what the residuals of ``left`` hold beyond steady forces and white noise of ``variance`` (n, c), beginning with those
    of ``before``."""
    steady = _equations(runs, left, responses.steady, variance)
    strength = ridge_step(steady, Prior(dict.fromkeys(steady.columns, STEADY_FORCE_SD)), design_effect)
    less = [
        replace(one, r=np.where(windows.ok, one.r - S @ strength, 0.0))
        for windows, one, S in zip(runs, left, responses.steady, strict=True)
    ]
    segment_s = (runs[0].steps + 1) * runs[0].run.dt / DISTURBANCE_SEGMENTS
    share, correlation = before.rms / responses.wrench, np.exp(-segment_s / before.memory_s)
    share, correlation = _expectation_maximisation(_equations(runs, less, responses.segments, variance), share, correlation)
    root = np.asarray(np.linalg.cholesky(covariance(share, correlation)), dtype=float)
    return Disturbance(share * responses.wrench, -segment_s / np.log(correlation), tuple(correlated(one, root) for one in responses.segments))


def unit_forces(windows: Windows) -> list[tuple[str, Array]]:
    """A unit force on each axis in one segment of every window: (axis, series (run,) on the run's grid) of each."""
    return [(axis, on) for axis in AXES for on in segment_indicators(windows)]


def segment_indicators(windows: Windows, count: int = DISTURBANCE_SEGMENTS) -> list[Array]:
    """Series (run,) on the run's grid that are one in the first, second, ... of ``count`` segments of every window, and zero elsewhere."""
    edges = np.linspace(0, windows.steps + 1, count + 1).round().astype(int)
    found = [np.zeros(len(windows.run)) for _ in range(count)]
    for on, (low, high) in zip(found, pairwise(edges), strict=True):
        on[(windows.start[:, None] + np.arange(low, high)).reshape(-1)] = 1.0
    return found


def principal_parts(runs: Sequence[Windows], response: Sequence[Array], variance: Array) -> tuple[Array, ...]:
    """The same covariance in fewer columns (m, n, c, d): each window's principal components, but for those that noise of ``variance`` (n, c) covers."""
    found, most = list[list[Array]](), 0
    for windows, one in zip(runs, response, strict=True):
        found.append([])
        for w in range(windows.count):
            weighted = np.where(windows.ok[w], 1.0 / np.sqrt(variance), 0.0)[..., None] * one[w]
            power, way = np.linalg.eigh(np.einsum("tci,tcj->ij", weighted, weighted, optimize=True))
            found[-1].append(one[w] @ way[:, power > MATERIAL])
            most = max(most, found[-1][-1].shape[-1])
    return tuple(np.stack([np.pad(x, ((0, 0), (0, 0), (0, most - x.shape[-1]))) for x in one]) for one in found)


def _equations(runs: Sequence[Windows], left: Sequence[Linearisation], S: Sequence[Array], variance: Array) -> NormalEquations:
    """Normal equations of residuals with other sensitivities (m, n, c, f), initial states marginalised."""
    return concatenated([
        normal_equations(replace(one, S=each, columns=tuple(range(each.shape[-1]))), windows.ok, variance, initial_state_sd(windows))
        for windows, one, each in zip(runs, left, S, strict=True)
    ])  # fmt: skip


def _expectation_maximisation(data: NormalEquations, share: Array, correlation: Array) -> tuple[Array, Array]:
    """Standard deviation (6,) of the forces as shares of the thrusters' rms, and their correlation (6,) from one segment to the next.

    Expectation: posterior mean and covariance of every window's forces. Maximisation: their mean second moments over windows and segments.
    """
    for _ in range(DISTURBANCE_ROUNDS):
        cover, _ = inverse(data.A + np.linalg.inv(covariance(share, correlation)))
        mean = np.einsum("wij,wj->wi", cover, data.b)
        share, correlation = moments(cover + mean[:, :, None] * mean[:, None, :])
    return share, correlation


def inverse(information: Array) -> tuple[Array, float]:
    """Inverses (m, k, k) of positive definite matrices, by their Cholesky factors, and the sum of the logarithms of these inverses' determinants."""
    found, log_det = np.empty_like(information), 0.0
    for matrix, own in zip(information, found, strict=True):
        root, failed = dpotrf(matrix, lower=1)
        if failed:
            raise np.linalg.LinAlgError("a matrix that is not positive definite")
        log_det -= 2.0 * float(np.log(np.diagonal(root)).sum())
        own[:] = dpotri(root, lower=1, overwrite_c=1)[0]
    at = np.arange(information.shape[-1])
    found[:, at, at] *= 0.5
    return found + np.swapaxes(found, 1, 2), log_det


def moments(second: Array) -> tuple[Array, Array]:
    """Standard deviation (6,) and correlation (6,) of forces of which the posterior second moments (m, 6 s, 6 s) in m windows are given."""
    own = np.einsum("aiaj->aij", second.mean(axis=0).reshape(len(AXES), DISTURBANCE_SEGMENTS, len(AXES), DISTURBANCE_SEGMENTS))
    alone, next_one = np.einsum("aii->a", own) / DISTURBANCE_SEGMENTS, np.einsum("aii->a", own[:, :-1, 1:]) / (DISTURBANCE_SEGMENTS - 1)
    return np.sqrt(alone), np.clip(next_one / alone, *SEGMENT_CORRELATION)


def covariance(share: Array, correlation: Array) -> Array:
    """Covariance (6 s, 6 s) of the forces in the s segments of a window: correlation falls geometrically with the number of segments between."""
    apart = np.abs(np.subtract.outer(np.arange(DISTURBANCE_SEGMENTS), np.arange(DISTURBANCE_SEGMENTS)))
    return np.asarray(block_diag(*[max(s, LEAST) ** 2 * m**apart for s, m in zip(share, correlation, strict=True)]))


def correlated(response: Array, root: Array) -> Array:
    """Responses (m, n, c, d) to forces that are ``root`` (d, d) times independent ones, to those."""
    return np.matmul(response, root, out=zeros(*response.shape))
