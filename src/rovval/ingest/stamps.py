"""The time columns of a table -> seconds, and the epoch that they count from where the log knows it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl

from rovval.core.data import Array
from rovval.core.errors import BadInput
from rovval.core.units import to_si
from rovval.ingest.clock import time_of_day
from rovval.ingest.profile import Profile


def stamps(path: Path, profile: Profile, text: pl.DataFrame, values: dict[str, Array]) -> tuple[Array, int | None]:
    """Stamps as logged (s, NaN where unreadable) and the epoch in ns that they count from, where the log knows it."""
    columns = [f"time.{c}" for c in profile.time.columns]
    if profile.time.kind == "time_of_day":
        return time_of_day([values[c] for c in columns]), None
    if profile.time.kind == "elapsed":
        return values[columns[0]] * to_si(profile.time.unit), None
    if profile.time.kind == "epoch":
        return _since_first(text[columns[0]], values[columns[0]], to_si(profile.time.unit))
    if profile.time.kind == "datetime":
        return _datetimes(path, text, columns)
    raise BadInput(f"{path}: profile {profile.name!r} wants the stamps of a bag ({profile.time.kind}), this is a table", "give --profile")


def _since_first(text: pl.Series, values: Array, unit: float) -> tuple[Array, int | None]:
    """Epoch stamps since the first one: whole numbers are subtracted as such, since a float cannot hold ns since 1970."""
    whole = text.cast(pl.Int64, strict=False)
    first = whole.drop_nulls()
    if len(first) and whole.null_count() == int(np.isnan(values).sum()):
        start = int(first[0])
        return np.array((whole - start).cast(pl.Float64).fill_null(np.nan).to_numpy()) * unit, round(start * unit * 1e9) if unit != 1e-9 else start
    known = values[np.isfinite(values)]
    start_s = float(known[0]) * unit if len(known) else 0.0
    return values * unit - start_s, round(start_s * 1e9)


def _datetimes(path: Path, text: pl.DataFrame, columns: list[str]) -> tuple[Array, int | None]:
    """Stamps written as text, ISO 8601 or near it; two columns are date and time of day."""
    joined = text.select(pl.concat_str(columns, separator=" ")).to_series().str.replace(r"Z$|[+-]00:?00$", "").str.replace("T", " ", literal=True)
    for shape in ("%Y-%m-%d %H:%M:%S%.f", "%Y/%m/%d %H:%M:%S%.f", "%d.%m.%Y %H:%M:%S%.f"):
        ns = joined.str.to_datetime(shape, time_unit="ns", strict=False).cast(pl.Int64)
        if ns.null_count() <= 0.5 * len(ns):
            start = int(ns.drop_nulls()[0])
            return np.array((ns - start).cast(pl.Float64).fill_null(np.nan).to_numpy()) * 1e-9, start
    raise BadInput(f"{path}: stamps such as {joined[0]!r} are not readable as date and time", "use YYYY-MM-DD HH:MM:SS.fff in UTC")
