"""Forces that nobody logged, beside what a model explains: how large they are.

Their standard deviations are as large as is most likely for what the model leaves (`problem.variance_components`). They are stated in the force of the
thrusters: of their rms in all, and of its moment at their distance from the centre of gravity, whatever it is that they drive in a log.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from rovval.core.channels import AXES
from rovval.core.data import Array
from rovval.diagnose.inference.laplace import Posterior
from rovval.diagnose.problem.disturbance import segment_responses
from rovval.diagnose.problem.problem import Problem
from rovval.diagnose.problem.variance_components import Components, evenly_spread, variance_components
from rovval.diagnose.residuals.external_forces import typical_wrench
from rovval.diagnose.residuals.normal_equations import Linearisation
from rovval.diagnose.windows.windows import axis_channels
from rovval.vehicle.model import Vehicle

TRANSLATION = 3  # axes


class ForceLeft(NamedTuple):
    """The force that nobody logged, in the thrusters' own (1), where causes act.

    Attributes:
        size: what it is beside them.
        expected: its median where they are right.
        alike: its median where something else only looks like them.
    """

    size: float
    expected: float
    alike: float


def responses_about(problem: Problem, point: Posterior | None = None) -> tuple[Array, ...]:
    """Response of each run's windows (m, n, c, 6 s) to a force of the thrusters' rms on one axis in one of their s segments, about a fit or about the nominal
    vehicle; none where windows are too few for it to say something."""
    if problem.components is None:
        return ()
    return segment_responses(problem.runs, problem.origin if point is None else point.beta, typical_wrench(problem.runs))


def unlogged_forces(problem: Problem, point: Posterior | None = None, segments: Sequence[Array] = ()) -> dict[str, float]:
    """Standard deviation (1) of the force on each measured axis beside a fit, at its minimum, or beside the nominal vehicle, by the responses of its
    ``segments`` where these are known (`responses_about`); empty where windows are too few to tell such forces from steady ones, or where the thrusters stand
    still."""
    if problem.components is None or not any(windows.actuation.inputs.speed.any() for windows in problem.runs):
        return {}
    wrench, some = typical_wrench(problem.runs), evenly_spread(problem.runs)
    runs = [windows.some(some) for windows in problem.runs]
    step = np.zeros(0) if point is None else point.solve(point.curvature, point.descent)
    whole = problem.nominal if point is None else [one.after(step) for one in point.whitened]
    left = [Linearisation(one.r[some], one.S[some], one.J[some], (), one.valid[some]) for one in whole]
    begin = Components.initial(np.sqrt(problem.likelihood.variance.mean(axis=0)))
    answers = [one[some] for one in segments] or responses_about(replace(problem, runs=tuple(runs)), point)
    size = variance_components(runs, left, answers, begin).share * wrench / thrusters_force(wrench, problem.plant.vehicle)
    return {axis: float(value) for axis, value in zip(AXES, size, strict=True) if axis in axis_channels(runs[0])}


def thrusters_force(wrench: Array, vehicle: Vehicle) -> Array:
    """The rms force of the thrusters (6,), N and N m, of which ``wrench`` (6,) is the rms on each axis: on every axis as large as on all together, and a moment
    as large as at the thrusters' rms distance from the centre of gravity."""
    force = float(np.linalg.norm(wrench[:TRANSLATION]))
    places = np.array([one.position for one in vehicle.thruster]) - np.array(vehicle.body.centre_of_gravity)
    return force * np.repeat([1.0, float(np.sqrt((places**2).sum(axis=1).mean()))], TRANSLATION)


def where_causes_act(size: Mapping[str, float], left: Mapping[str, float], nominal: Mapping[str, float]) -> float:
    """Mean ``size`` over axes, weighted with how much causes change the square of the unlogged force there: from that beside the ``nominal`` vehicle to what
    they have ``left`` of it; 0 where they change nothing."""
    change = {axis: abs(nominal[axis] ** 2 - force**2) for axis, force in left.items()}
    total = sum(change.values())
    return sum(part * size[axis] for axis, part in change.items()) / total if total > 0.0 else 0.0
