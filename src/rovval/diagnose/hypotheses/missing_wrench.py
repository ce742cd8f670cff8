"""The force and moment that a log lacks of a vehicle's motion, worked out in the linearised model.

What no slope leads to, a spring that holds the vehicle or a line along which a tether is dragged, is looked for in these first.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from rovval.core.channels import AXES
from rovval.core.data import Array
from rovval.core.frames import rotation_from_euler
from rovval.diagnose.problem.disturbance import segment_indicators
from rovval.diagnose.residuals.external_forces import force_sensitivities, typical_wrench
from rovval.diagnose.residuals.normal_equations import Linearisation, normal_equations
from rovval.diagnose.residuals.nuisances import initial_state_sd
from rovval.diagnose.windows.windows import Windows, interpolated

HALVES = 2  # of a window, in each of which what is missing is one constant force and moment
EVERY_S = 0.5  # s between the places along a half at which a force is looked at
LEAST_DISTANCE = 1.0  # m: a point that is nearer leads a pull in no one direction
LEVER_X = np.array([[0, 0, 0], [0, 0, -1], [0, 1, 0]])  # moment of a force that acts 1 m ahead of the origin
LEVER_Z = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 0]])  # and of one that acts 1 m below it


@dataclass(frozen=True, slots=True)
class MissingWrench:
    """The force and moment, in body axes, that the halves of m windows lack.

    Attributes:
        A: (m, 12, 12) information on them: the first half's six components (N, N m), then the second's.
        b: (m, 12) score at none.
        t: (m, 2, s) times (s since the run's start) of s places in each half.
        place: (m, 2, s, 3) the vehicle's position there (m; north, east, down).
        rotation: (m, 2, s, 3, 3) from body axes to north, east, down.
        velocity: (m, 2, s, 6) the vehicle's velocity there (body axes; m/s, rad/s).
    """

    A: Array
    b: Array
    t: Array
    place: Array
    rotation: Array
    velocity: Array

    def levered(self, force: Array) -> Array:
        """(m, 12, 3) a ``force`` (m, 2, 3), body axes, in each half at the origin, and its further moment for each metre that it acts ahead and below."""
        none = np.zeros_like(force)
        parts = [np.concatenate(pair, axis=-1) for pair in ((force, none), (none, force @ LEVER_X.T), (none, force @ LEVER_Z.T))]
        return np.stack(parts, axis=-1).reshape(*self.b.shape, len(parts))

    def normal(self, each: Array) -> tuple[Array, Array]:
        """Normal equations (f, f) and (f,) of how much of each wrench, ``each`` (m, 12, f), there is."""
        return np.tensordot(each, self.A @ each, axes=((0, 1), (0, 1))), np.tensordot(self.b, each, axes=2)


def missing_wrench(windows: Windows, linear: Linearisation, beta: Array, variance: Array) -> MissingWrench:
    """What the halves of a run's windows lack of parameters ``beta``, by the residuals ``linear`` there, weighted by ``variance`` (samples, channels)."""
    wrench = typical_wrench([windows])
    forces = [(axis, on * size) for on in segment_indicators(windows, HALVES) for axis, size in zip(AXES, wrench, strict=True)]
    answers = force_sensitivities(windows, beta, forces)
    seen = normal_equations(replace(linear, S=answers, columns=tuple(range(answers.shape[-1]))), windows.ok, variance, initial_state_sd(windows))
    unit = np.tile(1.0 / wrench, HALVES)
    edges = np.linspace(0, windows.steps + 1, HALVES + 1)
    samples = max(round((windows.steps + 1) / HALVES * windows.run.dt / EVERY_S), 1)
    along = edges[:-1, None] + (edges[1] - edges[0]) * (np.arange(samples) + 0.5) / samples
    t = (windows.start[:, None, None] + along) * windows.run.dt
    place = np.stack([interpolated(windows, c, t) for c in ("x", "y", "z")], axis=-1)
    rotation = rotation_from_euler(np.stack([interpolated(windows, c, t) for c in ("phi", "theta", "psi")], axis=-1))
    velocity = np.stack([interpolated(windows, c, t) for c in ("u", "v", "w", "p", "q", "r")], axis=-1)
    return MissingWrench(seen.A * np.outer(unit, unit), seen.b * unit, t, place, rotation, velocity)


def pull_towards(point: Mapping[str, float], strength: float, depth: float) -> dict[str, float]:
    """A pull of some ``strength`` (N) towards a ``point`` (north, east, down; m) by the names that a tether's effects have for it: its components (N) at the
    log's origin at a ``depth`` (m), and one over how far it is from there to the point (1/m)."""
    to = np.array([point["north"], point["east"], point["down"] - depth])
    far = max(float(np.linalg.norm(to)), LEAST_DISTANCE)
    north, east, down = (strength * to / far).tolist()
    return {"north": north, "east": east, "down": down, "nearness": 1.0 / far, "depth": depth}
