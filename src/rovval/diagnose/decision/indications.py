"""Indications: what points to a cause where none is named, an effect that came near and a fault of a sensor that kinematics show."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from rovval.diagnose.criteria import LEAST_EVIDENCE
from rovval.diagnose.decision.unexplained import Accounted
from rovval.diagnose.residuals.sensor_faults import FittedFault
from rovval.effects import sensor_tolerance

Lack = Literal["evidence", "reduction"]  # "evidence" in documents of before: what lacks it is no longer told


@dataclass(frozen=True, slots=True)
class NearestEffect:
    """The candidate that came nearest to a cause.

    Attributes:
        effect: its name.
        evidence: twice the log Bayes factor over the healthy vehicle.
        gain: reduction of the squared gap by it alone, on held-out windows.
        lacks: of what it has too little: ``reduction`` (no more than coefficients within their tolerances bring), or nothing: other models are likelier.
    """

    effect: str
    evidence: float
    gain: float
    lacks: tuple[Lack, ...]


@dataclass(frozen=True, slots=True)
class Indications:
    """What points to a cause where none is named.

    Attributes:
        nearest: the effect that came nearest; None where none came near.
        within_tolerance: reduction of the squared gap by coefficients within their tolerances; 0 where the fit takes one far beyond.
        fault: the significant fault that accounts for most of the parity residuals; None where there is none.
        fault_departure: its standardised departure, in standard deviations of a healthy sensor; 0 where no tolerance is stated.
    """

    nearest: NearestEffect | None
    within_tolerance: float
    fault: FittedFault | None
    fault_departure: float

    @property
    def beyond_tolerance(self) -> bool:
        """Whether one of them is beyond what tolerances allow: then no cause is named, but neither is it said that there is nothing."""
        return (self.nearest is not None and self.nearest.gain > self.within_tolerance) or self.fault_departure > 1.0


def indications(candidates: Sequence[tuple[str, float, float]], known: Accounted, faults: Sequence[FittedFault]) -> Indications:
    """What points to a cause though none is named.

    Args:
        candidates: (name, evidence, gain) of those that the first step of the search re-simulated.
        known: what of the gap needs no cause.
        faults: of sensors, each fitted to the parity residuals by itself.
    """
    within = known.share - known.noise
    best = max((c for c in candidates if c[1] > LEAST_EVIDENCE and c[2] > 0.0), key=lambda c: c[1], default=None)
    fault = max((f for f in faults if f.significant), key=lambda f: (round(f.share, 2), _departure(f)), default=None)
    return Indications(NearestEffect(*best, ("reduction",) if within >= best[2] else ()) if best else None, within, fault, _departure(fault) if fault else 0.0)


def _departure(fault: FittedFault) -> float:
    tolerance = sensor_tolerance(fault.fault.partition(".")[0].partition("[")[0])
    return abs(fault.value - fault.was) / tolerance if tolerance else 0.0
