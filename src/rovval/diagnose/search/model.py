"""A model of the logs: a healthy vehicle with a set of causes, its evidence and its prior mass (Bayesian model comparison; Kass and Raftery 1995).

The prior mass of no cause, of one, of two and of three is fixed. It is divided evenly among the effects that compete for these logs, then among the
axes or thrusters that an effect may be of, so that an effect added to the library never makes it likelier that a healthy vehicle is blamed.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from math import factorial, log

from rovval.diagnose.criteria import FURTHER_CAUSE, PRIOR_CAUSES, PRIOR_HEALTHY
from rovval.diagnose.hypotheses.hypothesis import Hypothesis
from rovval.diagnose.inference.hypothesis_fit import HypothesisFit
from rovval.diagnose.problem.problem import Problem

Names = frozenset[str]  # of a set of causes


@dataclass(frozen=True, slots=True)
class Part:
    """The part of a log in which causes are at work that began with it.

    Attributes:
        since: s since the run's start from which on they are at work.
        problem: of the windows from there on.
        fit: of the causes to these windows alone, with sensitivities.
    """

    since: float
    problem: Problem
    fit: HypothesisFit


@dataclass(frozen=True, slots=True)
class Model:
    """A healthy vehicle with causes.

    Attributes:
        causes: in the order in which they were added; empty for the healthy vehicle.
        fit: their joint fit; None for the healthy vehicle.
        evidence: twice the log Bayes factor over the healthy vehicle.
        log_prior: logarithm of its prior mass.
        careful: whether its fit has sensitivities made at its own point. A quick one keeps those of another point, and may claim more than there is.
        part: of causes that begin in mid-log, the part in which they are at work; ``fit`` and ``evidence`` are of all windows, with a healthy vehicle before.
    """

    causes: tuple[Hypothesis, ...]
    fit: HypothesisFit | None
    evidence: float
    log_prior: float
    careful: bool = False
    part: Part | None = None

    @property
    def names(self) -> Names:
        """Names of the causes."""
        return frozenset(h.name for h in self.causes)

    @property
    def log_posterior(self) -> float:
        """Logarithm of its posterior probability, up to a constant that all models of the same logs share."""
        return self.log_prior + 0.5 * self.evidence

    def without_sensitivities(self) -> Model:
        """The model without the bulk of its fit."""
        return replace(self, fit=self.fit.without_sensitivities()) if self.fit else self


def best_of_each_set(models: Iterable[Model]) -> dict[Names, Model]:
    """Of models of one set of causes that were fitted from different starts, the one with the most evidence; of equals the first."""
    found = dict[Names, Model]()
    for m in models:
        if m.names not in found or m.evidence > found[m.names].evidence:
            found[m.names] = m
    return found


def better_fits(models: Iterable[Model], best: Model) -> list[Model]:
    """The sets of as many causes as ``best`` that are more probable by prior and fit, the most probable first."""
    alike = [m for m in best_of_each_set(models).values() if len(m.names) == len(best.names)]
    return sorted((m for m in alike if m.log_posterior > best.log_posterior), key=lambda m: -m.log_posterior)


@dataclass(frozen=True, slots=True)
class ModelPrior:
    """Prior mass of sets of causes: ``effects`` compete, each of ``targets`` axes or thruster by name (1 where it has none)."""

    effects: int
    targets: dict[str, int]

    @classmethod
    def of(cls, library: Iterable[Hypothesis]) -> ModelPrior:
        """The prior over a library of hypotheses."""
        names = {h.name: h.effect.name for h in library}
        targets = Counter(names.values())
        return cls(len(targets), dict(targets))

    def log_mass(self, causes: Sequence[Hypothesis]) -> float:
        """Logarithm of the prior mass of a set of causes."""
        if not causes:
            return log(PRIOR_HEALTHY)
        each = sum(log(self.effects) + log(self.targets[h.effect.name]) for h in causes)
        of_as_many = log(PRIOR_CAUSES * (1.0 - FURTHER_CAUSE)) + (len(causes) - 1) * log(FURTHER_CAUSE)
        return of_as_many + log(factorial(len(causes))) - each
