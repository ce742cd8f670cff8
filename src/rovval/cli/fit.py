"""`rovval fit`: calibrate a vehicle's file to logs, or tune chosen parameters of it, as the thesis does by hand in 6.5."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rovval.cli import logs, options, output
from rovval.core.errors import UsageProblem


def command(
    sources: options.Sources,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="VEHICLE.toml", help="Where the fitted vehicle is written; of a bench's table, the result as JSON.")
    ] = None,
    report: Annotated[
        Path | None, typer.Option("--report", metavar="DIR", help="Write the result as a page and as JSON into this folder, too (fit.html, fit.json).")
    ] = None,
    parameters: Annotated[
        list[str] | None,
        typer.Option(
            "--parameters", metavar="NAME[,NAME]",
            help="Tune these alone, such as quadratic_drag[surge]; repeatable. Default: all that a file may have wrong.",
        ),
    ] = None,
    motor: Annotated[
        bool, typer.Option("--motor", help="Fit equation 2.4 of the thesis to a bench's table of voltage and thrust (V, N) instead.")
    ] = False,
    response: Annotated[
        bool, typer.Option("--response", help="Fit a thruster's time constant to a bench's record of steps (s, any unit) instead.")
    ] = False,
    columns: Annotated[
        str, typer.Option("--columns", metavar="I,J", help="Columns of the bench's table, counted from 1.")
    ] = "1,2",
    vehicle: options.VehicleOption = None,
    model: options.ModelOption = options.Model.fossen,
    window: options.WindowOption = 10.0,
    profile: options.ProfileOption = None,
    timezone: options.TimezoneOption = None,
    start: options.FromOption = None,
    end: options.ToOption = None,
    archive: options.ArchiveOption = Path("archive"),
    json_: options.JsonFlag = False,
    quiet: options.QuietOption = False,
) -> None:
    """Calibrate a vehicle's file to one or more runs, or tune chosen parameters of it, and write the vehicle.

    Without --parameters all that a file may have wrong is estimated at once: thrust, place of thrusters, drag, added mass, inertia, trim, lag, and
    how sensors are mounted. What the logs do not show stays near the file. Several runs also predict one another. The page of --report has intervals,
    correlations, predicted runs, and what another manoeuvre would tell.

    \b
    Example:
      rovval fit dive1.csv dive2.csv --out mine.toml --report reports/mine
      rovval fit dive.csv --parameters quadratic_drag[surge] --out tuned.toml
      rovval fit bench.csv --motor --columns 1,2
      rovval fit step.csv --response --columns 2,21
    """
    if motor or response:
        if report is not None:
            raise UsageProblem("--report: a bench's table has no page", "leave it out; --out FILE.json has the result")
        from rovval.cli.bench import fitted

        fitted(sources, motor, response, columns, out, json_, quiet)
        return
    if out is None:
        raise UsageProblem("fit needs --out VEHICLE.toml", "name the file that the fitted vehicle is written to")
    from rovval.pipeline.steps import vehicle_of
    from rovval.report import write_fit
    from rovval.report.fit import text
    from rovval.storage.atomic import refuse_unwritable, write_text
    from rovval.vehicle.write import to_toml

    refuse_unwritable(out, report and report / "fit.html")
    options.refuse_overwriting(vehicle, out)
    runs = logs.opened_as_one(sources, vehicle, logs.Reading(profile, archive, timezone, start, end), quiet)
    wanted, nominal = [name for some in parameters or () for name in some.split(",") if name], vehicle_of(runs[0], vehicle)
    if parameters is None:
        from rovval.fit import FitResult
        from rovval.fit.calibration import calibrate

        found = calibrate(runs, nominal, model=model.value, window_s=window, progress=output.progress(quiet))
        tuned = FitResult(to_toml(found.vehicle), found.document())
    else:
        from rovval.fit import fit

        tuned = fit(runs, nominal, wanted, model=model.value, window_s=window)
    write_text(out, tuned.vehicle)
    files = {} if report is None else write_fit(tuned.document, report)
    if json_:
        output.result_json(tuned.document)
    else:
        output.result(text(tuned.document))
    output.say(f"written: {out}", quiet)
    if files:
        output.say(output.places(files), quiet)
