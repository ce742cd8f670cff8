"""`rovval view`: a run beside its simulation in the rerun viewer."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rovval.cli import logs, options, output


def command(
    source: options.Source,
    vehicle: options.VehicleOption = None,
    model: options.ModelOption = options.Model.fossen,
    effect: options.EffectOption = None,
    profile: options.ProfileOption = None,
    timezone: options.TimezoneOption = None,
    start: options.FromOption = None,
    end: options.ToOption = None,
    archive: options.ArchiveOption = Path("archive"),
    out: Annotated[Path | None, typer.Option("--out", metavar="DIR", help="Report folder. Default: reports/RUN.")] = None,
    open_: Annotated[
        bool, typer.Option("--open/--no-open", help="Start the viewer; otherwise only write the recording.")
    ] = True,
    web: Annotated[bool, typer.Option("--web", help="Serve it to a browser, where there is no display; Ctrl-C ends it.")] = False,
    quiet: options.QuietOption = False,
) -> None:
    """Open a run and its simulation in the rerun viewer: velocities, errors, thrusters, both trajectories in 3-D, and camera and sonar pictures of a bag.

    \b
    Example:
      rovval view dive.csv --profile merlin
      rovval view dive.csv --no-open --out /tmp/view
      rovval view dive.csv --web
    """
    import subprocess
    import sys

    from rovval import report
    from rovval.comparison import compare
    from rovval.pipeline.steps import simulated, vehicle_of

    run = logs.opened(source, logs.Reading(profile, archive, timezone, start, end), quiet)
    nominal = vehicle_of(run, vehicle)
    comparison = compare(run, simulated(run, nominal, model.value, tuple(effect or ()), 10.0))
    files = report.write(comparison, out or Path("reports") / run.id, nominal, log=logs.with_pictures(source))
    output.result(str(files["run.rrd"]))
    if open_:
        output.say("serving the viewer to a browser; Ctrl-C ends it" if web else "opening the viewer; close it to return", quiet)
        how = ["--serve-web"] if web else []
        raise typer.Exit(subprocess.run([sys.executable, "-m", "rerun", *how, str(files["run.rrd"])], check=False).returncode and 70)
