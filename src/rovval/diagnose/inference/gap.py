"""How large the gap is: rms, integral absolute error and noise floor by axis, and the squared errors that reductions are ratios of."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rovval.core.data import Array, Flags
from rovval.diagnose.criteria import CALIBRATED_SPREAD, HEALTHY_GAP
from rovval.diagnose.inference.laplace import Posterior
from rovval.diagnose.problem.problem import Problem, corrected_residuals
from rovval.diagnose.windows.windows import axis_channels
from rovval.simulation.fitted_errors import fitted_errors, spread_of_errors
from rovval.vehicle.model import Vehicle

ANGULAR = ("roll", "pitch", "yaw")
PARITY = "parity"  # of a relation of the pose, its name behind it
TINY = 1e-9  # of a squared error over its variance, or a share of a gap: next to none, to divide by


@dataclass(frozen=True, slots=True)
class GapOnAxis:
    """Prediction error of the nominal simulator on one axis.

    Attributes:
        unit: of ``rms`` and ``floor_rms``: m/s or rad/s; m or rad where no velocity was logged.
        channel: the measured channel that it is an error of.
        rms: root mean square error, in ``unit``.
        iae: integral of the absolute error over time, in ``unit`` times seconds.
        floor_rms: white noise of the sensor, in ``unit``.
        share: of the weighted squared error of all axes.
        calibrated_rms: error that the vehicle's calibration left of its own logs, in ``unit``; None without one.
    """

    unit: str
    channel: str
    rms: float
    iae: float
    floor_rms: float
    share: float
    calibrated_rms: float | None


def squared_errors(problem: Problem, residuals: Sequence[Array]) -> dict[str, Array]:
    """Sum of squared errors (m,) of each measured axis in every window of all runs, in the channel's unit squared."""
    found: dict[str, list[Array]] = {}
    for windows, error in zip(problem.runs, residuals, strict=True):
        for axis, channel in axis_channels(windows).items():
            found.setdefault(axis, []).append(np.where(windows.ok[..., channel], error[..., channel] ** 2, 0.0).sum(axis=1))
    return {axis: np.concatenate(values) for axis, values in found.items()}


def gap_by_axis(problem: Problem, residuals: Sequence[Array]) -> dict[str, GapOnAxis]:
    """Prediction error of each measured axis; ``residuals`` (m, n, c) of each run, as `problem.corrected_residuals` gives them."""
    rows: dict[str, GapOnAxis] = {}
    weight = weighted_errors(problem, residuals)
    total = sum(weight.values()) or 1.0
    for axis, channel in axis_channels(problem.runs[0]).items():
        error = np.concatenate([r[..., channel][p.ok[..., channel]] for r, p in zip(residuals, problem.runs, strict=True)])
        floor = float(np.mean([p.noise[channel] for p in problem.runs]))
        name = problem.runs[0].channels[channel]
        pose = name in ("x", "y", "z", "phi", "theta", "psi")
        unit = ("rad" if axis in ANGULAR else "m") if pose else ("rad/s" if axis in ANGULAR else "m/s")
        rows[axis] = GapOnAxis(
            unit=unit,
            channel=name,
            rms=float(np.sqrt(np.mean(error**2))),
            iae=float(np.abs(error).sum() * problem.runs[0].run.dt),
            floor_rms=floor,
            share=weight[axis] / total,
            calibrated_rms=fitted_errors(problem.plant.vehicle).get(name),
        )
    return rows


def weighted_errors(problem: Problem, residuals: Sequence[Array]) -> dict[str, float]:
    """Sum of squared errors of each axis over the variance of the gap's metric; roll and pitch with their angles."""
    weight: dict[str, float] = {}
    for windows, error in zip(problem.runs, residuals, strict=True):
        scaled = np.where(windows.ok, error**2 / problem.gap.variance, 0.0).sum(axis=(0, 1))
        for axis, value in zip(windows.axes, scaled, strict=True):
            weight[axis] = weight.get(axis, 0.0) + float(value)
    return weight


def share_left(problem: Problem, point: Posterior) -> float:
    """Share (1) of the squared error of the dynamics that a fit leaves, in the metric of the likelihood."""
    return float(point.dynamics_loss().sum()) / float(problem.likelihood.dynamics.c.sum())


def explainable_gap(problem: Problem) -> Array:
    """Squared error above noise (2,) of the vehicle as its file has it: of the dynamics, and of these with the parity residuals."""
    return np.array([float(one.c.sum()) for one in (problem.gap.dynamics, problem.gap.total)]) - floor_losses(problem)


def tolerated_gap(problem: Problem) -> float:
    """Squared error of the dynamics that coefficients and sensors make which are off by as much as their tolerance has it, expected."""
    gap, columns = problem.gap.dynamics, tuple(problem.tolerance.sd)
    at = gap.place(columns)
    return float((gap.A.sum(axis=0)[np.ix_(at, at)] * problem.tolerance.covariance(columns)).sum())


def floor_losses(problem: Problem) -> Array:
    """Loss (2,) that white sensor noise alone makes, which no model explains: of the dynamics, and of these with the parity residuals."""
    share = [np.where(p.ok, p.noise**2 / problem.gap.variance, 0.0).sum(axis=(1, 2)) for p in problem.runs]
    noise = float(np.concatenate(share).sum())
    return np.array([noise, noise + sum(float(check.noise_loss(problem.design_effect).sum()) for check in problem.parity)])


def errors_by_part(problem: Problem, residuals: Sequence[Array], beta: Array) -> dict[str, float]:
    """Weighted squared errors of each axis, of which ``residuals`` are given, and of each parity relation (`PARITY`) about ``beta`` (k,)."""
    return weighted_errors(problem, residuals) | parity_errors(problem, beta)


def parity_errors(problem: Problem, beta: Array, which: Sequence[Flags] | None = None) -> dict[str, float]:
    """The latter alone, of all windows or of those ``which`` (m,) of each run."""
    windows = which or [np.ones(part.count, dtype=bool) for part in problem.runs]
    return _of_parity([check.losses(beta, problem.design_effect, some) for check, some in zip(problem.parity, windows, strict=True)])


def noise_by_part(problem: Problem) -> dict[str, float]:
    """What of them white sensor noise alone makes."""
    found = dict[str, float]()
    for windows in problem.runs:
        noise = np.where(windows.ok, windows.noise**2 / problem.gap.variance, 0.0).sum(axis=(0, 1))
        for axis, value in zip(windows.axes, noise, strict=True):
            found[axis] = found.get(axis, 0.0) + float(value)
    each = [float(check.noise_loss(problem.design_effect).sum()) / max(len(check.relations), 1) for check in problem.parity]
    return found | _of_parity([dict.fromkeys(check.relations, noise) for check, noise in zip(problem.parity, each, strict=True)])


def tolerated_by_part(problem: Problem) -> dict[str, float]:
    """What of them coefficients and sensors make which are off by as much as their tolerance has it, expected; on the axes in proportion to the gap there,
    since the sensitivities by axis are not kept."""
    nominal, noise = weighted_errors(problem, corrected_residuals(problem)), noise_by_part(problem)
    share = tolerated_gap(problem) / max(float(explainable_gap(problem)[0]), TINY)
    axes = {axis: share * (value - noise[axis]) for axis, value in nominal.items()}
    return axes | _of_parity([check.tolerated(problem.tolerance.sd, problem.design_effect) for check in problem.parity])


def tolerated_share(problem: Problem) -> Array:
    """Share (2,) of the explainable gap that a healthy vehicle is expected to show by its tolerances: of the dynamics, and of these with the parity residuals.

    Next to none of a calibrated vehicle: its coefficients were fitted, and what that left goes with the motion, as the form error of whatever is found does."""
    if any(calibrated_by_part(problem).values()):
        return np.full(2, TINY)
    parts = tolerated_by_part(problem)
    dynamics = sum(size for part, size in parts.items() if not part.startswith(PARITY))
    return np.asarray(np.maximum(HEALTHY_GAP * np.array([dynamics, sum(parts.values())]) / np.maximum(explainable_gap(problem), TINY), TINY))


def calibrated_by_part(problem: Problem) -> dict[str, float]:
    """What of them the calibrated vehicle left of the logs that it was calibrated on (`simulation.fitted_errors`): none where its file does not say, and
    none of parity relations, which know no vehicle."""
    left, found = fitted_errors(problem.plant.vehicle), dict[str, float]()
    for windows in problem.runs:
        rms = np.array([left.get(channel, 0.0) for channel in windows.channels])
        beyond = np.maximum(rms**2 - windows.noise**2, 0.0)
        error = windows.ok.sum(axis=(0, 1)) * beyond / problem.gap.variance.mean(axis=0)  # it grows along a window as the metric's variance does
        for axis, value in zip(windows.axes, error, strict=True):
            found[axis] = found.get(axis, 0.0) + float(value)
    return found


def spread_as_calibrated(vehicle: Vehicle) -> float:
    """Standard deviation of the logarithm of the squared errors of one more run over those of the ``vehicle``'s calibration, where nothing came since then.

    One degree of freedom is that of other vehicles (`CALIBRATED_SPREAD`), the others are of its own runs and the error of their mean (Gelman et al. 2013, 2.6).
    """
    own, runs = spread_of_errors(vehicle)
    return float(np.sqrt((CALIBRATED_SPREAD**2 + (runs - 1) * (1.0 + 1.0 / runs) * own**2) / runs))


def _of_parity(runs: Sequence[Mapping[str, float]]) -> dict[str, float]:
    """Sums over the runs of what is given of each parity relation."""
    return {f"{PARITY} {name}": sum(one.get(name, 0.0) for one in runs) for name in dict.fromkeys(name for one in runs for name in one)}
