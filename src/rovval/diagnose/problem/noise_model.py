"""The noise model of the residuals: what is white in them, and the disturbances that are not.

The white variance of a channel at a time in the window is sensor noise (from the log) and model-form error (what no hypothesis of the library explains
of it); in the metric in which the gap is told, tolerance and disturbances are part of it. Disturbances are found in what the whole library leaves; it
is fitted again in the metric that has them as nuisances, and so on.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.criteria import (
    DISTURBANCE_WINDOWS,
    FORM_ERROR_SMOOTHING,
    INITIAL_DESIGN_EFFECT,
    LEAST_NOISE,
    NOISE_MODEL_ROUNDS,
)
from rovval.diagnose.problem.cross_validation import Fold, FoldSums, cross_validate
from rovval.diagnose.problem.disturbance import (
    Disturbance,
    estimate_disturbance,
    initial_disturbance,
    no_disturbance,
    principal_parts,
    unit_responses,
)
from rovval.diagnose.residuals.normal_equations import (
    Linearisation,
    NormalEquations,
    concatenated,
    normal_equations,
    nuisance_corrected,
)
from rovval.diagnose.residuals.nuisances import initial_state_sd, nuisance_sd
from rovval.diagnose.residuals.ridge import Prior, estimated_design_effect
from rovval.diagnose.windows.windows import Windows


@dataclass(frozen=True, slots=True)
class NoiseModel:
    """What is known of the residuals' covariance.

    Attributes:
        runs: the windows of each run, with what disturbances of one standard deviation do to them.
        linear: linearisation of each run, disturbances among its nuisances.
        white_variance: of each channel at each time in the window (n, c), beside the disturbances.
        total_variance: the same with tolerance and disturbances in it, in which the gap is told.
        design_effect: of the autocorrelation that is left.
        disturbance: the forces that nobody logged.
    """

    runs: tuple[Windows, ...]
    linear: tuple[Linearisation, ...]
    white_variance: Array
    total_variance: Array
    design_effect: float
    disturbance: Disturbance


def fit_noise_model(
    runs: tuple[Windows, ...], linear: tuple[Linearisation, ...], columns: tuple[int, ...], tolerance: Prior, folds: tuple[Fold, ...],
    channel_factor: Array, origin: Array,
) -> NoiseModel:  # fmt: skip
    """The noise model of windows that are linearised about ``origin`` (k,), ``columns`` first; ``channel_factor`` (c,) multiplies the variances of
    channels that an autopilot holds (`windows.closed_loop`)."""
    library = Prior({c: runs[0].plant.slots[c].parameter.typical for c in columns})
    sensor, expected = _expected_variance(runs, linear, Prior({})), _expected_variance(runs, linear, tolerance)
    plain = tuple(replace(one, S=one.S[..., : len(columns)], columns=columns) for one in linear)
    first = equations_of_runs(runs, plain, expected, initial_state_sd)
    design_effect = estimated_design_effect(first, cross_validate(FoldSums.of(first, folds), library, INITIAL_DESIGN_EFFECT).step)
    best = cross_validate(FoldSums.of(first, folds), library, design_effect).step
    white = expected + _form_variance(runs, plain, expected, best)
    total = white * channel_factor
    if sum(windows.count for windows in runs) < DISTURBANCE_WINDOWS:
        design_effect, _ = _library_fit(runs, linear, total, library, folds, design_effect)
        return NoiseModel(runs, linear, total, total, design_effect, no_disturbance())
    responses = unit_responses(runs, origin)
    disturbance = initial_disturbance(responses)
    for _ in range(NOISE_MODEL_ROUNDS):
        left = [replace(one, r=np.where(windows.ok, one.r - one.S @ best, 0.0)) for windows, one in zip(runs, plain, strict=True)]
        disturbance = estimate_disturbance(runs, responses, left, white, design_effect, disturbance)
        disturbed, beside = _with_disturbances(runs, plain, disturbance.response)
        white = sensor + _form_variance(disturbed, beside, expected, best)
        design_effect, best = _library_fit(disturbed, beside, white * channel_factor, library, folds, design_effect)
    runs, linear = _with_disturbances(runs, linear, principal_parts(runs, disturbance.response, white))
    return NoiseModel(runs, linear, white * channel_factor, total, design_effect, disturbance)


def equations_of_runs(
    runs: Sequence[Windows], linear: Sequence[Linearisation], variance: Array, sd: Callable[[Windows], Array]
) -> NormalEquations:
    """Normal equations of every run's windows behind one another, weighed by ``variance`` (n, c), the nuisances of which ``sd`` gives the standard
    deviations marginalised."""
    return concatenated([normal_equations(one, windows.ok, variance, sd(windows)) for windows, one in zip(runs, linear, strict=True)])


def _library_fit(
    runs: Sequence[Windows], linear: Sequence[Linearisation], variance: Array, library: Prior, folds: Sequence[Fold], before: float
) -> tuple[float, Array]:
    """Design effect of what the whole library leaves in this metric, and the step (k,) that fits the library there."""
    data = equations_of_runs(runs, linear, variance, nuisance_sd)
    best = cross_validate(FoldSums.of(data, folds), library, before).step
    return estimated_design_effect(data, best), best


def _with_disturbances(
    runs: Sequence[Windows], linear: Sequence[Linearisation], response: Sequence[Array]
) -> tuple[tuple[Windows, ...], tuple[Linearisation, ...]]:
    """Windows and linearisations with disturbances as nuisances, of ``response`` (m, n, c, d) each."""
    known = tuple(replace(windows, disturbance_response=one) for windows, one in zip(runs, response, strict=True))
    return known, tuple(replace(one, J=np.concatenate([one.J, more], axis=-1)) for one, more in zip(linear, response, strict=True))


def _expected_variance(runs: Sequence[Windows], linear: Sequence[Linearisation], tolerance: Prior) -> Array:
    """Variance of each channel at each time in the window (n, c) by sensor noise and by coefficients that are off within ``tolerance``."""
    least = np.array([LEAST_NOISE[c] for c in runs[0].channels])
    noise = np.maximum(np.mean([windows.noise for windows in runs], axis=0), least)
    total = np.tile(noise**2, (runs[0].steps + 1, 1))
    count = sum(windows.count for windows in runs)
    for one in linear:
        place = [one.columns.index(c) for c in tolerance.sd]
        sd = np.array(list(tolerance.sd.values()))
        total = total + np.einsum("wtck,k->tc", one.S[..., place] ** 2, sd**2) / count
    return total


def _form_variance(runs: Sequence[Windows], linear: Sequence[Linearisation], variance: Array, step: Array) -> Array:
    """Model-form error: mean square (n, c) of what the whole library leaves after its best ``step`` (k,), smoothed along the window."""
    total, count = np.zeros_like(variance), np.zeros_like(variance)
    for windows, one in zip(runs, linear, strict=True):
        left = replace(one, r=np.where(windows.ok, one.r - one.S @ step, 0.0))
        rest = nuisance_corrected(left, windows.ok, variance, nuisance_sd(windows))
        total += (rest**2 * windows.ok).sum(axis=0)
        count += windows.ok.sum(axis=0)
    kernel = np.ones(FORM_ERROR_SMOOTHING) / FORM_ERROR_SMOOTHING
    mean = total / np.maximum(count, 1)
    padded = np.pad(mean, ((FORM_ERROR_SMOOTHING // 2, FORM_ERROR_SMOOTHING // 2), (0, 0)), mode="edge")
    return np.stack([np.convolve(padded[:, i], kernel, mode="valid") for i in range(mean.shape[1])], axis=1)
