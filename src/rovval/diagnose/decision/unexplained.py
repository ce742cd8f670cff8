"""What the causes leave unexplained: on which axes something is still at work, with what it varies, and what it resembles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from rovval.core.data import Array
from rovval.diagnose.criteria import OUT_OF_TOLERANCE
from rovval.diagnose.hypotheses.spectrum import Oscillation, oscillation
from rovval.diagnose.inference.gap import calibrated_by_part, floor_losses, share_left, weighted_errors
from rovval.diagnose.inference.laplace import Posterior
from rovval.diagnose.problem.problem import Problem, corrected_residuals
from rovval.diagnose.search.discrepancy import GenericForces
from rovval.diagnose.windows.windows import axis_channels


@dataclass(frozen=True, slots=True)
class Accounted:
    """What needs no cause of the gap, as shares of the squared gap (1).

    Attributes:
        noise: what the noise of the sensors alone makes.
        tolerance: what coefficients and sensors within their tolerance take away, fitted without any cause.
        departure: largest standardised departure of these coefficients from the file, in standard deviations of their priors.
        calibrated: squared gap that the calibration left of its own logs, as a share of this one; 0 without a calibration.
    """

    noise: float
    tolerance: float
    departure: float
    calibrated: float = 0.0

    @property
    def share(self) -> float:
        """Noise and tolerance in sum; a fit with a coefficient far beyond its tolerance is no healthy vehicle and accounts for nothing."""
        return self.noise + (0.0 if self.departure > OUT_OF_TOLERANCE else self.tolerance)


@dataclass(frozen=True, slots=True)
class Unexplained:
    """What the causes leave unexplained; all of the gap where none is named.

    Attributes:
        axes: axes on which a few generic forces would take most of it away, the first most; where none would, the one with the largest share of the gap.
        depends_on: features that those on the first axis vary with, the strongest first; empty where there are none.
        share: share (1) of the squared error that generic forces take away on held-out windows; 0 of an open gap.
        departed: coefficient furthest beyond its tolerance and its standardised departure; None where none is.
        inconstant: effects that come near, but whose value would have to change along the log.
        goes_with: (effect, covariate): the size of a cause, or of what comes near to one, and what it changes with; None where none does.
        oscillation: the narrow band of periods in which most of it comes and goes; None where there is none.
        accounted: of an open gap, the share (1) of it, or of what the causes leave of it, that noise and tolerance account for; None where a force, a
            coefficient or an effect is surely at work.
    """

    axes: tuple[str, ...]
    depends_on: tuple[str, ...] = ()
    share: float = 0.0
    departed: tuple[str, float] | None = None
    inconstant: tuple[str, ...] = ()
    goes_with: tuple[str, str] | None = None
    oscillation: Oscillation | None = None
    accounted: float | None = None


def accounted(problem: Problem, healthy: Posterior) -> Accounted:
    """What of the gap needs no cause; ``healthy`` is the vehicle with its coefficients fitted within their tolerances."""
    noise = min(float(floor_losses(problem)[0]) / float(problem.gap.dynamics.c.sum()), 1.0)
    left = sum(calibrated_by_part(problem).values()) / float(problem.gap.dynamics.c.sum())
    return Accounted(noise, 1.0 - share_left(problem, healthy), healthy.largest_departure(), left)


def unexplained(
    problem: Problem, forces: GenericForces, point: Posterior, inconstant: Sequence[str] = (), goes_with: tuple[str, str] | None = None
) -> Unexplained:
    """Where the few generic forces act that would take away most of what is left at ``point``, and with what they vary; where none does, the axis of the
    largest part. The last two as of `Unexplained`."""
    _, found = forces.sparse()
    axes = tuple(dict.fromkeys(axis for axis, _ in found)) or (_largest_part(problem, corrected_residuals(problem, point.beta)),)
    depends = tuple(feature for axis, feature in found if axis == axes[0])
    departures = zip(point.columns[point.effect_count :], point.standardised_departures(), strict=True)
    beyond = [(problem.plant.slots[c].key, float(z)) for c, z in departures if abs(z) > OUT_OF_TOLERANCE]
    departed = max(beyond, key=lambda one: abs(one[1]), default=None)
    return Unexplained(axes, depends, forces.held_out_gain(), departed, tuple(inconstant), goes_with, oscillation(problem, point))


def unexplained_by_any(problem: Problem, accounted: float, residuals: list[Array], point: Posterior) -> Unexplained:
    """A gap that goes with nothing that was logged: the axis of its largest part. ``residuals`` are the nominal vehicle's, or with the causes that are named,
    which were fitted at ``point``; noise and tolerance account for a share ``accounted`` of it."""
    return Unexplained((_largest_part(problem, residuals),), oscillation=oscillation(problem, point), accounted=accounted)


def _largest_part(problem: Problem, residuals: list[Array]) -> str:
    """The axis on which the weighted squared error is largest."""
    weight = weighted_errors(problem, residuals)
    return max(axis_channels(problem.runs[0]), key=lambda axis: weight[axis])
