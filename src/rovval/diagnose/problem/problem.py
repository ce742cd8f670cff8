"""The estimation problem: windows of all runs, what is known beforehand of coefficients, noise and disturbances, and the two metrics of residuals.

A *metric* is the covariance V = diag(variance) + J Sigma J^T in which residuals are weighted. In that of the *likelihood*, in which models are fitted
and compared, disturbances are nuisances beside the initial states. In that of the *gap*, in which the prediction error and its reduction are stated,
they count as error, and the variance holds what they and the tolerances make. In the *fine* metric noise and disturbances are as large as is most likely for
what the whole library leaves, with nothing for equations that are only nearly right: too fine to compare models in, it shows what they leave.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rovval.core.data import Array
from rovval.core.errors import BadInput
from rovval.core.large_arrays import side_by_side
from rovval.diagnose.criteria import EXACT_WINDOWS, LEAST_WINDOWS
from rovval.diagnose.problem.cross_validation import Fold, make_folds
from rovval.diagnose.problem.disturbance import Disturbance, correlated, principal_parts
from rovval.diagnose.problem.noise_model import equations_of_runs, fit_noise_model
from rovval.diagnose.problem.prior import loosened_by_closed_loop, prior_mean, tolerance_prior
from rovval.diagnose.problem.variance_components import Components
from rovval.diagnose.residuals.normal_equations import (
    Linearisation,
    NormalEquations,
    Whitened,
    concatenated,
    gathered,
    normal_equations,
    nuisance_corrected,
    whiten,
)
from rovval.diagnose.residuals.nuisances import initial_state_sd, nuisance_sd
from rovval.diagnose.residuals.parity import ParityResiduals, parity_residuals
from rovval.diagnose.residuals.perturbations import Columns, DisplacedColumn
from rovval.diagnose.residuals.ridge import Prior
from rovval.diagnose.residuals.sensitivities import linearise, residual
from rovval.diagnose.windows.closed_loop import loop_gains, variance_factors
from rovval.diagnose.windows.windows import Windows
from rovval.plant import Plant, parse_settings
from rovval.simulation import carried_effects

WINDOWS_AT_ONCE = 8  # windows: some thousand lanes each, as many as are simulated at once


@dataclass(frozen=True, slots=True)
class Metric:
    """A metric and the nominal vehicle's normal equations in it.

    Attributes:
        variance: white part of the residuals' covariance, of each channel at each time in the window (n, c), in squared units of the channel.
        dynamics: normal equations of the simulated windows alone.
        total: the same with the parity residuals as rows beside them.
    """

    variance: Array
    dynamics: NormalEquations
    total: NormalEquations


@dataclass(frozen=True, slots=True)
class Problem:
    """What is fitted, to what, and how residuals are weighed.

    Attributes:
        runs: the windows of each run.
        origin: parameters (k,) of the nominal vehicle: all null but for the effects that its file carries.
        prior_mean: mean (k,) of every parameter's prior: the origin, but for depths that only the logs say something of.
        tolerance: prior of the coefficients and sensors of a healthy vehicle.
        nominal: residuals and nuisances of each run at the nominal vehicle; no parameter columns, which are the bulk of a linearisation.
        likelihood: metric in which models are fitted and compared.
        gap: metric in which the prediction error and its reduction are stated.
        parity: parity residuals of each run.
        folds: windows that are held out together.
        design_effect: by how much autocorrelated residuals say less than independent ones (Kish 1965).
        coarsening: by how much all residuals say less than the noise model has it, because no model's equations are exact (coarsened posterior:
            Miller and Dunson 2019).
        run_of_window: number of the run that each window is of (m,).
        disturbance: what pushed the vehicle that nobody logged.
        components: noise and disturbances of the fine metric; None where the windows are too few to tell disturbances from steady forces.
    """

    runs: tuple[Windows, ...]
    origin: Array
    prior_mean: Array
    tolerance: Prior
    nominal: tuple[Linearisation, ...]
    likelihood: Metric
    gap: Metric
    parity: tuple[ParityResiduals, ...]
    folds: tuple[Fold, ...]
    design_effect: float
    coarsening: float
    run_of_window: np.ndarray
    disturbance: Disturbance
    components: Components | None

    @property
    def plant(self) -> Plant:
        """The plant that all runs share."""
        return self.runs[0].plant

    @property
    def tempering(self) -> float:
        """What squared residuals are divided by where models are fitted and compared: design effect times coarsening."""
        return self.design_effect * self.coarsening

    @property
    def window_count(self) -> int:
        """Number of windows of all runs."""
        return len(self.run_of_window)


def pose(runs: tuple[Windows, ...], asked: Columns, tolerance: float) -> Problem:
    """Set the problem up about the nominal vehicle, linearised in the columns ``asked`` for and in those of every coefficient that has a tolerance.

    ``tolerance`` is the relative standard deviation of a healthy simulator's coefficients (``--calibration-slop``).

    Raises:
        BadInput: the simulation of the nominal vehicle stops in so many windows that too few are left.
    """
    plant = runs[0].plant
    origin = parse_settings(plant, carried_effects(plant.vehicle))
    means = np.array([prior_mean(slot.parameter, runs, float(origin[i])) for i, slot in enumerate(plant.slots)])
    gain = loop_gains(runs)
    prior = loosened_by_closed_loop(tolerance_prior(plant, tolerance), plant, gain)
    columns = tuple(sorted({*asked.slots, *prior.sd}))
    linear = tuple(linearise(windows, origin, columns, asked.displaced) for windows in runs)
    runs = tuple(_without_stopped(windows, one.valid) for windows, one in zip(runs, linear, strict=True))
    run_of_window = np.concatenate([np.full(windows.count, i) for i, windows in enumerate(runs)])
    folds = make_folds(run_of_window)
    noise = fit_noise_model(runs, linear, columns, prior, folds, variance_factors(runs, gain), origin)
    likelihood = equations_of_runs(noise.runs, noise.linear, noise.white_variance, nuisance_sd)
    gap = equations_of_runs(noise.runs, noise.linear, noise.total_variance, initial_state_sd)
    checks = tuple(parity_residuals(windows, columns) for windows in runs)
    parity = concatenated([check.normal_equations(origin, likelihood.columns, noise.design_effect) for check in checks])
    return Problem(
        runs=noise.runs, origin=origin, prior_mean=means, tolerance=prior,
        nominal=tuple(replace(one, S=one.S[..., :0].copy(), columns=()) for one in noise.linear),
        likelihood=Metric(noise.white_variance, likelihood, likelihood + parity), gap=Metric(noise.total_variance, gap, gap + parity),
        parity=checks, folds=folds, design_effect=noise.design_effect,
        coarsening=1.0 + len(run_of_window) / EXACT_WINDOWS, run_of_window=run_of_window, disturbance=noise.disturbance,
        components=noise.components,
    )  # fmt: skip


def _without_stopped(windows: Windows, valid: np.ndarray) -> Windows:
    """The windows with nothing to compare where the simulation of the nominal vehicle stops."""
    if (stops := int((~valid).sum())) and windows.count - stops < LEAST_WINDOWS:
        raise BadInput(
            f"run {windows.run.id}: the simulation stops in {stops} of {windows.count} windows, at least {LEAST_WINDOWS} have to run",
            "`rovval simulate` says when and why; look at the vehicle's file",
        )
    return replace(windows, ok=windows.ok & valid[:, None, None], stopped=stops)


def equations_at(problem: Problem, beta: Array, columns: tuple[int, ...], displaced: Sequence[DisplacedColumn] = ()) -> NormalEquations:
    """Normal equations about ``beta`` (k,) in the metric of the likelihood, parity with them: one simulation of every window a column. The sensitivities of a
    few windows at a time (`WINDOWS_AT_ONCE`) are kept, which are much more than what is made of them."""

    def parts() -> Iterator[NormalEquations]:
        for windows, check in zip(problem.runs, problem.parity, strict=True):
            for begin in range(0, windows.count, WINDOWS_AT_ONCE):
                which = slice(begin, begin + WINDOWS_AT_ONCE)
                few = windows.part(which)
                dynamics = normal_equations(linearise(few, beta, (), displaced, columns), few.ok, problem.likelihood.variance, nuisance_sd(few))
                yield dynamics + check.normal_equations(beta, dynamics.columns, problem.design_effect, which=which)

    return gathered(parts(), problem.window_count)


def gap_equations_at(problem: Problem, beta: Array, columns: tuple[int, ...]) -> tuple[NormalEquations, NormalEquations]:
    """Normal equations about ``beta`` (k,) in the metric of the gap: (of the dynamics alone, with parity)."""
    return gap_equations_of(problem, beta, [linearise(windows, beta, columns) for windows in problem.runs])


def gap_equations_of(problem: Problem, beta: Array, linear: Sequence[Linearisation]) -> tuple[NormalEquations, NormalEquations]:
    """The same of linearisations of the runs about ``beta`` (k,)."""
    dynamics = equations_of_runs(problem.runs, linear, problem.gap.variance, initial_state_sd)
    return dynamics, dynamics + _parity_at(problem, beta, dynamics.columns)


def whitened(problem: Problem, linear: Sequence[Linearisation]) -> tuple[Whitened, ...]:
    """Linearisations of each run in the metric of the likelihood."""
    variance = problem.likelihood.variance
    return tuple(whiten(one, windows.ok, variance, nuisance_sd(windows)) for windows, one in zip(problem.runs, linear, strict=True))


def in_fine_metric(
    problem: Problem, segments: Sequence[Array], linear: Sequence[Linearisation]
) -> tuple[Problem, tuple[Linearisation, ...]] | None:
    """The problem with the fine metric in place of that of its likelihood, and the linearisation ``linear`` of each run with the disturbances of that metric
    among its nuisances, of which ``segments`` are the responses there (`disturbance.segment_responses`); None where the problem has no such metric."""
    if problem.components is None:
        return None
    found, starts = problem.components, len(initial_state_sd(problem.runs[0]))
    variance = np.tile(found.noise**2, (len(problem.likelihood.variance), 1))
    parts = principal_parts(problem.runs, [correlated(one, found.root()) for one in segments], variance)
    runs = tuple(replace(windows, disturbance_response=one) for windows, one in zip(problem.runs, parts, strict=True))
    beside = tuple(replace(one, J=side_by_side(one.J[..., :starts], more)) for one, more in zip(linear, parts, strict=True))
    return replace(problem, runs=runs, likelihood=replace(problem.likelihood, variance=variance)), beside


def equations_of(problem: Problem, beta: Array, linear: Sequence[Whitened]) -> tuple[NormalEquations, NormalEquations]:
    """Normal equations of whitened linearisations about ``beta`` (k,): (of the dynamics alone, with parity)."""
    dynamics = concatenated([one.normal_equations(one.r) for one in linear])
    return dynamics, dynamics + _parity_at(problem, beta, dynamics.columns)


def equations_with_frozen(problem: Problem, beta: Array, linear: Sequence[Whitened]) -> NormalEquations | None:
    """Normal equations of all windows in one about ``beta`` (k,), parity with them, by one simulation: the sensitivities are those of ``linear``.

    None where a window that ran at ``linear`` stops at ``beta``.
    """
    found = list[NormalEquations]()
    for windows, one in zip(problem.runs, linear, strict=True):
        r, ran = residual(windows, beta)
        if not ran[one.valid].all():
            return None
        found.append(one.normal_equations(r).summed())
    columns = found[0].columns
    parity = [check.normal_equations(beta, columns, problem.design_effect, summed=True) for check in problem.parity]
    return concatenated([*found, *parity]).summed()


def corrected_residuals(problem: Problem, beta: Array | None = None) -> list[Array]:
    """Residual of each run's windows (m, n, c), measured minus simulated, their best initial states taken out; at the nominal vehicle by default."""
    return corrected_of(problem, problem.nominal if beta is None else tuple(linearise(windows, beta, ()) for windows in problem.runs))


def corrected_of(problem: Problem, linear: Sequence[Linearisation]) -> list[Array]:
    """Residual (m, n, c) of the linearisation of each run, the best initial states of its windows taken out."""
    return [
        nuisance_corrected(one, windows.ok, problem.gap.variance, initial_state_sd(windows))
        for windows, one in zip(problem.runs, linear, strict=True)
    ]


def _parity_at(problem: Problem, beta: Array, columns: tuple[int, ...]) -> NormalEquations:
    """Normal equations of the parity residuals of all runs about ``beta`` (k,)."""
    return concatenated([check.normal_equations(beta, columns, problem.design_effect) for check in problem.parity])
