"""`rovval export`: a run for the tools that people have."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rovval.cli import logs, options, output

if TYPE_CHECKING:
    from rovval.core.data import SimResult


class To(StrEnum):
    """The formats, each a file of `rovval.export`."""

    bag = "bag"
    mcap = "mcap"
    tum = "tum"
    csv = "csv"
    parquet = "parquet"


def command(
    source: options.Source,
    to: Annotated[To, typer.Option("--to", help="bag: ROS 1. mcap: ROS 2, Foxglove, PlotJuggler. tum: evo. csv, parquet: tables.")],
    with_: Annotated[
        Path | None,
        typer.Option("--with", metavar="SIM", help="A .parquet of `rovval simulate` of the same run, to stand beside what was measured."),
    ] = None,
    profile: options.ProfileOption = None,
    timezone: options.TimezoneOption = None,
    start: options.FromOption = None,
    end: Annotated[
        str | None, typer.Option("--until", metavar="S|MARKER", help="Take the log to here, s since the run's start, or a marker (--to is the format).")
    ] = None,
    archive: options.ArchiveOption = Path("archive"),
    out: Annotated[Path | None, typer.Option("--out", metavar="FILE", help="Default: reports/RUN/RUN with the format's suffix.")] = None,
    json_: options.JsonFlag = False,
    quiet: options.QuietOption = False,
) -> None:
    """Write a log or run as a file that other tools read: ROS messages and trajectories in their axes (REP-103), tables in ours.

    \b
    Example:
      rovval export dive.csv --to mcap
      rovval simulate dive.csv --out sim.parquet
      rovval export dive.csv --to mcap --with sim.parquet
    """
    from rovval import export
    from rovval.storage.atomic import refuse_unwritable

    refuse_unwritable(out)
    run = logs.opened(source, logs.Reading(profile, archive, timezone, start, end), quiet)
    path = out or Path("reports") / run.id / f"{run.id}{export.suffix(to.value)}"
    files = export.write(run, to.value, path, _simulation(with_))
    if run.t0_ns is None and to not in (To.csv, To.parquet):
        output.say("the log does not know when it was: stamps begin at 1 s", quiet)
    if json_:
        output.result_json({"schema": "rovval.export/1", "run": run.id, "format": to.value, "files": [str(f) for f in files]})
    else:
        output.result("\n".join(str(f) for f in files))


def _simulation(path: Path | None) -> SimResult | None:
    if path is None:
        return None
    from rovval.simulation.file import load_simulation

    return load_simulation(path)
