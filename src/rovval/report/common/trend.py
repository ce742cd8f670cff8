"""The trend over dives in words, as lines for a terminal and for programs (rovval.trend/1)."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime
from math import expm1
from statistics import median
from typing import Any

from rovval.report.common.numbers import estimate, quantity, share
from rovval.report.common.terminal import fitted
from rovval.trend import Trend
from rovval.trend.change_points import NORMAL_90, Change
from rovval.trend.recent import DIVES

WEEK_S = 7 * 86400.0


def text(trends: Sequence[Trend]) -> str:
    """A paragraph a vehicle, a line a series: the median of the last dives, and what has changed."""
    lines: list[str] = []
    vehicle = ("", "")
    for trend in trends:
        s = trend.series
        if vehicle != (vehicle := (s.pipeline, s.vehicle)):
            lines += [*([""] if lines else []), f"{s.vehicle} ({s.pipeline}): median of the last {DIVES} dives, and what has changed"]
            lines += [f"  left out: {note}" for note in left_out(trend)]
        lines.append(f"  {title(trend):<30} {quantity(now(trend), s.unit):>12}  {said(trend)}")
    return fitted("\n".join(lines))


def title(trend: Trend) -> str:
    """gap in surge, size of inflow_loss loss."""
    return f"{'gap in' if trend.series.of == 'gap' else 'size of'} {trend.series.name}"


def now(trend: Trend) -> float:
    """Median of the last dives."""
    return median(trend.series.values[-DIVES:])


def said(trend: Trend) -> str:
    """What has changed, in words."""
    first, last, n = trend.series.dates[0], trend.series.dates[-1], len(trend.series.dates)
    over = f"{n} dives from {_day(first)} to {_day(last)}" if n > 1 else f"one dive, {_day(first)}"
    return "; ".join(_change(trend, c) for c in trend.changes) if trend.changes else f"no change in {over}"


def left_out(trend: Trend) -> list[str]:
    """Which dives do not count, and which count by a date that is not their own."""
    s = trend.series
    notes = [(s.other_method, "judged by other code, vehicle file or options than the newest"), (s.stopped, "whose simulation left sane limits")]
    return [f"{count} dives {what}" for count, what in notes if count]


def document(trends: Sequence[Trend]) -> dict[str, Any]:
    """All series with their changes; times ISO 8601 in UTC, values in SI. Of a gap, size and rate are relative changes (0.03 is 3 %), of a cause in its
    unit; intervals are of 90 %; evidence is twice the log of the Bayes factor."""
    return {"schema": "rovval.trend/1", "series": [_series(trend) for trend in trends]}


def _series(trend: Trend) -> dict[str, Any]:
    s = trend.series
    facts = {name: getattr(s, name) for name in ("pipeline", "vehicle", "of", "name", "unit", "other_method", "stopped", "dated_by_file")}
    last = {"run": s.runs[-1], "date": s.dates[-1].isoformat(), "value": s.values[-1]}
    return facts | {"dives": len(s.runs), "first": s.dates[0].isoformat(), "last": last, "median_of_last": now(trend), "sentence": said(trend),
                    "changes": [_document(trend, c) for c in trend.changes]}  # fmt: skip


def _document(trend: Trend, change: Change) -> dict[str, Any]:
    dates = trend.series.dates
    size, rate = (_sized(trend, *x) for x in (change.size, _weekly(change)))
    return {
        "kind": change.kind, "probability_of_kind": change.sure_of_kind, "since": dates[change.place].isoformat(),
        "since_low": dates[change.places[0]].isoformat(), "since_high": dates[change.places[1]].isoformat(), "evidence": 2 * change.evidence,
        "size": dict(zip(("value", "low", "high"), size, strict=True)),
        "rate_per_week": dict(zip(("value", "low", "high"), rate, strict=True)) if change.kind == "ramp" else None,
    }  # fmt: skip


def _change(trend: Trend, change: Change) -> str:
    """rises by 3 % [2, 4] a week since 4 May 2026 [27 Apr 2026 to 11 May 2026]."""
    value, low, high = _sized(trend, *(change.size if change.kind == "step" else _weekly(change)))
    sign = 1.0 if value > 0 else -1.0
    bounds = sorted((sign * low, sign * high))
    by = share(abs(value), bounds[0], bounds[1]) if trend.series.of == "gap" else estimate(abs(value), bounds[0], bounds[1], trend.series.unit)
    verb = {("step", 1.0): "rose", ("step", -1.0): "fell", ("ramp", 1.0): "rises", ("ramp", -1.0): "falls"}[change.kind, sign]
    dates = trend.series.dates
    when = f"{_day(dates[change.place])} [{_day(dates[change.places[0]])} to {_day(dates[change.places[1]])}]"
    doubt = "" if change.sure_of_kind > 0.9 else f", {'at once' if change.kind == 'step' else 'gradually'} with probability {change.sure_of_kind:.2f}"
    return f"{verb} by {by} {'on' if change.kind == 'step' else 'a week since'} {when}{doubt}"


def _weekly(change: Change) -> tuple[float, float]:
    return change.rate[0] * WEEK_S, change.rate[1] * WEEK_S


def _sized(trend: Trend, mean: float, spread: float) -> tuple[float, float, float]:
    """A change of level with its interval, as the reader counts it: gaps by factors, less one."""
    counted = expm1 if trend.series.of == "gap" else float
    return counted(mean), counted(mean - NORMAL_90 * spread), counted(mean + NORMAL_90 * spread)


def _day(date: datetime) -> str:
    return f"{date.day} {date:%b %Y}"
