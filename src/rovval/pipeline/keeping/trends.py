"""The trends that the page of a batch shows: computed anew only for the vehicles that have dived."""

from __future__ import annotations

import hashlib
import json
from contextlib import suppress
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from rovval.core.errors import BadInput, Unwritable
from rovval.pipeline.keeping.catalogue import rows_of
from rovval.pipeline.planning.config import Pipeline
from rovval.storage.atomic import read_json, write_json

if TYPE_CHECKING:
    from rovval.trend import Trend
    from rovval.trend.series import Series

KNOWN = ".trends.json"  # among the reports: changes that were found, by the digest of what they were found in


def trends(pipeline: Pipeline) -> list[Trend]:
    """The trend of every series of this pipeline's runs, as `rovval.trend.trends` has it."""
    from rovval.trend import Trend, prior_odds, trend_of
    from rovval.trend.change_points import Change
    from rovval.trend.series import all_series

    place = pipeline.reports / KNOWN
    known, found, kept = read_json(place) or {}, [], {}
    try:
        followed = all_series(rows_of(pipeline))
    except BadInput:  # damaged, and the disk so full that it could not be set aside: what stopped the batch says so
        return []
    odds = prior_odds(len(followed))
    for series in followed:
        key = _digest(series, odds)
        try:
            trend = Trend(series, tuple(Change(**_tuples(change)) for change in known[key]))
        except (KeyError, TypeError, AttributeError):  # not known, or by another rovval
            trend = trend_of(series, odds)
        found.append(trend)
        kept[key] = [asdict(change) for change in trend.changes]
    if json.loads(json.dumps(kept)) != known:
        with suppress(Unwritable):  # it only saves computing
            write_json(place, kept)
    return found


def _tuples(document: dict[str, Any]) -> dict[str, Any]:
    """JSON has lists for them."""
    return {name: tuple(value) if isinstance(value, list) else value for name, value in document.items()}


def _digest(series: Series, odds: float) -> str:
    parts: tuple[Any, ...] = (series.of, series.values, [date.isoformat() for date in series.dates], series.least, odds)
    return hashlib.sha256(repr(parts).encode()).hexdigest()
