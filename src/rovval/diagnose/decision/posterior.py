"""Posterior probability of every model that was compared: a healthy vehicle, causes, a file that is off in many numbers, and something else.

All are on one scale: prior mass times marginal likelihood, the likelihood tempered for equations that are only nearly right (coarsened posterior:
Miller and Dunson 2019; `problem.Problem.tempering`). Something else is what no effect of the library is: a few generic forces, on a healthy vehicle or
beside causes (model discrepancy: Kennedy and O'Hagan 2001), or forces that go with nothing that was logged; either leaves an open gap (`open_gap`). A log
that no set of causes explains may be of one all the same: the search may not come near it, or its equations may be others here (`NOT_FOUND`).

No log tells two explanations apart that predict the same; they share its probability by their priors. So something else has a part of the mass of every set
of causes, and no cause is ever certain; a larger part where a force that goes with the motion shows beside them. How much of the gap causes leave where windows
are held out, and which force that nobody logged, is evidence as their fit is (`resemblance`): over each other, over generic forces, which imitate causes that
close all of the gap, and over a healthy vehicle. What causes that wander by nature leave is their own: how they are in some windows does not tell how they go
on in others. The set without the cause that adds least has another part, since that cause may be what the equations of the others are off by. A cause of which
the size varies is that cause in another form, or something else that comes near it (`constancy`). Of a calibrated vehicle either may be what the calibration
left (`as_calibrated`). Which of several sets of as many causes it is, is less sure than how well they fit: each is only nearly right in its form
(`BETWEEN_CAUSES`).

The set that is named has as many causes as is most probable, and of such sets it is the one that the true one is expected to share the most causes with
(centroid estimator: Carvalho and Lawrence 2008). The most probable single set may hold a cause that most of the others do without. A further cause is named
where it, or one that the log does not tell from it, is as likely at work (`NAMED_FROM`), causes being at work.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import exp, inf, log
from typing import Literal, TypeVar

import numpy as np

from rovval.diagnose.criteria import (
    BETWEEN_CAUSES,
    GROUP_PROBABILITY,
    MATERIAL,
    NAMED_FROM,
    NOT_FOUND,
    PRIOR_CAUSES,
    PRIOR_FILE,
    PRIOR_HEALTHY,
    PRIOR_SOMETHING_ELSE,
)
from rovval.diagnose.decision.as_calibrated import odds_as_calibrated, sizes_as_they_were
from rovval.diagnose.decision.constancy import Variation
from rovval.diagnose.decision.resemblance import (
    Explained,
    Left,
    little_force,
    looks_like_form_error,
    looks_only_like_a_file,
    what_is_left,
)
from rovval.diagnose.effort import NEGLIGIBLE
from rovval.diagnose.search.model import Model, Names, best_of_each_set

Key = TypeVar("Key")
Entry = tuple[str, Names]  # of a model: its kind, and its causes
CAUSES = ("sets", "beside", "filed")  # kinds of models with causes: these alone, with something else, and with a file that is off in further numbers
VARYING = "varying "  # what only comes near to one cause of a set, its name behind it
HEALTHY: Entry = ("sets", frozenset())
FILE: Entry = ("filed", frozenset())
ELSE: Entry = ("else", frozenset())
FORM = "form"  # and those in another form, which are told as causes with something else beside them


@dataclass(frozen=True, slots=True)
class Probabilities:
    """Posterior probabilities (1), which sum to one over all models.

    Attributes:
        sets: of each set of causes on a healthy vehicle, by their names; the empty set is the healthy vehicle.
        beside: of sets of causes with something else beside them.
        filed: of sets of causes with a file that is off in further numbers beside them, and whatever else.
        file: of a file that is off in many numbers, whatever else is beside it, and of no cause.
        something_else: of something else alone, of what looks like a set of causes and is none, or of what comes near to a set of causes whose sizes would have
            to vary along the log.
        not_found: the part of that which is of the library all the same: the search did not come near it, or its equations are others here.
        varying: the part of both whose size would have to vary.
    """

    sets: Mapping[Names, float]
    beside: Mapping[Names, float]
    filed: Mapping[Names, float]
    file: float
    something_else: float
    not_found: float
    varying: float

    @property
    def healthy(self) -> float:
        """Of a healthy vehicle."""
        return self.sets[frozenset()]

    @property
    def causes(self) -> float:
        """Of causes, whatever is beside them."""
        return sum(self._whole().values())

    @property
    def unexplained(self) -> float:
        """That no model which was fitted is so: of something else, and of causes that were not found."""
        return self.something_else + self.not_found

    @property
    def said(self) -> Literal["causes", "healthy"] | None:
        """What is said: causes, or a healthy vehicle; None where neither is probable enough (`NAMED_FROM`), though it may be the most probable of several."""
        return "causes" if self.causes > NAMED_FROM else "healthy" if self.healthy > NAMED_FROM else None

    @property
    def best(self) -> Names:
        """The set of causes that is named where causes are believed: as many as is most probable, and those of which the true set, if it has as many, is
        expected to hold the most, of the sets that are not negligible beside the most probable one (`NEGLIGIBLE`), without those that are not likely
        enough at work (`NAMED_FROM`) where causes are, whichever of its group it is; empty where there is none."""
        whole = self._whole()
        count = max((len(names) for names in whole), key=lambda n: sum(p for names, p in whole.items() if len(names) == n), default=0)
        alike = {names: p for names, p in whole.items() if len(names) == count}
        likely = [names for names in self.ranked if alike.get(names, 0.0) >= NEGLIGIBLE * max(alike.values())]
        shared = {names: sum(len(names & other) * p for other, p in alike.items()) for names in likely}
        named = max(likely, key=lambda names: shared[names], default=frozenset[str]())
        while len(named) > 1:
            likely_at_work = {name: self._at_work(name, named) for name in sorted(named)}
            least = min(likely_at_work, key=lambda name: likely_at_work[name])
            if likely_at_work[least] > NAMED_FROM * self.causes:
                break
            named -= {least}
        return named

    @property
    def ranked(self) -> list[Names]:
        """The sets of causes, the most probable first, whatever is beside them."""
        whole = self._whole()
        return sorted(whole, key=lambda names: -whole[names])

    def of(self, name: str) -> float:
        """That a cause is at work."""
        return sum(p for names, p in self._whole().items() if name in names)

    def off_beside(self, names: Names) -> bool:
        """Whether further numbers of the file are more likely off beside these causes than not."""
        return self.filed.get(names, 0.0) > self.sets.get(names, 0.0) + self.beside.get(names, 0.0)

    def group(self, name: str) -> tuple[tuple[str, float], ...]:
        """The confusion group of a cause of the set that is named: the fewest names that hold `GROUP_PROBABILITY` of the probability of sets that
        differ from that one in this cause only, itself first."""
        return self._group(name, self.best)

    def _at_work(self, name: str, named: Names) -> float:
        """Probability that a cause of a set, or one of its group there, is at work."""
        group = {name, *(other for other, _ in self._group(name, named))}
        return sum(p for names, p in self._whole().items() if names & group)

    def _group(self, name: str, named: Names) -> tuple[tuple[str, float], ...]:
        rest, whole = named - {name}, self._whole()
        weight = {other: p for names, p in whole.items() if rest < names and len(names - rest) == 1 for other in names - rest}
        total, kept, held = sum(weight.values()), list[tuple[str, float]](), 0.0
        for other in sorted(weight, key=lambda one: (one != name, -weight[one])):
            if held < GROUP_PROBABILITY * total:
                kept.append((other, weight[other] / total))
                held += weight[other]
        return tuple(kept)

    def _whole(self) -> dict[Names, float]:
        parts = self.sets, self.beside, self.filed
        return {n: sum(part.get(n, 0.0) for part in parts) for n in dict.fromkeys((*self.sets, *self.beside, *self.filed)) if n}


def probabilities(
    models: Sequence[Model], file: Mapping[Names, float], forces: float, beside: Mapping[Names, float], varying: Mapping[Names, Variation],
    open_gap: float = 0.0, left: Left | None = None,
) -> Probabilities:
    """Probabilities of the models that a search met.

    Args:
        models: those that the search met, the healthy vehicle among them.
        file: of a file that is off in many numbers, twice the log Bayes factor over the vehicle as its file has it: beside no cause, and beside sets
            of causes.
        forces: evidence of something else on the healthy vehicle, over it; its prior among such forces included.
        beside: the same of something else beside sets of causes, over these.
        varying: the same of a cause of which the size varies, over the set that it is of: that cause in another form, and something else that comes near it.
        open_gap: the same of something else, beside whatever cause, by how much no model explains (`open_gap.evidence_of_something_else`).
        left: of the explainable gap, what sets of causes leave on held-out windows (`resemblance.gap_left`); without it, priors alone judge.
    """
    best = best_of_each_set(models)
    known = _log_posteriors(best, file, forces, beside, varying, open_gap)
    wandering = {h.name for m in models for h in m.causes if h.effect.wanders}
    sets = {names for _, names in known} | {names - {name} for names, more in varying.items() for name in more.alike}
    explained = {names: _explained(names, left, beside.get(names, -inf), names <= wandering) for names in sets if names}
    _weigh_what_is_left(known, explained, left)
    top = max(known.values())
    whole = sum(exp(value - top) for value in known.values())
    believed = {key: exp(value - top) / whole for key, value in known.items()}
    for names, more in varying.items():
        _leave_what_varies(believed, names, more)
    share = _without_what_looks_alike(believed, explained, left)
    for names in varying:
        share["beside", names] = share.get(("beside", names), 0.0) + share.pop((FORM, names))
    _move_form_errors(share, best, left)
    _coarsen(share)
    inconstant = sum(p for (kind, _), p in share.items() if kind.startswith(VARYING))
    unexplained = share[ELSE] + inconstant + sum(believed.values()) - sum(share.values())
    missed = NOT_FOUND * PRIOR_CAUSES / (NOT_FOUND * PRIOR_CAUSES + PRIOR_SOMETHING_ELSE)
    return Probabilities(
        sets={names: p for (kind, names), p in share.items() if kind == "sets"},
        beside={names: p for (kind, names), p in share.items() if kind == "beside"},
        filed={names: p for (kind, names), p in share.items() if kind == "filed" and names},
        file=share.get(FILE, 0.0), varying=inconstant,
        something_else=(1.0 - missed) * unexplained, not_found=missed * unexplained,
    )  # fmt: skip


def _log_posteriors(
    best: Mapping[Names, Model], file: Mapping[Names, float], forces: float, beside: Mapping[Names, float], varying: Mapping[Names, Variation], open_gap: float
) -> dict[Entry, float]:
    """Log posterior, by prior and fit, of every model: of sets of causes, the healthy vehicle among them, alone and with something else beside them; of a file
    that is off in many numbers, alone or not; of something else alone that looks like nothing of the library; and of causes whose size varies."""
    doubt, filed = log(PRIOR_SOMETHING_ELSE / PRIOR_HEALTHY), log(PRIOR_FILE / PRIOR_HEALTHY)
    known = {("sets", names): m.log_posterior for names, m in best.items()}
    known |= {("beside", names): m.log_posterior + doubt + _something_else(beside.get(names, -inf), open_gap) for names, m in best.items() if names}
    alone = float(np.logaddexp(0.0, doubt + _something_else(-inf, open_gap)))  # and with something else beside it
    known |= {("filed", names): best[names].log_prior + filed + 0.5 * evidence + alone for names, evidence in file.items()}
    known[ELSE] = known[HEALTHY] + doubt + _something_else(forces, open_gap)
    for names, more in varying.items():  # what only comes near a cause, or that cause in another form
        known[FORM, names], alike = _log_varying(best[names], more)
        known |= {(VARYING + name, names): value for name, value in alike.items()}
    return known


def _explained(names: Names, left: Left | None, forces: float, wanders: bool) -> Explained:
    """What a set of causes leaves, as evidence; generic ``forces`` beside causes that all wander are their own."""
    return what_is_left(names, left, forces > -inf and not wanders, _as_calibrated(left, names, PRIOR_CAUSES), wanders)


def _weigh_what_is_left(known: dict[Entry, float], explained: Mapping[Names, Explained], left: Left | None) -> None:
    """Add to the log posteriors ``known`` the evidence of what sets of causes leave. Of a vehicle without causes the force that nobody logged is judged beside
    the most probable model, itself or causes, where these act."""
    for kind, names in known:
        if names and kind in (*CAUSES, FORM):
            known[kind, names] += explained[names].evidence
    asked = [(value, names) for (kind, names), value in known.items() if left is not None and kind in (*CAUSES, FORM) and names in left.unlogged]
    force = little_force(max(asked, key=lambda one: one[0])[1], left) if asked else 0.0
    for key in (HEALTHY, FILE):
        if key in known:
            known[key] += force


def _without_what_looks_alike(believed: Mapping[Entry, float], explained: Mapping[Names, Explained], left: Left | None) -> dict[Entry, float]:
    """Of what is believed of each model the part that is that model: without what only looks like it, and what the calibration left, which is the healthy
    vehicle's."""
    share = dict(believed)
    for key, whole in believed.items():
        kind, names = key
        right, as_it_was = 1.0, 0.0
        if names and kind in (*CAUSES, FORM):
            right, as_it_was = explained[names].right, explained[names].as_calibrated
        elif key == FILE:
            right -= looks_only_like_a_file()
        elif key == ELSE or kind.startswith(VARYING):
            odds = _as_calibrated(left, names, PRIOR_SOMETHING_ELSE)
            right, as_it_was = 1.0 / (1.0 + odds), odds / (1.0 + odds)
        share[key] -= (1.0 - right) * whole
        share[HEALTHY] += as_it_was * whole
    return share


def _as_calibrated(left: Left | None, names: Names, other: float) -> float:
    """Odds of a vehicle that is as it was calibrated over a model with these causes, of prior mass ``other``, by how the gap and their sizes have grown."""
    if left is None:
        return 0.0
    return odds_as_calibrated(left.grown_since(names), other, left.spread) * sizes_as_they_were(left.sizes_since(names), left.freedom)


def _log_varying(model: Model, varying: Variation) -> tuple[float, dict[str, float]]:
    """Log posterior of the causes of a model in another form, of which the size varies, and of something else that comes near to each of them; the one is as
    likely beforehand as the other, and both together as something else beside causes."""
    whole = model.log_posterior + log(PRIOR_SOMETHING_ELSE / PRIOR_HEALTHY) - log(2.0)
    return whole + 0.5 * varying.form, {name: whole + 0.5 * evidence for name, evidence in varying.alike.items()}


def something_beside(forces: float, varying: Variation) -> bool:
    """Whether something else is more likely beside causes than not, by the evidence over the causes of generic ``forces`` and of sizes that are ``varying``."""
    odds = log(PRIOR_SOMETHING_ELSE / PRIOR_HEALTHY)
    return odds + float(np.logaddexp(_something_else(forces, 0.0), 0.5 * varying.either)) > 0.0


def _something_else(forces: float, open_gap: float) -> float:
    """Log Bayes factor of something else, by both of what tells it: it is as likely to go with the motion (generic ``forces``) as with nothing that was
    logged, and either leaves an ``open_gap``."""
    return float(np.logaddexp(0.5 * forces, 0.0)) - log(2.0) + 0.5 * open_gap


def _leave_what_varies(believed: dict[Entry, float], names: Names, varying: Variation) -> None:
    """Divide the mass of causes of which a size varies between another form of them and something else that comes near to one, which leaves the others at work
    beside it. The odds are a power (`BETWEEN_CAUSES`) of what each has: which of them it is is no surer than which of several causes."""
    keys = [(FORM, names), *((VARYING + name, names) for name in varying.alike)]
    believed |= _coarser({key: believed[key] for key in keys})
    for name in varying.alike:
        if others := names - {name}:
            believed["beside", others] = believed.get(("beside", others), 0.0) + believed.pop((VARYING + name, names))


def _move_form_errors(share: dict[Entry, float], best: Mapping[Names, Model], left: Left | None) -> None:
    """Move that part of the mass of each set of two causes or more, of whatever kind, to the set without the cause that adds least, which says that this cause
    is the form error of the others."""
    for size in range(_most(share), 1, -1):
        for names in dict.fromkeys(names for kind, names in share if kind in CAUSES and len(names) == size):
            least = _least(names, best, left)
            part = looks_like_form_error(least, names, left)
            for kind in (kind for kind in CAUSES if (kind, names) in share):
                moved, fewer = share[kind, names] * part, (kind, names - {least})
                share[kind, names] -= moved
                share[fewer] = share.get(fewer, 0.0) + moved


def _coarsen(share: dict[Entry, float]) -> None:
    """Divide the mass of all sets of as many causes, whatever is beside them, among these sets by a power of what each has.

    How well two causes of a kind fit differs by the form of their equations as much as by which of them is at work, and none of these forms is exact: the
    likelihoods with which they are compared with each other are coarser than those of a vehicle with and without them."""
    for size in range(1, _most(share) + 1):
        keys = [(kind, names) for kind, names in share if kind in CAUSES and len(names) == size]
        whole = dict[Names, float]()
        for kind, names in keys:
            whole[names] = whole.get(names, 0.0) + share[kind, names]
        divided = _coarser(whole)
        for key in keys:
            if whole[key[1]] > 0.0:
                share[key] *= divided[key[1]] / whole[key[1]]


def _most(share: Mapping[tuple[str, Names], float]) -> int:
    """Causes of the largest set."""
    return max(len(names) for _, names in share)


def _coarser(mass: Mapping[Key, float]) -> dict[Key, float]:
    """The sum of masses divided among them by a power (`BETWEEN_CAUSES`) of what each has; one that has none is given none."""
    top = max(mass.values(), default=0.0)
    weight = {key: (p / top) ** BETWEEN_CAUSES if p > 0.0 else 0.0 for key, p in mass.items()}
    return {key: sum(mass.values()) * w / sum(weight.values()) if w > 0.0 else 0.0 for key, w in weight.items()}


def _least(names: Names, best: Mapping[Names, Model], left: Left | None) -> str:
    """The cause of a set that adds least to the others: that leaves most of what they leave of the gap, and of those that leave as much (to a `MATERIAL`
    part), or where nothing is known of that, adds least evidence; the last that was added where the sets without it were not fitted."""
    alike = sorted(names)
    if left is not None:
        kept = {name: float(left.beyond(name, names).min()) for name in alike}
        alike = [name for name in sorted(names, key=lambda name: -kept[name]) if kept[name] >= max(kept.values()) - MATERIAL]
    fitted = [name for name in alike if names - {name} in best]
    if fitted:
        return max(fitted, key=lambda name: best[names - {name}].evidence)
    if left is not None:
        return alike[0]
    return best[names].causes[-1].name if names in best else max(names)
