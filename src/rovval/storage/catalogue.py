"""The catalogue: one table of every run that a batch ever took through its steps, as hive-partitioned Parquet in the archive.

``ARCHIVE/catalogue/vehicle=V/year=Y/runs.parquet`` is what polars, DuckDB and pandas read at once. Each file appears whole.
"""

from __future__ import annotations

import io
from collections.abc import Iterable, Mapping, Sequence
from datetime import UTC, datetime
from itertools import islice
from pathlib import Path
from typing import Any
from urllib.parse import quote, unquote

import polars as pl

from rovval.core.channels import AXES
from rovval.core.errors import BadInput, UsageProblem
from rovval.storage import places
from rovval.storage.atomic import drafts

FOLDER = "catalogue"
TIME = pl.Datetime("us", "UTC")
PARAMETER = pl.Struct({"name": pl.String, "value": pl.Float64, "low": pl.Float64, "high": pl.Float64, "unit": pl.String})
CAUSE = pl.Struct(
    {
        "effect": pl.String,
        "kind": pl.String,
        "group": pl.List(pl.String),
        "probability": pl.Float64,
        "shrinkage": pl.Float64,
        "parameters": pl.List(PARAMETER),
    }
)
# What the columns mean stands in docs/catalogue.md.
COLUMNS: Mapping[str, Any] = {
    "pipeline": pl.String, "run": pl.String, "log": pl.String, "sha256": pl.String, "current": pl.Boolean,
    "date": TIME, "dated_by": pl.String, "duration_s": pl.Float64, "model": pl.String,
    **dict.fromkeys(AXES, pl.Float64),
    "verdict": pl.String, "cause": pl.String, "causes": pl.List(CAUSE), "findings": pl.List(pl.String), "stops": pl.List(pl.String),
    "rovval": pl.String, "code": pl.String, "method": pl.String, "evaluated": TIME, "report": pl.String, "diagnosis": pl.String,
    "vehicle": pl.String, "year": pl.Int32,
}  # fmt: skip
PARTITIONS = ("vehicle", "year")
CONTENT = ("pipeline", "sha256")  # a pipeline has one row of each content
AT_ONCE = 100  # rows that are made into columns, and compared with those that are there
OURS = ("current", "evaluated", "year")  # columns that the catalogue fills itself


def load(archive: Path, columns: Sequence[str] = tuple(COLUMNS)) -> pl.DataFrame:
    """The table, or some of its ``columns`` (date and log among them), by date; without rows where there is none. Raises `BadInput` for a file that
    is damaged."""
    files = sorted((places.place(archive) / FOLDER).glob("*/*/*.parquet"))
    return pl.concat([_empty().select(columns), *(_read(file, columns) for file in files)]).sort("date", "log")


def find(archive: Path, where: str = "", since: datetime | None = None) -> list[dict[str, Any]]:
    """The rows of runs that began at or after ``since`` (UTC where it names no zone) and for which ``where``, an expression of SQL over
    the columns, holds; by date.

    Raises:
        UsageProblem: ``where`` is no such expression.
        BadInput: a file of the catalogue is damaged.
    """
    table = load(archive)
    if since is not None:
        table = table.filter(pl.col("date") >= (since if since.tzinfo else since.replace(tzinfo=UTC)))
    if where:
        table = _selected(table, where)
    return table.to_dicts()


def update(archive: Path, rows: Iterable[Mapping[str, Any]], now: datetime) -> list[str]:
    """Put ``rows`` (by column, all but `OURS`) into the catalogue; hold its lock meanwhile. A row takes the place of one of the same pipeline
    and content; earlier contents of the same log stay and are no longer ``current``. ``evaluated`` stays where the method is the same too,
    else it is ``now``.

    Returns what had to be set aside: files of the catalogue that are damaged. Raises `UsageProblem` where it cannot be written.
    """
    old, damaged = _readable(archive)
    new = _new(rows, old, now)
    table = _merged(old, new) if len(new) else old
    parts, before = (t.partition_by(*PARTITIONS, as_dict=True) for t in (table, old))
    for key, part in parts.items():
        if key not in before or not part.equals(before[key]):
            _write(_place(archive, *key), part)
    for key in before.keys() - parts.keys():
        _place(archive, *key).unlink(missing_ok=True)
    return [f"{place}: damaged, set aside as {_aside(place).name}" for place in damaged]


def faults(archive: Path) -> dict[Path, str]:
    """The files of the catalogue that cannot be read, each with the reason."""
    found = {}
    for file in sorted((places.place(archive) / FOLDER).glob("*/*/*.parquet")):
        try:
            _read(file)
        except BadInput as error:
            found[file] = error.message.removeprefix(f"{file}: ")
    return found


def _new(rows: Iterable[Mapping[str, Any]], old: pl.DataFrame, now: datetime) -> pl.DataFrame:
    """``rows`` as they will stand in the table, without those that stand there so already: of most nights a few are left, and the memory does not grow
    with the others."""
    schema = {name: kind for name, kind in COLUMNS.items() if name not in OURS}
    same = ["pipeline", "sha256", "vehicle", "method"]
    known = old.select(*same, "evaluated").unique(same)
    there = old.hash_rows()
    left, new = iter(rows), [_empty()]
    for part in iter(lambda: list(islice(left, AT_ONCE)), []):
        given = pl.DataFrame(part, schema=schema).join(known, on=same, how="left").with_columns(pl.col("evaluated").fill_null(now))
        given = given.with_columns(current=pl.lit(True), year=pl.col("date").dt.year()).select(list(COLUMNS))
        new.append(given.filter(~given.hash_rows().is_in(there.implode())))
    return pl.concat(new)


def _merged(old: pl.DataFrame, new: pl.DataFrame) -> pl.DataFrame:
    """Old and new rows as one table, by date."""
    kept = old.join(new, on=CONTENT, how="anti")
    replaced = kept.join(new, on=["pipeline", "log"], how="semi").with_columns(current=pl.lit(False))
    untouched = kept.join(new, on=["pipeline", "log"], how="anti")
    return pl.concat([untouched, replaced, new]).sort("date", "log", "evaluated")


def _readable(archive: Path) -> tuple[pl.DataFrame, list[Path]]:
    """The rows of all files that can be read, and the places of those that cannot: what is in them is set aside, not overwritten."""
    tables, damaged = [_empty()], []
    for file in sorted((places.place(archive) / FOLDER).glob("*/*/*.parquet")):
        try:
            tables.append(_read(file))
        except BadInput:
            places.move(file, _aside(file))
            damaged.append(file)
    return pl.concat(tables), damaged


def _read(file: Path, columns: Sequence[str] = tuple(COLUMNS)) -> pl.DataFrame:
    vehicle, year = (part.name.partition("=")[2] for part in (file.parent.parent, file.parent))
    try:
        named = {"vehicle": unquote(vehicle), "year": int(year)}
        table = pl.scan_parquet(io.BytesIO(file.read_bytes()), hive_partitioning=False)
        whole = table.select(pl.lit(named[name], COLUMNS[name]).alias(name) if name in named else name for name in columns).collect()
        schema = pl.Schema({name: COLUMNS[name] for name in columns})
        return whole if whole.schema == schema else whole.cast(schema)
    except (OSError, ValueError, pl.exceptions.PolarsError) as error:
        raise BadInput(f"{file}: damaged: {str(error).splitlines()[0]}", "`rovval archive repair` sets it aside, and the next batch writes it anew") from None


def _aside(file: Path) -> Path:
    """Where a damaged file is kept, under a name that no reader of the folder takes up."""
    return file.with_name(f".{file.name}.damaged")


def _place(archive: Path, vehicle: str, year: int) -> Path:
    return places.place(archive).joinpath(FOLDER, f"vehicle={quote(vehicle, safe='')}", f"year={year}", "runs.parquet")


def _write(place: Path, rows: pl.DataFrame) -> None:
    rows.drop(PARTITIONS).write_parquet(table := io.BytesIO(), compression="zstd")
    with drafts(place) as [draft]:
        draft.write_bytes(table.getbuffer())  # not by polars, whose own error tells of a full disk as of a damaged file


def _empty() -> pl.DataFrame:
    return pl.DataFrame(schema=dict(COLUMNS))


def _selected(table: pl.DataFrame, where: str) -> pl.DataFrame:
    try:
        return pl.SQLContext(runs=table, eager=True).execute(f"SELECT * FROM runs WHERE ({where})")
    except pl.exceptions.PolarsError as error:
        said = str(error).splitlines()[0]
        raise UsageProblem(
            f"--where {where!r}: {said}", f"write SQL over the columns {', '.join(COLUMNS)}, such as \"vehicle = 'merlin' and surge > 0.1\""
        ) from None
