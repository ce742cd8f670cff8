"""Resemblance: what looks like a cause and is none, told by how much of the gap is left on held-out windows with it.

A comparison of models does not show it: of models that are all wrong one is the best. Two things look like causes of the library. What the library lacks
mostly resembles something of it (`LIBRARY_ALIKE`). It then closes some part of what is at work, any part alike, where causes whose equations are nearly
right close most of it: the share that is left is uniform, or beta distributed about `CAUSES_LEAVE` and densest at nothing. And what the equations of causes
are off by may look like one more cause (`FORM_ALIKE`). It closes next to nothing of what the others leave of windows that it was not fitted to, while a cause
of its own closes any part of it: here the share that is left is beta distributed about `FORM_LEAVES` and densest at all of it, or uniform.

A healthy vehicle has a gap, too: coefficients and sensors are off within their tolerances. No cause closes that part, and what is left of it says nothing of
whether the library lacks something, or of whether a further cause is one. How large it is in a log is unknown; it is exponential about the share of what
tolerances could make that healthy vehicles show (`HEALTHY_GAP`), and integrated over. So a weak effect is not taken for something else because it leaves what
many a healthy vehicle shows. What a calibrated vehicle left of its own logs no cause closes either; but a further one may, as the form error of
the others, since it goes with the motion.

Beside what only looks like a cause generic forces often show that go with the motion: the rest of what it really is. Beside causes they hardly ever do
(`SHOWS_BESIDE`). In the fine metric (`problem.problem`) they show on a vehicle without causes already. Right causes take more or less of them away where they
act, but where their equations are others here (`NOT_FOUND`). What only looks like causes adds to them as often as not: what it closes in one way it opens in
another (`adds_to_forces`).

Forces that nobody logged are a nuisance of every model, as large as the log shows them, so that the likelihood alone never calls them too large. Beside right
causes they are what pilots and seas make, some per cent of the thrusters' own (`FORCE_RIGHT`); beside what only looks like them they take over the rest of what
it really is (`FORCE_ALIKE`). Both are log-logistic: now and then a pilot, a sea or a real vehicle leaves many times as much, and no force by itself decides.
About a healthy vehicle there is as little as beside right causes, so that it tells these two from something else and not from each other: it is judged
once for both, beside the most probable of all models.

Shares are of the errors above the noise of the sensors. Whether causes are of the library is judged where they act: by what they leave of the gap on each
axis, and of the parity residuals, which faults of sensors close, the mean of these weighted with how much of each they close or open; what they open speaks as
much against them as what they close speaks for them, however little there was of it. A real vehicle is off
on several axes for several reasons, and a cause that closes the gap in yaw is no worse for what is left in pitch. A set is judged with the best of its parts.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from math import exp, log, log1p

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.criteria import (
    CALIBRATED_SPREAD,
    CAUSES_LEAVE,
    FORCE_ALIKE,
    FORCE_RIGHT,
    FORCE_SHAPE,
    FORM_ALIKE,
    FURTHER_CAUSE,
    HEALTHY_GAP,
    LEAST_EVIDENCE,
    LIBRARY_ALIKE,
    MATERIAL,
    NOT_FOUND,
    PRIOR_CAUSES,
    PRIOR_FILE,
    PRIOR_SOMETHING_ELSE,
    SHOWS_BESIDE,
    VARIATIONS,
)
from rovval.diagnose.inference.gap import (
    TINY,
    calibrated_by_part,
    errors_by_part,
    noise_by_part,
    spread_as_calibrated,
    tolerated_by_part,
    tolerated_share,
)
from rovval.diagnose.inference.hypothesis_fit import HypothesisFit
from rovval.diagnose.inference.shrinkage import NOTHING_LEFT, explainable_left, form_error, odds_of_left
from rovval.diagnose.inference.unlogged_forces import ForceLeft, where_causes_act
from rovval.diagnose.problem.problem import Problem, corrected_residuals
from rovval.diagnose.search.model import Model, Names
from rovval.simulation.fitted_errors import spread_of_errors
from rovval.simulation.fitted_tolerances import fitted_sizes


@dataclass(frozen=True, slots=True)
class Left:
    """What sets of causes leave of the gap above noise on held-out windows.

    Attributes:
        shares: of each set the shares (2,) that it leaves of the dynamics alone and with the parity residuals; of several fits of a set, the least. Above 1
            where it adds to the gap.
        acting: of each set the share that it leaves where it acts, 1 where it closes nothing; and the share that a healthy vehicle is expected to show there.
        grown: of each set how many times the gap where it acts is what the calibration left there; empty without calibration.
        grown_by_axis: the same of each axis, whatever acts there.
        forced: the axes on which the few generic forces act that explain most of what a healthy vehicle leaves.
        spread: by how much a vehicle that is as it was calibrated may show so (`gap.spread_as_calibrated`).
        unlogged: of each set that was asked the force that nobody logged where it acts (`unlogged_where_they_act`), and of no cause that about the healthy
            vehicle (`unlogged_about_healthy`).
        adding: the sets that add to generic forces where they act (`adds_to_forces`), of those that were asked.
        tolerated: shares (2,) of the gap that a healthy vehicle is expected to show by its tolerances, as ``shares``.
        sizes: of each set how large its parameters are beside what they seemed to be in the calibration's logs (standard deviations); empty without.
        freedom: degrees of freedom by which these standard deviations are known.
    """

    shares: Mapping[Names, Array]
    acting: Mapping[Names, tuple[float, float]]
    grown: Mapping[Names, float] = field(default_factory=dict)
    grown_by_axis: Mapping[str, float] = field(default_factory=dict)
    forced: tuple[str, ...] = ()
    spread: float = CALIBRATED_SPREAD
    unlogged: Mapping[Names, ForceLeft] = field(default_factory=dict)
    adding: frozenset[Names] = frozenset()
    tolerated: Array = field(default_factory=lambda: np.full(2, TINY))
    sizes: Mapping[Names, tuple[float, ...]] = field(default_factory=dict)
    freedom: float = 1.0

    def least(self, which: Callable[[Names], bool]) -> Array:
        """The least (2,) that is left by the sets ``which``; all of the gap where there is none."""
        shares = [share for part, share in self.shares.items() if which(part)]
        return np.min(shares, axis=0) if shares else np.ones(2)

    def where_they_act(self, names: Names) -> tuple[float, float]:
        """What causes leave where they act (`acting`), with the best of their parts; all where none was fitted."""
        best = self._best_part(names)
        return self.acting[best] if best else (1.0, TINY)

    def grown_since(self, names: Names) -> tuple[float, ...]:
        """How many times the gap is what the calibration left where causes act, with the best of their parts (`grown`); of none on each axis on which generic
        forces act, on any where there are none; () where that is not known."""
        best = self._best_part(names)
        if best in self.grown or names:
            return (self.grown[best],) if best in self.grown else ()
        return tuple(self.grown_by_axis[axis] for axis in self.forced if axis in self.grown_by_axis) or tuple(self.grown_by_axis.values())

    def sizes_since(self, names: Names) -> tuple[float, ...]:
        """How large the parameters of causes are beside what they seemed to be in the calibration's logs, of the best of their parts; () where that is not
        known."""
        return self.sizes.get(self._best_part(names), ())

    def _best_part(self, names: Names) -> Names:
        """The part of ``names`` that leaves least; none where none was fitted."""
        return min((part for part in self.shares if part <= names), key=lambda part: float(self.shares[part].min()), default=frozenset())

    def without(self, name: str, names: Names) -> Array:
        """Shares (2,) that the causes of ``names`` but for the cause ``name`` leave."""
        return self.least(lambda part: name not in part and part <= names)

    def beyond(self, name: str, names: Names) -> Array:
        """Shares (2,) that the cause ``name`` of ``names`` leaves of what the others leave; above 1 where it adds to it."""
        return self.least(lambda part: name in part and part <= names) / self.without(name, names)


def gap_left(problem: Problem, models: Iterable[Model]) -> Left:
    """What each set of causes that was fitted leaves."""
    fits = [(m.names, m.fit) for m in models if m.fit]
    losses = [np.array([fit.dynamics_loss.sum(), fit.loss.sum()]) for _, fit in fits]
    shares, acting, gap = dict[Names, Array](), dict[Names, tuple[float, float]](), _Gap.of(problem)
    grown, sizes = dict[Names, float](), dict[Names, tuple[float, ...]]()
    axes = {part: gap.errors[part] / size for part, size in gap.calibrated.items() if size > 0.0}
    for (names, fit), share in zip(fits, explainable_left(problem, losses), strict=True):
        if names not in shares or share.min() < shares[names].min():
            acting[names] = gap.left_where_it_acts(fit.parts)
            if gap.calibrated:
                grown[names], sizes[names] = gap.grown(fit.parts), _beside_apparent(problem, fit)
        shares[names] = np.minimum(share, shares.get(names, np.inf))
    vehicle = problem.plant.vehicle
    return Left(
        shares, acting, grown, axes, sizes=sizes, freedom=1.0 + spread_of_errors(vehicle)[1],
        spread=spread_as_calibrated(vehicle), tolerated=tolerated_share(problem),
    )  # fmt: skip


def _beside_apparent(problem: Problem, fit: HypothesisFit) -> tuple[float, ...]:
    """How large the fitted parameters are, in standard deviations of what they seem to be in the logs of the vehicle's calibration and of their own error."""
    known, point = fitted_sizes(problem.plant.vehicle), fit.posterior
    if not known:
        return ()
    moved = point.columns[: point.effect_count]
    keys = [(problem.plant.slots[s].key, s, float(sd)) for s, sd in zip(moved, point.effect_sd(), strict=True)]
    return tuple(abs(float(fit.beta[s] - problem.origin[s])) / float(np.hypot(known[key], sd)) for key, s, sd in keys if key in known)


@dataclass(frozen=True, slots=True)
class _Gap:
    """The gap of each axis and of each parity relation: ``errors`` of the vehicle as its file has it above ``noise``, and what a ``healthy`` one is expected to
    show of them; ``calibrated`` what the calibration left of them, empty without one."""

    errors: Mapping[str, float]
    noise: Mapping[str, float]
    healthy: Mapping[str, float]
    calibrated: Mapping[str, float]

    @classmethod
    def of(cls, problem: Problem) -> _Gap:
        nominal, noise = errors_by_part(problem, corrected_residuals(problem), problem.origin), noise_by_part(problem)
        calibrated = calibrated_by_part(problem)
        known = calibrated if any(calibrated.values()) else {}
        healthy = {part: HEALTHY_GAP * size + calibrated.get(part, 0.0) for part, size in tolerated_by_part(problem).items()}
        return cls({part: size - noise[part] for part, size in nominal.items()}, noise, healthy, known)

    def grown(self, errors: Mapping[str, float]) -> float:
        """How many times the gap is what the calibration left, the parts weighted with how much each changes with the ``errors`` of causes."""
        change = {part: abs(self.errors[part] - (size - self.noise[part])) for part, size in errors.items()}
        now, then = (sum(change[part] * size.get(part, 0.0) for part in change) for size in (self.errors, self.calibrated))
        return now / max(then, TINY * now) if now > 0.0 else 1.0

    def left_where_it_acts(self, errors: Mapping[str, float]) -> tuple[float, float]:
        """The share that is left of each part of the gap, and that a healthy vehicle is expected to show of it, both weighted with the change of that part; all
        of it where no part becomes smaller. A part that becomes larger counts as one that becomes smaller by as much, above 1 instead of below."""
        left = {part: size - self.noise[part] for part, size in errors.items() if self.errors[part] > 0.0}
        change = {part: abs(self.errors[part] - size) for part, size in left.items()}
        if all(size >= self.errors[part] for part, size in left.items()):
            return 1.0, TINY
        whole = {part: max(self.errors[part], size) for part, size in left.items()}
        share = sum(size * max(1.0 - (self.errors[part] - left[part]) / whole[part], NOTHING_LEFT) for part, size in change.items())
        healthy = sum(size * self.healthy[part] / whole[part] for part, size in change.items())
        return share / sum(change.values()), max(healthy / sum(change.values()), TINY)


def adds_to_forces(alone: Mapping[str, float], beside: Mapping[str, float]) -> bool:
    """Whether generic forces have more evidence (`discrepancy.forces_beside`) ``beside`` causes than ``alone``, on a healthy vehicle: in all, of the axes on
    which the causes change it by a `MATERIAL` part that is strong (`LEAST_EVIDENCE`)."""
    more = [(beside[axis] - size, max(beside[axis], size)) for axis, size in alone.items() if axis in beside]
    return sum(change for change, whole in more if abs(change) > max(LEAST_EVIDENCE, MATERIAL * whole)) > 0.0


def unlogged_where_they_act(problem: Problem, left: Mapping[str, float], nominal: Mapping[str, float], wanders: bool) -> ForceLeft:
    """The unlogged force that is ``left`` where causes act, by axis, of that beside the ``nominal`` vehicle, and its median where they are right: what pilots,
    seas and equations leave (`FORCE_RIGHT`), and, of a cause that ``wanders`` by nature, its variation (`VARIATIONS`); and where they only look so
    (`FORCE_ALIKE`). What a calibration left is beside either."""
    calibrated, at_first = (where_causes_act(size, left, nominal) for size in (_calibration_left(problem, nominal), nominal))
    right = FORCE_RIGHT + (VARIATIONS[0] * at_first if wanders else 0.0)
    return ForceLeft(where_causes_act(left, left, nominal), right + calibrated, FORCE_ALIKE + calibrated)


def unlogged_about_healthy(problem: Problem, left: Mapping[str, float]) -> ForceLeft:
    """The same of a healthy vehicle, beside which there is as much ``left``, by axis: where all that takes it away would act."""
    nothing = dict.fromkeys(left, 0.0)
    size, calibrated = (where_causes_act(one, nothing, left) for one in (left, _calibration_left(problem, left)))
    return ForceLeft(size, FORCE_RIGHT + calibrated, FORCE_ALIKE + calibrated)


def _calibration_left(problem: Problem, force: Mapping[str, float]) -> dict[str, float]:
    """The part of the ``force`` about a vehicle without causes that a calibration left, by axis; none without calibration."""
    gap = _Gap.of(problem)
    return {axis: size * min(gap.calibrated.get(axis, 0.0) / max(gap.errors[axis], TINY), 1.0) ** 0.5 for axis, size in force.items()}


def evidence_by_force(left: ForceLeft) -> float:
    """Twice the log Bayes factor of what only looks like causes over these, by the unlogged force that is left where they act: log-logistic about what is
    expected of either, of one shape, so that the odds are bounded, of no force at all, too."""
    right, alike = (-FORCE_SHAPE * log(median) - 2.0 * log1p((left.size / median) ** FORCE_SHAPE) for median in (left.expected, left.alike))
    return 2.0 * (alike - right)


@dataclass(frozen=True, slots=True)
class Explained:
    """What causes leave, as evidence: the log Bayes factor ``evidence`` of all that would look like them over something else that does not, by what is left
    alone, and the parts of it (1) that are these causes (``right``) and what the calibration of the vehicle left (``as_calibrated``). The rest is something
    else, which only looks like them."""

    evidence: float
    right: float
    as_calibrated: float


def what_is_left(names: Names, left: Left | None, beside: bool = False, as_calibrated: float = 0.0, wanders: bool = False) -> Explained:
    """What the causes ``names`` leave, as evidence; the priors alone where nothing is known of it.

    That generic forces show ``beside`` them is evidence (`SHOWS_BESIDE`); that causes are ``adding`` to them is more of it, from the same forces, and counts
    instead. That none shows says little of a small gap, and is not counted. What a calibration left, by the odds ``as_calibrated`` of it over causes, closes
    any part of the gap as something else does, and leaves as little of a force that nobody logged as causes do. How much of the gap causes close that all go
    on otherwise from window to window (``wanders``) says nothing.
    """
    shows = SHOWS_BESIDE[1] / SHOWS_BESIDE[0] if beside else 1.0
    right, force = 1.0, exp(little_force(names, left))
    if left is not None and not wanders:
        freedom = 1.0 / CAUSES_LEAVE - 1.0  # Beta(1, b), of mean 1 / (1 + b)
        right = odds_of_left(*left.where_they_act(names), lambda share: freedom * (1.0 - share) ** (freedom - 1.0))
        shows = SHOWS_BESIDE[1] / NOT_FOUND if names in left.adding else shows
    total = (right + as_calibrated) * force + LIBRARY_ALIKE * PRIOR_SOMETHING_ELSE / PRIOR_CAUSES * shows
    return Explained(log(total), right * force / total, as_calibrated * force / total)


def little_force(names: Names, left: Left | None) -> float:
    """Log Bayes factor of a vehicle about which nothing else is at work over something else, by the force that nobody logged where the causes ``names`` act, or
    about the vehicle without causes; 0 where it is not known, or they close nothing and so act nowhere."""
    if left is None or names not in left.unlogged or (names and left.where_they_act(names)[0] >= 1.0):
        return 0.0
    return -0.5 * evidence_by_force(left.unlogged[names])


def looks_only_like_a_file() -> float:
    """Probability that what looks like a file that is off in many numbers, and like no cause, is none of the library: by the priors alone. So many numbers
    imitate whatever acts."""
    odds = LIBRARY_ALIKE * PRIOR_SOMETHING_ELSE / PRIOR_FILE
    return odds / (1.0 + odds)


def looks_like_form_error(name: str, names: Names, left: Left | None) -> float:
    """Probability that the cause ``name`` of ``names`` is the form error of the others; by the priors alone where nothing is known of what they leave."""
    if left is None:
        return FORM_ALIKE / (FORM_ALIKE + FURTHER_CAUSE)
    return form_error(left.beyond(name, names), left.tolerated / left.without(name, names))
