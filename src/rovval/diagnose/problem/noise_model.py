"""The noise model of the residuals: their white variance, and disturbances.

The white variance of a channel at a time in the window is that of sensor noise (from the log) and of model-form error (what a fit of the whole library
leaves of the residuals); in the metric of the gap it is also that of tolerances and disturbances. Disturbances are estimated from what the library
leaves; then the library is fitted again with them as nuisances, and so on (`NOISE_MODEL_ROUNDS`), the form error of each round weighed in the noise of
the one before. In the fine metric both are as large as is most likely for what the library leaves, and nothing is allowed for form error.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rovval.core.data import Array
from rovval.core.large_arrays import side_by_side
from rovval.diagnose.criteria import FEW_WINDOWS, LEAST_NOISE, SMOOTHING
from rovval.diagnose.effort import COMPONENT_ROUNDS, INITIAL_DESIGN_EFFECT, NOISE_MODEL_ROUNDS
from rovval.diagnose.problem.cross_validation import Fold, by_fold, cross_validate
from rovval.diagnose.problem.disturbance import (
    Disturbance,
    correlated,
    estimate_disturbance,
    initial_disturbance,
    no_disturbance,
    principal_parts,
    unit_responses,
)
from rovval.diagnose.problem.variance_components import Components, variance_components
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
        runs: the windows of each run, with their response to disturbances.
        linear: linearisation of each run, disturbances among its nuisances.
        white_variance: of each channel at each time in the window (n, c), beside the disturbances.
        total_variance: the same with tolerance and disturbances in it, of the metric of the gap.
        design_effect: of the autocorrelation that is left.
        disturbance: the forces that nobody logged.
        components: noise and disturbances of the fine metric; None where disturbances are not looked for.
    """

    runs: tuple[Windows, ...]
    linear: tuple[Linearisation, ...]
    white_variance: Array
    total_variance: Array
    design_effect: float
    disturbance: Disturbance
    components: Components | None = None


def fit_noise_model(
    runs: tuple[Windows, ...], linear: tuple[Linearisation, ...], columns: tuple[int, ...], tolerance: Prior, folds: tuple[Fold, ...],
    channel_factor: Array, origin: Array,
) -> NoiseModel:  # fmt: skip
    """Estimate the noise model.

    Args:
        runs: the windows of each run.
        linear: linearisation of each run about the nominal vehicle, ``columns`` first.
        columns: slots that the library is fitted with, each with its typical size as prior.
        tolerance: prior of a healthy vehicle.
        folds: of the cross-validation.
        channel_factor: on the variance of each channel (c,), for the loop gain of an autopilot (`windows.closed_loop`).
        origin: parameters of the nominal vehicle.
    """
    library = Prior({c: runs[0].plant.slots[c].parameter.typical for c in columns})
    sensor, expected = _expected_variance(runs, linear, Prior({})), _expected_variance(runs, linear, tolerance)
    plain = tuple(replace(one, S=one.S[..., : len(columns)], columns=columns) for one in linear)
    first = equations_of_runs(runs, plain, expected, initial_state_sd)
    design_effect = estimated_design_effect(first, cross_validate(by_fold(first, folds), library, INITIAL_DESIGN_EFFECT).step)
    best = cross_validate(by_fold(first, folds), library, design_effect).step
    white = expected + _form_variance(runs, plain, expected, best)
    total = white * channel_factor
    if sum(windows.count for windows in runs) < FEW_WINDOWS:
        design_effect, _ = _library_fit(runs, linear, total, library, folds, design_effect)
        return NoiseModel(runs, linear, total, total, design_effect, no_disturbance())
    responses = unit_responses(runs, origin)
    disturbance = initial_disturbance(responses)
    for _ in range(NOISE_MODEL_ROUNDS):
        left = [replace(one, r=np.where(windows.ok, one.r - one.S @ best, 0.0)) for windows, one in zip(runs, plain, strict=True)]
        disturbance = estimate_disturbance(runs, responses, left, white, design_effect, disturbance)
        disturbed, beside = _with_disturbances(runs, plain, disturbance.response)
        white = sensor + _form_variance(disturbed, beside, white, best)
        design_effect, best = _library_fit(disturbed, beside, white * channel_factor, library, folds, design_effect)
    components: Components | None = None
    for _ in range(COMPONENT_ROUNDS):
        if components:
            disturbed, beside = _with_disturbances(runs, plain, [correlated(segments, components.root()) for segments in responses.segments])
            _, best = _library_fit(disturbed, beside, np.tile(components.noise**2, (len(white), 1)), library, folds, design_effect)
        left = [replace(one, r=np.where(windows.ok, one.r - one.S @ best, 0.0)) for windows, one in zip(runs, plain, strict=True)]
        components = variance_components(runs, left, responses.segments, components or Components.initial(np.sqrt(white.mean(axis=0))))
    runs, linear = _with_disturbances(runs, linear, principal_parts(runs, disturbance.response, white))
    return NoiseModel(runs, linear, white * channel_factor, total, design_effect, disturbance, components)


def equations_of_runs(
    runs: Sequence[Windows], linear: Sequence[Linearisation], variance: Array, sd: Callable[[Windows], Array]
) -> NormalEquations:
    """Normal equations of the windows of all runs, in their order, with white ``variance`` (n, c) and the nuisances of which ``sd`` gives the prior standard
    deviations."""
    return concatenated([normal_equations(one, windows.ok, variance, sd(windows)) for windows, one in zip(runs, linear, strict=True)])


def _library_fit(
    runs: Sequence[Windows], linear: Sequence[Linearisation], variance: Array, library: Prior, folds: Sequence[Fold], before: float
) -> tuple[float, Array]:
    """Design effect of what the whole library leaves in this metric, and the step (k,) that fits the library there."""
    data = equations_of_runs(runs, linear, variance, nuisance_sd)
    best = cross_validate(by_fold(data, folds), library, before).step
    return estimated_design_effect(data, best), best


def _with_disturbances(
    runs: Sequence[Windows], linear: Sequence[Linearisation], response: Sequence[Array]
) -> tuple[tuple[Windows, ...], tuple[Linearisation, ...]]:
    """Windows and linearisations with disturbances as nuisances, of ``response`` (m, n, c, d) each."""
    known = tuple(replace(windows, disturbance_response=one) for windows, one in zip(runs, response, strict=True))
    return known, tuple(replace(one, J=side_by_side(one.J, more)) for one, more in zip(linear, response, strict=True))


def _expected_variance(runs: Sequence[Windows], linear: Sequence[Linearisation], tolerance: Prior) -> Array:
    """Variance of each channel at each time in the window (n, c) by sensor noise and by coefficients that are off within ``tolerance``."""
    least = np.array([LEAST_NOISE[c] for c in runs[0].channels])
    noise = np.maximum(np.mean([windows.noise for windows in runs], axis=0), least)
    total = np.tile(noise**2, (runs[0].steps + 1, 1))
    count, covariance = sum(windows.count for windows in runs), tolerance.covariance(tuple(tolerance.sd))
    for one in linear:
        place = [one.columns.index(c) for c in tolerance.sd]
        for S in one.S:
            total = total + ((S[..., place] @ covariance) * S[..., place]).sum(axis=-1) / count
    return total


def _form_variance(runs: Sequence[Windows], linear: Sequence[Linearisation], variance: Array, step: Array) -> Array:
    """Model-form error: mean square (n, c) of what the whole library leaves after its best ``step`` (k,), smoothed along the window."""
    total, count = np.zeros_like(variance), np.zeros_like(variance)
    for windows, one in zip(runs, linear, strict=True):
        left = replace(one, r=np.where(windows.ok, one.r - one.S @ step, 0.0))
        rest = nuisance_corrected(left, windows.ok, variance, nuisance_sd(windows))
        total += (rest**2 * windows.ok).sum(axis=0)
        count += windows.ok.sum(axis=0)
    kernel = np.ones(SMOOTHING) / SMOOTHING
    mean = total / np.maximum(count, 1)
    padded = np.pad(mean, ((SMOOTHING // 2, SMOOTHING // 2), (0, 0)), mode="edge")
    return np.stack([np.convolve(padded[:, i], kernel, mode="valid") for i in range(mean.shape[1])], axis=1)
