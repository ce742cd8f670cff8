"""A diagnosis problem: the windows of one or several runs, the metric in which residuals are judged, and products at any point."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from rovval.core.data import Array
from rovval.core.errors import BadInput
from rovval.diagnose.inference.cross_validation import Fold, folds_of
from rovval.diagnose.inference.disturbance import Disturbance
from rovval.diagnose.inference.noise_model import joined_of, metric
from rovval.diagnose.inference.prior import Prior, loosened, slop_prior
from rovval.diagnose.residuals.normal_equations import Products, Scaled, joined, scaled, start_corrected
from rovval.diagnose.residuals.parity import Parity, parity
from rovval.diagnose.residuals.perturbations import Columns, Direction
from rovval.diagnose.residuals.sensitivities import Linear, linearise, residual, spread, state_spread
from rovval.diagnose.windows.closed_loop import discount, gains
from rovval.diagnose.windows.shooting import FEWEST_WINDOWS, Stretches
from rovval.plant import Plant, parse_settings
from rovval.simulation import carried_effects


@dataclass(frozen=True, slots=True)
class Problem:
    """``parts`` one per run; ``origin`` (k,) the parameters it starts from; ``at_null`` residuals and nuisances at the nominal vehicle, ``dynamic`` and
    ``data`` the products there (without and with parity) in the metric of ``white`` (n, c) and disturbances, ``gap`` and ``gap_data`` the same in
    that of ``variance`` (n, c), in which the gap is told and no disturbance taken out; ``inflation`` the design effect of autocorrelated
    residuals; ``disturbance`` what pushed the vehicle that nobody logged."""

    parts: tuple[Stretches, ...]
    origin: Array
    variance: Array
    white: Array
    slop: Prior
    at_null: tuple[Linear, ...]
    dynamic: Products
    data: Products
    gap: Products
    gap_data: Products
    parity: tuple[Parity, ...]
    folds: tuple[Fold, ...]
    inflation: float
    run_of_window: np.ndarray
    disturbance: Disturbance

    @property
    def plant(self) -> Plant:
        """The plant that all runs share."""
        return self.parts[0].plant

    @property
    def blocks(self) -> int:
        """Number of windows of all runs."""
        return len(self.run_of_window)


def pose(parts: tuple[Stretches, ...], asked: Columns, slop: float) -> Problem:
    """Set the problem up about the vehicle as it is (with the effects that its file carries), linearised in the columns ``asked`` for and in those of slop."""
    plant = parts[0].plant
    origin = parse_settings(plant, carried_effects(plant.vehicle))
    gain = gains(parts)
    prior = loosened(slop_prior(plant, slop), plant, gain)
    columns = tuple(sorted({*asked.slots, *prior.sd}))
    linear = tuple(linearise(part, origin, columns, asked.directions) for part in parts)
    parts = tuple(_running(part, one.valid) for part, one in zip(parts, linear, strict=True))
    run_of_window = np.concatenate([np.full(part.count, i) for i, part in enumerate(parts)])
    folds = folds_of(run_of_window)
    seen = metric(parts, linear, columns, prior, folds, discount(parts, gain), origin)
    dynamic = joined_of(seen.parts, seen.linear, seen.white, spread)
    gap = joined_of(seen.parts, seen.linear, seen.variance, state_spread)
    checks = tuple(parity(part, columns) for part in parts)
    kinematic = joined([check.moved(origin, dynamic.columns).products(seen.inflation) for check in checks])
    at_null = tuple(replace(one, S=one.S[..., :0].copy(), columns=()) for one in seen.linear)  # the slopes are the bulk of a problem
    return Problem(
        seen.parts, origin, seen.variance, seen.white, prior, at_null, dynamic, dynamic + kinematic, gap, gap + kinematic, checks, folds,
        seen.inflation, run_of_window, seen.disturbance,
    )  # fmt: skip


def _running(part: Stretches, valid: np.ndarray) -> Stretches:
    """The windows with nothing to compare where the simulation of the vehicle as it is stops.

    Raises:
        BadInput: it stops in so many that too few are left.
    """
    if (stops := int((~valid).sum())) and part.count - stops < FEWEST_WINDOWS:
        raise BadInput(
            f"run {part.run.id}: the simulation stops in {stops} of {part.count} windows, at least {FEWEST_WINDOWS} have to run",
            "`rovval simulate` says when and why; look at the vehicle's file",
        )
    return replace(part, ok=part.ok & valid[:, None, None], stopped=stops)


def at(problem: Problem, beta: Array, columns: tuple[int, ...], directions: Sequence[Direction] = ()) -> Products:
    """Products of every window about ``beta`` for the given columns, parity with them."""
    dynamic = joined_of(problem.parts, [linearise(part, beta, columns, directions) for part in problem.parts], problem.white, spread)
    return dynamic + _kinematic(problem, beta, dynamic.columns)


def gap_at(problem: Problem, beta: Array, columns: tuple[int, ...]) -> tuple[Products, Products]:
    """(Dynamics alone, dynamics and parity) about ``beta`` in the metric in which the gap is told."""
    dynamic = joined_of(problem.parts, [linearise(part, beta, columns) for part in problem.parts], problem.variance, state_spread)
    return dynamic, dynamic + _kinematic(problem, beta, columns)


def in_metric(problem: Problem, linear: Sequence[Linear]) -> tuple[Scaled, ...]:
    """Linearisations in the metric of the problem, disturbances and initial states as nuisances."""
    return tuple(scaled(one, part.ok, problem.white, spread(part)) for part, one in zip(problem.parts, linear, strict=True))


def products_about(problem: Problem, beta: Array, linear: Sequence[Scaled]) -> tuple[Products, Products]:
    """Products of linearisations about ``beta``: (dynamics alone, dynamics and parity)."""
    dynamic = joined([one.products(one.r) for one in linear])
    return dynamic, dynamic + _kinematic(problem, beta, dynamic.columns)


def carried(problem: Problem, beta: Array, linear: Sequence[Scaled]) -> Products | None:
    """Products about ``beta``, parity with them, by one simulation: the slopes are those of ``linear``. None where a window that ran there
    does not run here."""
    found = list[Products]()
    for part, one in zip(problem.parts, linear, strict=True):
        r, fine = residual(part, beta)
        if not fine[one.valid].all():
            return None
        found.append(one.products(r))
    dynamic = joined(found)
    return dynamic + _kinematic(problem, beta, dynamic.columns)


def corrected_residuals(problem: Problem, beta: Array | None = None) -> list[Array]:
    """Residual of each run's windows (m, n, c), its best initial states taken out; at the nominal vehicle by default."""
    linear = problem.at_null if beta is None else tuple(linearise(part, beta, ()) for part in problem.parts)
    return [
        start_corrected(one, part.ok, problem.variance, state_spread(part)) for part, one in zip(problem.parts, linear, strict=True)
    ]


def _kinematic(problem: Problem, beta: Array, columns: tuple[int, ...]) -> Products:
    return joined([check.moved(beta, columns).products(problem.inflation) for check in problem.parity])
