"""Which columns of a table may be its stamps, and what they then say: every reading of them, best first, each with its reason."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import polars as pl

from rovval.core.errors import BadInput
from rovval.core.units import SI, TIME_UNITS
from rovval.ingest.clocks.clock import time_of_day
from rovval.ingest.clocks.stamps import BEFORE_1970_S
from rovval.ingest.clocks.wall_clock import date_orders, nanoseconds, seconds_of_day
from rovval.ingest.inspection.summary import FieldSummary, Rhythm, TopicSummary, rhythm
from rovval.ingest.table.text_table import plain_name, stated_unit
from rovval.ingest.table.unit_names import unit_of

NAMES = ("t", "time", "timestamp", "stamp", "zeit", "zeitstempel", "elapsed", "elapsedtime", "seconds", "secs", "sec", "datetime", "datum", "date", "uhrzeit")
PARTS = (("hour", "hours", "h", "hh", "stunde"), ("minute", "minutes", "min", "mm"), ("second", "seconds", "sec", "ss", "s", "sekunde"),
         ("millisecond", "milliseconds", "ms", "msec", "millisekunde"))  # fmt: skip
YEARS = (2000.0, 2100.0)  # a stamp of the calendar lies between these
SLOWEST_HZ, FASTEST_HZ = 0.1, 20_000.0  # rates that a log of a vehicle has: of the units of time, those are tried that give one
SUFFIXES = {"_s": "s", "_sec": "s", "_ms": "ms", "_us": "us", "_ns": "ns", "_min": "min"}


@dataclass(frozen=True, slots=True)
class Stamps:
    """One reading of columns as stamps, in the words of `[time]` of a profile; ``why`` it is thought so, ``sure`` if the log itself says it."""

    kind: str
    columns: tuple[str, ...]
    rhythm: Rhythm
    why: str
    sure: bool
    unit: str = "s"
    since: str = "unix"
    date_order: str | None = None


def readings(table: TopicSummary) -> list[Stamps]:
    """Every reading of the table's columns as stamps, best first; [] where none rises with the rows."""
    found = [*_parts(table.fields), *(s for f in table.fields.values() for s in (_of_text(f, table.fields) if f.texts else _of_number(f)))]
    return sorted(found, key=lambda s: (s.rhythm.backwards > 0.01 * table.rows, not s.sure, plain_name(s.columns[0]) not in NAMES))


def _parts(fields: Mapping[str, FieldSummary]) -> list[Stamps]:
    """Hour, minute, second and perhaps millisecond in columns of their own."""
    by = [next((a for a, f in fields.items() if plain_name(a) in names and f.low is not None), None) for names in PARTS]
    columns = [c for c in by if c is not None]
    if any(c is None for c in by[:3]) or any(fields[c].values is None for c in columns):
        return []
    values = [v for c in columns if (v := fields[c].values) is not None]
    r = rhythm(time_of_day(values))
    return [Stamps("time_of_day", tuple(columns), r, "hour, minute and second are columns of their own", True)] if r else []


def _of_text(field: FieldSummary, fields: Mapping[str, FieldSummary]) -> list[Stamps]:
    texts = pl.Series(field.texts)
    if field.present and np.isfinite(day := seconds_of_day(texts)).mean() > 0.5:
        dates = [a for a, f in fields.items() if a != field.address and f.texts and date_orders(pl.Series([f"{x} 00:00:00" for x in f.texts[:1000]]))]
        if not dates:
            r = rhythm(np.unwrap(day[np.isfinite(day)], period=86400.0))
            return [Stamps("time_of_day", (field.address,), r, "a time of day as text", True)] if r else []
        joined = pl.Series([f"{d} {x}" for d, x in zip(fields[dates[0]].texts, field.texts, strict=True)])
        return _dated(joined, (dates[0], field.address))
    return _dated(texts, (field.address,))


def _dated(texts: pl.Series, columns: tuple[str, ...]) -> list[Stamps]:
    orders = date_orders(texts)
    return [s for order in orders if (s := _in_order(texts, columns, order, len(orders) == 1)) is not None]


def _in_order(texts: pl.Series, columns: tuple[str, ...], order: str, sure: bool) -> Stamps | None:
    """Stamps read in one order of year, month and day; None where most are no dates in it."""
    try:
        ns = nanoseconds(texts, order, "UTC")
    except BadInput:
        return None
    try:
        nanoseconds(texts, None, "UTC")
        stated, how = None, "date and time as text"
    except BadInput:
        shown = "a day above 12 shows it" if sure else "nothing in the log shows whether"
        stated, how = order, f"date and time as text, read {order}: {shown}"
    r = rhythm(np.array(ns.cast(pl.Float64).fill_null(np.nan).to_numpy()) * 1e-9)
    return Stamps("datetime", columns, r, how, sure, date_order=stated) if r else None


def _of_number(field: FieldSummary) -> list[Stamps]:
    """A column that rises with the rows: of the calendar where its size says so in some unit, else since a start."""
    if field.values is None or field.low is None or field.high is None or field.constant:
        return []
    known = field.values[np.isfinite(field.values)]
    if len(known) < 3 or (np.diff(known) < 0).mean() > 0.01:
        return []
    for since, before in BEFORE_1970_S.items():
        for unit in ("day",) if since in ("excel", "matlab") else ("s", "ms", "us", "ns"):
            year = 1970.0 + (field.low * SI[unit] - before) / (365.25 * 86400.0)
            if YEARS[0] < year < YEARS[1] and (r := rhythm(known * SI[unit] - before)) and _likely(r):
                why = f"its first value is in {int(year)} if it counts {unit} since the epoch of {since}"
                return [Stamps("epoch", (field.address,), r, why, since == "unix", unit, since)]
    if plain_name(field.address) not in NAMES and _stated(field) is None:
        return []
    stated = _stated(field)
    units = [stated] if stated else [u for u in ("s", "ms", "us", "ns") if (r := rhythm(known * SI[u])) and _likely(r)]
    why = "rises with the rows; its name says the unit" if stated else "rises with the rows; the unit is one that gives a likely rate"
    return [Stamps("elapsed", (field.address,), r, why, bool(stated), u) for u in units if (r := rhythm(known * SI[u]))]


def _likely(r: Rhythm) -> bool:
    return SLOWEST_HZ <= r.rate_hz <= FASTEST_HZ


def _stated(field: FieldSummary) -> str | None:
    """The unit of time that the column's name or the log says."""
    said = field.unit or stated_unit(field.address) or ""
    unit = unit_of(said)
    if unit in TIME_UNITS:
        return unit
    return next((u for suffix, u in SUFFIXES.items() if field.address.casefold().endswith(suffix)), None)
