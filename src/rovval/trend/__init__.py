"""Trend over dives: what of each vehicle's gap and causes has changed since when, beside what dives differ by anyway."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from rovval.trend.change_points import Change, changes
from rovval.trend.series import Row, Series, all_series

FALSE_ALARMS = 0.01  # of a hundred fleets in which nothing changes one shows a change


@dataclass(frozen=True, slots=True)
class Trend:
    """A series with what has changed in it."""

    series: Series
    changes: tuple[Change, ...]


def trends(rows: Iterable[Row]) -> list[Trend]:
    """The trend of every series of the catalogue's ``rows``; the prior odds of a change are such that all series together raise a false alarm
    with a probability of `FALSE_ALARMS` at most."""
    followed: Sequence[Series] = all_series(rows)
    odds = FALSE_ALARMS / max(len(followed), 1)
    return [Trend(series, changes(series.time_s, series.level, series.least, odds)) for series in followed]
