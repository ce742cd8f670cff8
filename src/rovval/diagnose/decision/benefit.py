"""Whether causes show what they do: that they surely close some of the gap, harm no axis by much, and do it where the simulator follows the vehicle.

Asked in two ways, of which one has to do: with every other coefficient as the file has it, and with healthy coefficients where they settle beside
the causes; a vehicle that rolls freely answers to each of them. Faults of sensors are asked of the kinematic checks instead, where these see them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rovval.core.channels import AXES
from rovval.core.data import Array
from rovval.diagnose.inference.gap import axis_weight
from rovval.diagnose.inference.hypothesis_fit import Confirmed
from rovval.diagnose.inference.laplace import Point
from rovval.diagnose.inference.problem import Problem, corrected_residuals
from rovval.diagnose.inference.shrinkage import shrinkage
from rovval.diagnose.search.baseline import relief, without_own
from rovval.diagnose.search.confusion import RELIEF
from rovval.diagnose.search.joint import LEAST_EVIDENCE

ACTING = 0.15  # of what a cause closes: the axes on which it acts
MUCH = 0.3  # of what a cause closes: the axes on which the simulator must follow the vehicle (chosen; the one on which it closes most always)
HARMS = 0.25  # of what causes close in all: a cause that opens more on one axis is the least bad (chosen)
WORSE = 0.02  # of the gap, that the axis of an axis's own cause may get worse (opened sets: of 100 right ones none does at all, of a foreign one 0.06)
UNMOVED = 0.001  # of the gap: less is rounding, as of a compass, which moves nothing (chosen)
SKILL = 0.5  # of the squared motion: an axis on which more is left is not simulated at all (chosen)
NOTHING = 0.05  # of the squared error: less is form, whatever its evidence (chosen)
HARDLY = 0.15  # of what an axis erred before (chosen)
SOME, SPARED = 0.05, 2.0  # surely, of what slop leaves; and standard deviations of tolerance (opened sets: true 0.08, 2.5, 3.1; false 0.02, 0.8)
SEEN, SURELY = 0.5, 100.0  # share of what the kinematic checks show, and evidence, from which they name a fault by themselves (chosen)


@dataclass(frozen=True, slots=True)
class Way:
    """Squared error of each axis without and with the causes, in one of the two ways; whether these surely close some of it, and whether the
    simulator follows the vehicle where they do (`skilled`)."""

    was: Mapping[str, float]
    left: Mapping[str, float]
    sure: bool
    skill: bool

    @property
    def closed(self) -> dict[str, float]:
        """What is closed on each axis, where it is."""
        return _closed(self.was, self.left)

    @property
    def all_of_it(self) -> bool:
        """Whether the causes leave next to nothing."""
        return sum(self.left.values()) <= NOTHING * sum(self.was.values())


def as_filed(problem: Problem, final: Confirmed, before: list[Array]) -> Way:
    """With every other coefficient as the file has it."""
    was, left = axis_weight(problem, before), axis_weight(problem, corrected_residuals(problem, final.beta))
    shrunk = shrinkage(problem, final, before, 0)
    return Way(was, left, shrunk["low"] > 0, skilled(problem, was, left))


def beside_slop(problem: Problem, final: Confirmed, healthy: Point, before: list[Array]) -> Way:
    """Beside healthy coefficients: surely, where the causes close what is worth a name of what those that are not their own leave when they settle
    alone, and some of it surely, or where they spare a healthy coefficient much of its strain."""
    was, left = axis_weight(problem, before), axis_weight(problem, corrected_residuals(problem, final.point.beta))
    value, low, _ = relief(problem, final, without_own(problem, healthy, final.slots), 0)
    return Way(was, left, (value > RELIEF and low > SOME) or healthy.strain() - final.point.strain() > SPARED, skilled(problem, was, left))


def acting(closed: Mapping[str, float], share: float = ACTING) -> tuple[str, ...]:
    """Axes on which the causes close a good part of what they close."""
    return tuple(axis for axis in AXES if closed.get(axis, 0.0) > share * max(sum(closed.values()), 1e-300))


def skilled(problem: Problem, was: Mapping[str, float], left: Mapping[str, float]) -> bool:
    """Whether on the axes where they close much the simulator, causes added, errs well less than the vehicle moves, or hardly errs any more.
    Where it does neither, it replays an autopilot's answers to disturbances that nobody logged, which shows nothing about the vehicle."""
    moved = [np.where(part.ok, part.y - (part.y * part.ok).sum((0, 1)) / np.maximum(part.ok.sum((0, 1)), 1), 0.0) for part in problem.parts]
    motion = axis_weight(problem, moved)
    closed = _closed(was, left)
    asked = {max(closed, key=lambda axis: closed[axis]), *acting(closed, MUCH)}
    return all(left[axis] <= max(HARDLY * was[axis], SKILL * motion[axis]) for axis in asked)


def _closed(was: Mapping[str, float], left: Mapping[str, float]) -> dict[str, float]:
    return {axis: max(was[axis] - left[axis], 0.0) for axis in was}


def harms(way: Way, own: Sequence[str] = ()) -> bool:
    """Whether an axis gets worse by a good part of what is closed in all, or one that a cause is said to be of, its ``own``, by more than a little."""
    before, after = sum(way.was.values()), sum(way.left.values())
    worse = {axis: way.left[axis] - way.was[axis] for axis in way.was}
    return max(worse.values()) > max(HARMS * (before - after), UNMOVED * before) or any(worse[axis] > WORSE * before for axis in own)


def stand(ways: Sequence[Way], seen: bool, own: Sequence[str] = ()) -> bool:
    """Whether one of the ways shows the causes; ``seen``: the kinematic checks do, and motion need not; ``own``: axes that they are said to be of."""
    return any(not harms(way, own) and (seen or (way.sure and way.skill)) for way in ways)


def checked(problem: Problem, final: Confirmed) -> bool:
    """Whether the kinematic checks see faults of sensors at all: there are none to ask, or what they show is closed with evidence."""
    return not _checks(problem).any() or float(_closed_there(problem, final)) > LEAST_EVIDENCE


def seen_by_checks(problem: Problem, final: Confirmed) -> bool:
    """Whether the kinematic checks by themselves name the faults of sensors: no error of the dynamics leaves a trace there."""
    closed = _closed_there(problem, final)
    return closed * problem.inflation > SEEN * float(_checks(problem).sum()) and closed > SURELY


def _closed_there(problem: Problem, final: Confirmed) -> float:
    """What is closed, on held-out windows, of what the kinematic checks show, in evidence."""
    return float((_checks(problem) - (final.loss - final.dynamic_loss)).sum()) / problem.inflation


def _checks(problem: Problem) -> Array:
    """What the kinematic checks of each window (m,) show."""
    return np.asarray(problem.gap_data.c - problem.gap.c)
