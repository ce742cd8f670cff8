"""The thesis's test scenarios (4.2 to 4.6): each simulates, measures, and says whether its table's expectation holds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True, slots=True)
class Check:
    """One expectation: what is expected, what was seen, and whether it holds (None: reported, not judged)."""

    expected: str
    seen: str
    holds: bool | None


@dataclass(frozen=True, slots=True)
class Outcome:
    """A scenario's result. ``document`` has every number with its unit in its key."""

    number: int
    title: str
    vehicle: str
    model: str
    checks: Sequence[Check]
    text: str = ""
    document: Mapping[str, Any] = field(default_factory=dict)

    @property
    def passed(self) -> bool:
        """Whether nothing that is judged fails."""
        return all(check.holds is not False for check in self.checks)
