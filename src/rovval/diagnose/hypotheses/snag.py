"""Where a log looks as if its tether had caught: there the search for a snag begins.

No slope leads from nothing to what holds a vehicle to a point, and every point is a valley of its own. So the force and moment that each half of a
window lacks are worked out first, and a spring towards a point, slack within a radius, is laid through them from every half on (its stiffness and
where it is tied are linear: variable projection, Golub and Pereyra 1973). The best few are where the settling by simulation begins, and no more.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import minimize

from rovval.core.channels import AXES
from rovval.core.data import Array
from rovval.core.frames import rotation_from_euler
from rovval.diagnose.hypotheses.spectrum import known
from rovval.diagnose.inference.disturbance import pieces
from rovval.diagnose.inference.problem import Problem
from rovval.diagnose.residuals.external_forces import forced, typical_wrench
from rovval.diagnose.residuals.normal_equations import products
from rovval.diagnose.residuals.sensitivities import Linear, state_spread
from rovval.diagnose.windows.shooting import Stretches

HALVES = 2  # of a window, in each of which what is missing is one force and one moment
EVERY_S = 0.5  # between the places along a half at which the spring pulls
SHARES = (0.2, 0.5, 0.8)  # of how far the vehicle gets from where it was caught: slack tried
BEST, APART_S = 4, 10.0  # springs that the search begins from, and how far apart their onsets are (chosen)
SLACK = 5.0  # N/m: half of what is typical of one that is caught (`effects.tether_snag`); opened sets: 8 to 900, an even pull 0.0 to 3
ENOUGH, TIED = 150, 2  # evaluations of a spring, and how often it is laid, each time from where the one before is tied
LEVER_X = np.array([[0, 0, 0], [0, 0, -1], [0, 1, 0]])  # moment of a force that acts 1 m ahead of the origin
LEVER_Z = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 0]])  # and 1 m below it


@dataclass(frozen=True, slots=True)
class Missing:
    """The force and moment that halves of windows lack, body axes: precision ``A`` (m, 12, 12) and score ``b`` (m, 12), the first half's six, then the
    second's; in each half times (m, 2, s), places (m, 2, s, 3) and rotations to north, east and down (m, 2, s, 3, 3)."""

    A: Array
    b: Array
    t: Array
    place: Array
    rotation: Array

    def worth(self, onset: float, point: Array, radius: float) -> tuple[float, Array]:
        """(What the spring from ``onset`` on takes from the loss at its best, its stiffness and that times its lever ahead and below), 0 where it would
        have to push."""
        to = point - self.place
        away = np.linalg.norm(to, axis=-1)
        pull = np.where(self.t >= onset, np.maximum(away - radius, 0.0) / np.maximum(away, 1e-9), 0.0)
        force = np.einsum("wht,whtij,whti->whj", pull, self.rotation, to) / pull.shape[-1]
        none = np.zeros_like(force)
        parts = [np.concatenate(pair, axis=-1) for pair in ((force, none), (none, force @ LEVER_X.T), (none, force @ LEVER_Z.T))]
        each = np.stack(parts, axis=-1).reshape(*self.b.shape, len(parts))
        along, size = np.einsum("wi,wia->a", self.b, each), np.einsum("wia,wij,wjb->ab", each, self.A, each, optimize=True)
        best = np.linalg.lstsq(size, along, rcond=1e-12)[0]
        return (float(along @ best), best) if best[0] > 0 else (0.0, np.zeros(len(parts)))


def caught(problem: Problem) -> list[dict[str, float]]:
    """Springs that explain most of what the first run's windows lack of the vehicle as it is, the best first: north, east, down, radius, levers x and z
    (m), stiffness (N/m) and onset (s since the run's start) of each, and the share of the gap that it takes by its stretch: none where it is so slack that
    it might as well pull evenly (`SLACK`)."""
    part = problem.parts[0]
    lack = missing(part, problem.at_null[0], problem.origin, problem.variance)
    onsets = lack.t[:, :, 0].reshape(-1)
    first = [max(((lack.worth(t, p, r)[0], r) for r in _slacks(lack, t, p)), default=(0.0, 0.0)) for t, p in zip(onsets, _places(lack), strict=True)]
    found = list[tuple[float, dict[str, float]]]()
    for i in np.argsort([-worth for worth, _ in first]):
        if len(found) < BEST and first[i][0] > 0 and all(abs(onsets[i] - spring["onset"]) >= APART_S for _, spring in found):
            found.append(_settled(lack, float(onsets[i]), _places(lack)[i], first[i][1]))
    gap = float(problem.gap.c.sum())
    springs = [(worth / gap, spring) for worth, spring in sorted(found, key=lambda one: -one[0]) if worth > 0]
    return [spring | {"share": share if spring["stiffness"] >= SLACK else 0.0} for share, spring in springs]


def missing(part: Stretches, left: Linear, beta: Array, variance: Array) -> Missing:
    """What the halves of a run's windows lack about ``beta``, where ``left`` holds the residuals there."""
    wrench = typical_wrench([part])
    answers = forced(part, beta, [(axis, on * size) for on in pieces(part, HALVES) for axis, size in zip(AXES, wrench, strict=True)])
    seen = products(replace(left, S=answers, columns=tuple(range(answers.shape[-1]))), part.ok, variance, state_spread(part))
    unit = np.tile(1.0 / wrench, HALVES)
    edges = np.linspace(0, part.steps + 1, HALVES + 1)
    samples = max(round((part.steps + 1) / HALVES * part.run.dt / EVERY_S), 1)
    along = edges[:-1, None] + (edges[1] - edges[0]) * (np.arange(samples) + 0.5) / samples
    t = (part.start[:, None, None] + along) * part.run.dt
    place = np.stack([known(part, c, t) for c in ("x", "y", "z")], axis=-1)
    rotation = rotation_from_euler(np.stack([known(part, c, t) for c in ("phi", "theta", "psi")], axis=-1))
    return Missing(seen.A * np.outer(unit, unit), seen.b * unit, t, place, rotation)


def _places(lack: Missing) -> Array:
    return np.asarray(lack.place[:, :, 0].reshape(-1, 3))


def _slacks(lack: Missing, onset: float, point: Array) -> Array:
    """Radii (m) tried about a point, by how far the vehicle gets from it."""
    away = np.linalg.norm(lack.place[lack.t >= onset] - point, axis=-1)
    return np.array(SHARES) * float(away.max(initial=0.0))


def _settled(lack: Missing, onset: float, point: Array, radius: float) -> tuple[float, dict[str, float]]:
    """The spring near a first guess that takes most from the loss, and how much: tied to the origin first, then where that says that it is tied."""
    at, tie, best, worth = np.array([*point, radius]), np.zeros(3), np.zeros(3), 0.0
    for _ in range(TIED):
        tied = replace(lack, place=lack.place + lack.rotation @ tie)

        def loss(x: Array, tied: Missing = tied) -> float:
            return -tied.worth(onset, x[:3], abs(float(x[3])))[0]

        at = minimize(loss, at, method="Nelder-Mead", options={"maxfev": ENOUGH, "initial_simplex": _simplex(at)}).x
        at[3] = abs(at[3])
        worth, best = tied.worth(onset, at[:3], float(at[3]))
        tie = np.array([best[1], 0.0, best[2]]) / best[0] if worth > 0 else np.zeros(3)
    names = ("north", "east", "down", "radius", "stiffness", "x", "z", "onset")  # of tether_snag
    return worth, dict(zip(names, (*at.tolist(), float(best[0]), float(tie[0]), float(tie[2]), onset), strict=True))


def _simplex(at: Array) -> Array:
    """Corners as far from the first guess as its slack, half a metre at least."""
    return np.asarray(at + np.vstack([np.zeros(4), max(float(at[3]), 0.5) * np.eye(4)]))
