"""A stated tolerance: the limit of one number of a comparison, and whether a comparison keeps it."""

from __future__ import annotations

from dataclasses import dataclass

from rovval.comparison import metrics
from rovval.comparison.metrics import Metric
from rovval.core.data import ChannelError, Comparison

RMS = "rms"  # of restarted windows, as their documents name the rmse


@dataclass(frozen=True, slots=True)
class Tolerance:
    """One limit: where (free run or restarted windows), which axis, which number of the comparison, and its limit in SI."""

    windowed: bool
    axis: str
    metric: str
    limit: float

    def __str__(self) -> str:
        return f"{'window.' if self.windowed else ''}{self.axis}.{self.metric}"

    @property
    def of(self) -> Metric:
        """The metric that is limited."""
        return metrics.get("rmse" if self.metric == RMS else self.metric)

    @property
    def more_is_better(self) -> bool:
        """Whether the limit is the least that is allowed, and not the most."""
        return self.of.perfect > 0.0

    def keeps(self, value: float) -> bool:
        """Whether a value of the metric is within the limit."""
        return value >= self.limit if self.more_is_better else abs(value) <= self.limit

    def row(self, comparison: Comparison) -> ChannelError | None:
        """What it is about; None where that was not measured."""
        return (comparison.windowed if self.windowed else comparison.free).get(self.axis)

    def value(self, comparison: Comparison) -> float | None:
        """Its number; None where the axis was not measured, or the metric is not defined for it."""
        row = self.row(comparison)
        name = self.of.name
        return None if row is None else row.extra.get(name, getattr(row, name, None))
