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
    """The trend of every series of the catalogue's ``rows``."""
    followed: Sequence[Series] = all_series(rows)
    return [trend_of(series, prior_odds(len(followed))) for series in followed]


def prior_odds(series: int) -> float:
    """Those of a change in one of so many series: such that all of them together raise a false alarm with a probability of `FALSE_ALARMS` at most."""
    return FALSE_ALARMS / max(series, 1)


def trend_of(series: Series, odds: float) -> Trend:
    """A series with its changes, one of which has prior ``odds``."""
    return Trend(series, changes(series.time_s, series.level, series.least, odds))
