"""Date and time as people and programs write them -> ns since 1970 UTC."""

from __future__ import annotations

import re

import numpy as np
import polars as pl

from rovval.core.data import Array
from rovval.core.errors import BadInput

MONTHS = {m: i for i, m in enumerate(("jan", "feb", "mar", "apr", "may", "jun", "jul", "aug", "sep", "oct", "nov", "dec"), 1)}
GERMAN = {"mrz": 3, "mär": 3, "mai": 5, "okt": 10, "dez": 12}
TIME = r"(?<h>\d{1,2})[:.](?<mi>\d{1,2})(?:[:.](?<s>\d{1,2})(?:[.,](?<f>\d+))?)?\s*(?<half>[AaPp]\.?[Mm]\.?)?"
ZONE = r"\s*(?<zone>[Zz]|UTC|GMT|[+-]\d{2}(?::?\d{2})?)?"
DATE = r"(?<a>\d{1,4}|\p{L}{3,9})\.?[-/. ]\s*(?<b>\d{1,2}|\p{L}{3,9})\.?[-/., ]\s*(?<c>\d{1,4})"
STAMP = rf"^\s*{DATE}(?:\s*[T,_ ]\s*|:){TIME}{ZONE}\s*$"
COMPACT = r"^(\d{4})(\d{2})(\d{2})[T_ ]?(\d{2})(\d{2})(\d{2})"  # ISO 8601 basic
WITHIN = 1_000  # stamps that are looked at to see how a date is written
ORDERS = {"ymd": "abc", "dmy": "cba", "mdy": "cab"}  # where year, month and day stand among a, b, c


def nanoseconds(stamps: pl.Series, order: str | None, timezone: str) -> pl.Series:
    """Stamps (n,) as ns since 1970 UTC (Int64, null where unreadable).

    ``order`` of year, month and day; None: only dates that say it themselves. ``timezone``, a name or offset, is that of stamps without their
    own; of the hour that a clock shows twice in autumn the first is taken. Raises `BadInput` where more than half cannot be read, or where the
    order has to be stated.
    """
    parts = stamps.str.replace(COMPACT, "$1-$2-$3 $4:$5:$6").str.extract_groups(STAMP).struct.unnest()
    known = parts.filter(pl.col("h").is_not_null())
    if len(known) <= 0.5 * len(stamps):
        shown = next((s for s, h in zip(stamps, parts["h"], strict=True) if h is None), "")
        raise BadInput(f"stamps such as {shown!r} are not readable as date and time", "use YYYY-MM-DD HH:MM:SS.fff, or state [time] date_order or another kind")
    order = order or _order(known.head(WITHIN), str(stamps.filter(parts["h"].is_not_null())[0]))
    year, month, day = (parts[c] for c in ORDERS[order])
    rest = parts.select(_rest()).to_series()
    table = pl.DataFrame({"y": _year(year), "m": _month(month), "d": day.str.zfill(2), "h": _hour(parts), "rest": rest, "zone": parts["zone"]})
    local = table.select(
        pl.format("{}-{}-{} {}:{}", "y", "m", "d", "h", "rest").str.to_datetime("%Y-%m-%d %H:%M:%S%.f", time_unit="ns", strict=False)
    ).to_series()
    own = _offset_s(table["zone"])
    if re.fullmatch(r"[+-]\d{2}:?\d{2}", timezone):
        utc = local.cast(pl.Int64) - _offset_s(pl.Series([timezone]))[0] * 10**9
    else:
        utc = local.dt.replace_time_zone(timezone, ambiguous="earliest", non_existent="null").dt.convert_time_zone("UTC").cast(pl.Int64)
    out = pl.select(pl.when(own.is_not_null()).then(local.cast(pl.Int64) - own * 10**9).otherwise(utc)).to_series()
    if out.null_count() > 0.5 * len(out):
        raise BadInput(f"stamps such as {stamps[0]!r} are no dates in the order {order}", "state [time] date_order: ymd, dmy or mdy")
    return out


def date_orders(stamps: pl.Series) -> tuple[str, ...]:
    """The orders of year, month and day that stamps may be written in: one where they say it themselves or where a day above 12 shows it."""
    parts = stamps.str.replace(COMPACT, "$1-$2-$3 $4:$5:$6").str.extract_groups(STAMP).struct.unnest()
    known = parts.drop_nulls("h")
    if not len(known):
        return ()
    try:
        return (_order(known, str(stamps.filter(parts["h"].is_not_null())[0])),)
    except BadInput:
        day_first, month_first = (bool((known[c].cast(pl.Int64, strict=False) > 12).any()) for c in "ab")
        return ("dmy",) if day_first else ("mdy",) if month_first else ("dmy", "mdy")


def seconds_of_day(stamps: pl.Series) -> Array:
    """``14:03:22.5`` or ``02:03:22 PM`` -> seconds since midnight (n,), NaN where unreadable."""
    parts = stamps.str.extract_groups(rf"^\s*{TIME}\s*$").struct.unnest()
    text = pl.DataFrame({"h": _hour(parts), "rest": parts.select(_rest()).to_series()})
    day = text.select(pl.format("1970-01-01 {}:{}", "h", "rest").str.to_datetime("%Y-%m-%d %H:%M:%S%.f", time_unit="ns", strict=False)).to_series()
    return np.array(day.cast(pl.Int64).cast(pl.Float64).fill_null(np.nan).to_numpy()) * 1e-9


def _order(known: pl.DataFrame, example: str) -> str:
    """How dates are written that say it themselves. Raises `BadInput` for those that do not."""
    if (known["a"].str.len_chars() == 4).all() and known["a"].str.contains(r"^\d+$").all():
        return "ymd"
    if known["a"].str.contains(r"\p{L}").all():
        return "mdy"
    if known["b"].str.contains(r"\p{L}").all() or "." in example.split(" ")[0].rstrip("."):
        return "dmy"
    raise BadInput(f"the date of {example!r} may have its day or its month first", 'state it in [time] of the profile: date_order = "dmy", "mdy" or "ymd"')


def _rest() -> pl.Expr:
    return pl.format("{}:{}.{}", pl.col("mi").str.zfill(2), pl.col("s").fill_null("0").str.zfill(2), pl.col("f").fill_null("0"))


def _year(text: pl.Series) -> pl.Series:
    """Four digits; two mean 1970 to 2069 (POSIX strptime has 1969 to 2068)."""
    year, digits = text.cast(pl.Int64, strict=False), text.str.len_chars()
    century = pl.when(year >= 70).then(1900).otherwise(2000)
    return pl.select(pl.when(digits == 4).then(year).when(digits == 2).then(year + century)).to_series()


def _month(text: pl.Series) -> pl.Series:
    names = text.str.to_lowercase().str.slice(0, 3).replace_strict(MONTHS | GERMAN, default=None, return_dtype=pl.Int64)
    return pl.select(pl.coalesce(text.cast(pl.Int64, strict=False), names)).to_series().cast(pl.String).str.zfill(2)


def _hour(parts: pl.DataFrame) -> pl.Series:
    """Hours of 24, of 12 where AM or PM is said; null for 13 PM."""
    hour, half = parts["h"].cast(pl.Int64, strict=False), parts["half"].str.to_lowercase().str.slice(0, 1)
    twelve = pl.when((hour >= 1) & (hour <= 12)).then(hour % 12 + 12 * (half == "p").cast(pl.Int64))
    return pl.select(pl.when(half.is_null()).then(hour).otherwise(twelve)).to_series().cast(pl.String).str.zfill(2)


def _offset_s(zone: pl.Series) -> pl.Series:
    """``+02:00`` -> 7200, ``Z`` -> 0, null where there is none."""
    signed = pl.select(pl.when(zone.str.starts_with("-")).then(-1).otherwise(1)).to_series()
    hours = zone.str.extract(r"[+-](\d{2})").cast(pl.Int64, strict=False)
    minutes = zone.str.extract(r"[+-]\d{2}:?(\d{2})").cast(pl.Int64, strict=False).fill_null(0)
    return pl.select(pl.when(zone.str.contains(r"[+-]")).then(signed * (hours * 3600 + minutes * 60)).when(zone.is_not_null()).then(0)).to_series()
