"""`rovval compare`: how far the simulator is from the vehicle, axis by axis."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rovval.cli import complete, options, output


def command(
    source: options.Source,
    with_: Annotated[
        Path | None,
        typer.Option(
            "--with",
            metavar="SIM",
            help="Another simulation of the same run to stand beside ours: a .parquet of `rovval simulate`, "
            "or a file of velocities that a profile reads.",
        ),
    ] = None,
    with_profile: Annotated[
        str | None,
        typer.Option(
            "--with-profile", metavar="P", autocompletion=complete.profiles, help="How to read SIM, if it is a log file."
        ),
    ] = None,
    vehicle: options.VehicleOption = None,
    model: options.ModelOption = options.Model.fossen,
    effect: options.EffectOption = None,
    window: options.WindowOption = 10.0,
    profile: options.ProfileOption = None,
    archive: options.ArchiveOption = Path("archive"),
    out: Annotated[Path | None, typer.Option("--out", metavar="DIR", help="Report folder. Default: reports/RUN.")] = None,
    fail_above: options.FailAbove = None,
    json_: options.JsonFlag = False,
    quiet: options.QuietOption = False,
) -> None:
    """Simulate a run and say how far the simulator is from the vehicle on each axis; write the report.

    Errors are simulated minus measured. The report is json, md, html and a rerun recording. With --json and without --out
    nothing is written.

    \b
    Example:
      rovval compare dive.csv --profile merlin
      rovval compare dive.csv --fail-above surge=0.10 --fail-above yaw.iae=5 --json
      rovval compare run_a.csv --with run_a.sim.csv --with-profile bluerov2_tank_sim
    """
    from rovval import report, store
    from rovval.compare import compare
    from rovval.pipeline import tolerances
    from rovval.pipeline.steps import other_velocities, simulated, vehicle_of
    from rovval.report.json import document as comparison_json
    from rovval.report.table import text

    show = output.progress(quiet)
    limits = tolerances.parse(fail_above or ())
    show("read", 0.0)
    run = store.open_run(source, profile, archive)
    nominal = vehicle_of(run, vehicle)
    other = None if with_ is None else other_velocities(with_, run, with_profile, archive)
    show("simulate", 0.3)
    sim = simulated(run, nominal, model.value, tuple(effect or ()), window)
    comparison = compare(run, sim, other, with_.name if with_ else "")
    document = comparison_json(comparison)
    show("report", 0.7)
    files = {} if json_ and out is None else report.write(comparison, out or Path("reports") / run.id, nominal)
    show("report", 1.0)
    if json_:
        output.result_json(document)
    else:
        output.result(text(comparison))
        output.result("\nWritten:\n" + output.places(files))
    if beyond := tolerances.exceeded(limits, document):
        output.say("\n".join(f"rovval: tolerance exceeded: {line}" for line in beyond))
        raise typer.Exit(1)
