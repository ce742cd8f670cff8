"""The time columns of a table -> seconds, and the epoch that they count from where the log knows it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl

from rovval.core.data import Array
from rovval.core.errors import BadInput
from rovval.core.units import to_si
from rovval.ingest.clocks.clock import over_midnight, time_of_day
from rovval.ingest.clocks.wall_clock import nanoseconds, seconds_of_day
from rovval.ingest.profile import Clock, Profile

# Seconds from the start of 1970 back to what an epoch counts from: Excel's day 0 is 1899-12-30, LabVIEW's second 0 is 1904-01-01, Matlab's datenum of
# 1970-01-01 is 719529 (their documentations).
BEFORE_1970_S = {"unix": 0, "excel": 25569 * 86400, "labview": 24107 * 86400, "matlab": 719529 * 86400}


def stamps(path: Path, profile: Profile, text: pl.DataFrame, values: dict[str, Array]) -> tuple[Array, int | None]:
    """Stamps as logged (s, NaN where unreadable) and the epoch in ns UTC that they count from, where the log knows it.

    ``text`` and ``values`` hold the columns ``time.NAME`` of the profile; those of `written` stamps are needed as text only.
    """
    clock = profile.time
    columns = [f"time.{c}" for c in clock.columns]
    if clock.kind == "time_of_day":
        return over_midnight(seconds_of_day(text[columns[0]])) if len(columns) == 1 else time_of_day([values[c] for c in columns]), None
    if clock.kind == "elapsed":
        return values[columns[0]] * to_si(clock.unit), None
    if clock.kind == "epoch":
        return _since_first(text[columns[0]], values[columns[0]], clock)
    if clock.kind == "datetime":
        return _datetimes(path, text, columns, clock)
    raise BadInput(f"{path}: profile {profile.name!r} wants the stamps of a bag ({clock.kind}), this is a table", "give --profile")


def written(clock: Clock) -> bool:
    """Whether the stamps are text that is no number: a date and time, or a time of day in one column."""
    return clock.kind == "datetime" or (clock.kind == "time_of_day" and len(clock.columns) == 1)


def _since_first(text: pl.Series, values: Array, clock: Clock) -> tuple[Array, int | None]:
    """Epoch stamps since the first one: whole numbers are subtracted as such, since a float cannot hold ns since 1970."""
    unit, before = to_si(clock.unit), BEFORE_1970_S[clock.since]
    whole = text.cast(pl.Int64, strict=False)
    first = whole.drop_nulls()
    if len(first) and whole.null_count() == int(np.isnan(values).sum()):
        start = int(first[0])
        t = np.array((whole - start).cast(pl.Float64).fill_null(np.nan).to_numpy()) * unit
        return t, _utc(round(start * unit * 1e9) if unit != 1e-9 else start, before, clock)
    known = values[np.isfinite(values)]
    first_value = float(known[0]) if len(known) else 0.0
    return (values - first_value) * unit if before else values * unit - first_value * unit, _utc(round(first_value * unit * 1e9), before, clock)


def _utc(ns: int, before_s: int, clock: Clock) -> int:
    """An epoch's first stamp in ns UTC; of one that counts a wall clock, by its zone."""
    ns -= before_s * 10**9
    if clock.timezone is None or not before_s:
        return ns
    wall = pl.Series([ns]).cast(pl.Datetime("ns")).dt.strftime("%Y-%m-%d %H:%M:%S%.9f")
    return int(nanoseconds(wall, "ymd", clock.timezone)[0])


def _datetimes(path: Path, text: pl.DataFrame, columns: list[str], clock: Clock) -> tuple[Array, int | None]:
    """Stamps written as text; two columns are date and time of day, six are year to second."""
    separators = ["-", "-", " ", ":", ":"] if len(columns) == 6 else [" "] * (len(columns) - 1)
    joined = text.select(pl.concat_str([part for c, s in zip(columns, [*separators, ""], strict=True) for part in (pl.col(c), pl.lit(s))])).to_series()
    try:
        ns = nanoseconds(joined, clock.date_order or ("ymd" if len(columns) == 6 else None), clock.timezone or "UTC")
    except BadInput as error:
        raise BadInput(f"{path}: {error.message}", error.hint) from None
    start = int(ns.drop_nulls()[0])
    return np.array((ns - start).cast(pl.Float64).fill_null(np.nan).to_numpy()) * 1e-9, start
