"""A point in parameter space where effects and calibration slop stand together: cost, step and evidence there, by its linearisation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.inference.cross_validation import losses
from rovval.diagnose.inference.problem import Problem
from rovval.diagnose.residuals.normal_equations import Products, Scaled
from rovval.diagnose.residuals.sensitivities import Linear


@dataclass(frozen=True, slots=True)
class Point:
    """Parameters ``beta`` (k,), slop moved; ``columns`` the ``own`` slots of the effects, then slop; the linearisations and their products there;
    ``precision`` of each column's prior, ``offset`` from where that stands, ``side``: -1 and 1 on a lower and upper bound, else 0, and
    ``still``: which columns stay in the tangent."""

    beta: Array
    columns: tuple[int, ...]
    own: int
    scaled: tuple[Scaled, ...]
    dynamic: Products
    data: Products
    precision: Array
    offset: Array
    side: Array
    still: np.ndarray

    @property
    def linear(self) -> tuple[Linear, ...]:
        """The linearisation of each run."""
        return tuple(one.linear for one in self.scaled)

    @property
    def slope(self) -> Array:
        """Descent of loss and prior along each column."""
        return np.asarray(self.data.b.sum(axis=0) - self.precision * self.offset)

    @property
    def curvature(self) -> Array:
        """Second derivative of loss and prior."""
        return np.asarray(self.data.A.sum(axis=0) + np.diag(self.precision))

    def cost(self) -> float:
        """Loss and prior here, what stays in the tangent at its best."""
        return self._below(self.still)

    def profile(self) -> float:
        """Loss and prior once one more linear step of every column is taken."""
        return self._below(np.ones(len(self.columns), dtype=bool))

    def step(self, which: np.ndarray) -> Array:
        """Gauss-Newton step (len(columns),) that the windows ``which`` ask for."""
        slope = self.data.b[which].sum(axis=0) - self.precision * self.offset
        return self.solved(self.data.A[which].sum(axis=0) + np.diag(self.precision), slope)

    def solved(self, H: Array, slope: Array, among: np.ndarray | None = None) -> Array:
        """H^-1 slope for the columns that are free to go that way; columns pushed against a bound stay."""
        free = (self.side * slope <= 0) if among is None else (self.side * slope <= 0) & among
        step = np.zeros(len(slope))
        step[free] = np.linalg.solve(H[np.ix_(free, free)], slope[free])
        return step

    def sigmas(self) -> Array:
        """Departure of each slop column in standard deviations of its tolerance, one linear step ahead."""
        step = self.solved(self.curvature, self.slope)
        return np.asarray((self.offset + step)[self.own :] * np.sqrt(self.precision[self.own :]))

    def strain(self) -> float:
        """Standard deviations by which the most strained healthy coefficient is off."""
        return float(np.abs(self.sigmas()).max(initial=0.0))

    def left(self) -> Array:
        """Loss of the dynamics per window (m,), what stays in the tangent at its best."""
        step = self.solved(self.curvature, self.slope, self.still)
        return losses(self.dynamic, np.arange(len(step)), step, np.ones(len(self.dynamic.c), dtype=bool))

    def _below(self, among: np.ndarray) -> float:
        slope = self.slope
        whole = float(self.data.c.sum()) + float((self.precision * self.offset**2).sum())
        return whole - float(slope @ self.solved(self.curvature, slope, among))


def evidence(problem: Problem, point: Point, counts: Array) -> Array:
    """Twice the log evidence (d,) of a point on windows weighted by ``counts`` (d, m), over the vehicle as it is (Laplace; MacKay 1992)."""
    found = np.empty(len(counts))
    k = len(point.columns)
    flat = point.data.A.reshape(len(point.data.A), -1)
    volume = -float(np.log(point.precision).sum())
    pull = point.precision * point.offset
    for i, count in enumerate(counts):
        H = (count @ flat).reshape(k, k) + np.diag(point.precision)
        slope = count @ point.data.b - pull
        loss = float(count @ point.data.c) + float(pull @ point.offset) - float(slope @ point.solved(H, slope))
        found[i] = (float(count @ problem.data.c) - loss) / problem.inflation - (np.linalg.slogdet(H)[1] + volume)
    return found


def whole_evidence(problem: Problem, point: Point) -> float:
    """Evidence of a point on every window once."""
    return float(evidence(problem, point, np.ones((1, problem.blocks)))[0])
