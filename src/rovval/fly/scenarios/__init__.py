"""The thesis's test scenarios (4.2 to 4.6): each simulates, measures, and says whether its table's expectation holds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from rovval.core.data import Comparison, Run, SimResult


@dataclass(frozen=True, slots=True)
class Check:
    """One expectation: what is expected, what was seen, and whether it holds (None: reported, not judged)."""

    expected: str
    seen: str
    holds: bool | None


@dataclass(frozen=True, slots=True)
class Outcome:
    """A scenario's result. ``document`` has every number with its unit in its key; ``comparison`` is what was compared,
    ``motion`` the motion and ``run`` the log that the scenario's pictures show, where there is any; ``closed`` its motion in closed loop."""

    number: int
    title: str
    vehicle: str
    model: str
    checks: Sequence[Check]
    document: Mapping[str, Any] = field(default_factory=dict)
    comparison: Comparison | None = None
    motion: SimResult | None = None
    run: Run | None = None
    closed: SimResult | None = None

    @property
    def passed(self) -> bool:
        """Whether nothing that is judged fails."""
        return all(check.holds is not False for check in self.checks)
