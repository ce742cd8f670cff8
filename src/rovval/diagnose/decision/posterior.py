"""Posterior probability of every model that was compared: a healthy vehicle, causes, a file that is off in many numbers, and something else.

All are on one scale: prior mass times marginal likelihood, the likelihood tempered for equations that are only nearly right (coarsened posterior:
Miller and Dunson 2019; `problem.Problem.tempering`). Something else is what no effect of the library is: a few generic forces, on a healthy vehicle or
beside causes (model discrepancy: Kennedy and O'Hagan 2001).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import exp, log

from rovval.diagnose.criteria import GROUP_PROBABILITY, PRIOR_FILE, PRIOR_HEALTHY, PRIOR_SOMETHING_ELSE
from rovval.diagnose.search.forward import Selection
from rovval.diagnose.search.model import Model

Names = frozenset[str]


@dataclass(frozen=True, slots=True)
class Probabilities:
    """Posterior probabilities (1), which sum to one over all models.

    Attributes:
        sets: of each set of causes on a healthy vehicle, by their names; the empty set is the healthy vehicle.
        beside: of sets of causes with something else beside them.
        file: of a file that is off in many numbers.
        something_else: of something else alone, or of what comes near to a set of causes whose sizes would have to vary along the log.
        varying: the latter part of it.
    """

    sets: Mapping[Names, float]
    beside: Mapping[Names, float]
    file: float
    something_else: float
    varying: float

    @property
    def healthy(self) -> float:
        """Of a healthy vehicle."""
        return self.sets[frozenset()]

    @property
    def causes(self) -> float:
        """Of causes, alone or with something else beside them."""
        return sum(p for names, p in self.sets.items() if names) + sum(self.beside.values())

    @property
    def best(self) -> Names:
        """The most probable set of causes, whatever is beside it; empty where there is none."""
        whole = self._whole()
        return max(whole, key=lambda names: whole[names], default=frozenset())

    def of(self, name: str) -> float:
        """That a cause is at work."""
        return sum(p for names, p in self._whole().items() if name in names)

    def partly(self, names: Names) -> bool:
        """Whether something else is more likely beside these causes than not."""
        return self.beside.get(names, 0.0) > self.sets.get(names, 0.0)

    def group(self, name: str) -> tuple[tuple[str, float], ...]:
        """The confusion group of a cause of the most probable set: the fewest names that hold `GROUP_PROBABILITY` of the probability of sets that
        differ from that one in this cause only, itself first."""
        rest, whole = self.best - {name}, self._whole()
        weight = {other: p for names, p in whole.items() if rest < names and len(names - rest) == 1 for other in names - rest}
        total, kept, held = sum(weight.values()), list[tuple[str, float]](), 0.0
        for other in sorted(weight, key=lambda one: (one != name, -weight[one])):
            if held < GROUP_PROBABILITY * total:
                kept.append((other, weight[other] / total))
                held += weight[other]
        return tuple(kept)

    def _whole(self) -> dict[Names, float]:
        return {n: self.sets.get(n, 0.0) + self.beside.get(n, 0.0) for n in {*self.sets, *self.beside} if n}


def probabilities(selection: Selection, file_evidence: float, forces: float, beside: Mapping[Names, float], varying: float) -> Probabilities:
    """Probabilities of the models that a search met.

    Args:
        selection: what the search met.
        file_evidence: of a file that is off in many numbers, twice the log Bayes factor over the vehicle as its file has it.
        forces: evidence of something else on the healthy vehicle, over it; its prior among such forces included.
        beside: the same of something else beside sets of causes, over these.
        varying: the same of a cause of the best set that varies along the log, over that set.
    """
    best = _best_of_each_set(selection.models)
    doubt = log(PRIOR_SOMETHING_ELSE / PRIOR_HEALTHY)
    nothing = best[frozenset()]
    known = {("sets", names): m.log_posterior for names, m in best.items()}
    known |= {("beside", names): best[names].log_posterior + doubt + 0.5 * more for names, more in beside.items()}
    known["file", frozenset()] = log(PRIOR_FILE) + 0.5 * file_evidence
    known["else", frozenset()] = nothing.log_posterior + doubt + 0.5 * forces
    if selection.best.causes:
        known["varying", frozenset()] = selection.best.log_posterior + doubt + 0.5 * varying
    top = max(known.values())
    weight = {key: exp(value - top) for key, value in known.items()}
    total = sum(weight.values())
    share = {key: value / total for key, value in weight.items()}
    return Probabilities(
        sets={names: p for (kind, names), p in share.items() if kind == "sets"},
        beside={names: p for (kind, names), p in share.items() if kind == "beside"},
        file=share["file", frozenset()], varying=share.get(("varying", frozenset()), 0.0),
        something_else=share["else", frozenset()] + share.get(("varying", frozenset()), 0.0),
    )  # fmt: skip


def _best_of_each_set(models: Iterable[Model]) -> dict[Names, Model]:
    """Of models of one set of causes that were fitted from different starts, the one with the most evidence."""
    found = dict[Names, Model]()
    for m in models:
        if m.names not in found or m.evidence > found[m.names].evidence:
            found[m.names] = m
    return found
