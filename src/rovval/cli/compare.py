"""`rovval compare`: how far the simulator is from the vehicle, axis by axis."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rovval.cli import complete, logs, options, output
from rovval.core.errors import UsageProblem

if TYPE_CHECKING:
    from rovval.comparison.tolerance import Tolerance
    from rovval.core.data import Comparison
    from rovval.vehicle.model import Vehicle

Optional = Annotated[
    str | None,
    typer.Argument(
        metavar="[LOG|RUN]",
        help="A log file, a bag folder, or a run of the archive; with --between two platforms a mission, too.", autocompletion=complete.sources
    ),
]
Between = Annotated[
    tuple[str, str] | None,
    typer.Option(
        "--between",
        metavar="A B",
        help="Simulator against simulator, B minus A: two platforms, on the log or, without one, on the thesis's movement protocol; or two "
        ".parquet of `rovval simulate`, or two runs.",
    ),
]
With = Annotated[
    Path | None,
    typer.Option(
        "--with",
        metavar="SIM",
        help="Another simulation of the same run to stand beside ours: a .parquet of `rovval simulate`, "
        "or a file of velocities that a profile reads.",
    ),
]
WithProfile = Annotated[
    str | None,
    typer.Option("--with-profile", metavar="P", autocompletion=complete.profiles, help="How to read SIM, if it is a log file."),
]
Out = Annotated[Path | None, typer.Option("--out", metavar="DIR", help="Report folder. Default: reports/RUN.")]


def command(
    source: Optional = None,
    between: Between = None,
    with_: With = None,
    with_profile: WithProfile = None,
    vehicle: options.VehicleOption = None,
    model: options.ModelOption = options.Model.fossen,
    effect: options.EffectOption = None,
    window: options.WindowOption = 10.0,
    profile: options.ProfileOption = None,
    timezone: options.TimezoneOption = None,
    start: options.FromOption = None,
    end: options.ToOption = None,
    archive: options.ArchiveOption = Path("archive"),
    out: Out = None,
    fail_above: options.FailAbove = None,
    json_: options.JsonFlag = False,
    quiet: options.QuietOption = False,
) -> None:
    """Simulate a run and say how far the simulator is from the vehicle on each axis; write the report.

    Errors are simulated minus measured. The report is json, md, html and a rerun recording. With --json and without --out
    nothing is written. With --between neither is the vehicle: B minus A itself is printed, and a tie is called one. Exit 4 where
    the simulation left sane limits, 1 where a tolerance is exceeded.

    \b
    Example:
      rovval compare dive.csv --profile merlin
      rovval compare dive.csv --fail-above surge=0.1 --fail-above yaw.iae=5 --json
      rovval compare dive.csv --from 12 --to 95
      rovval compare run.csv --with sim.csv --with-profile bluerov2_tank_sim
      rovval compare dive.csv --between fossen uuv
      rovval compare --between fossen uuv --vehicle bluerov2_heavy
    """
    how = logs.Reading(profile, archive, timezone, start, end)
    if between is not None:
        from rovval.cli.between import difference

        difference(between, source, vehicle, tuple(effect or ()), how, out, json_, quiet)
        return
    if source is None:
        raise UsageProblem("compare needs a log or run", "give one, or --between A B")
    from rovval.comparison import compare
    from rovval.pipeline import tolerances
    from rovval.pipeline.steps import other_velocities, simulated, vehicle_of

    show = output.progress(quiet)
    limits = tolerances.parse(fail_above or ())
    show("read", 0.0)
    run = logs.opened(source, how, quiet)
    nominal = vehicle_of(run, vehicle)
    run = logs.checked_against(run, nominal, quiet)
    other = None if with_ is None else other_velocities(with_, run, with_profile, archive, timezone)
    show("simulate", 0.3)
    sim = simulated(run, nominal, model.value, tuple(effect or ()), window)
    comparison = compare(run, sim, other, with_.name if with_ else "")
    show("report", 0.7)
    folder = Path("reports") / run.id if out is None and not json_ else out
    document = _report(comparison, nominal, folder, json_, limits)
    show("report", 1.0)
    if beyond := tolerances.exceeded(limits, document):
        output.say("\n".join(output.styled(f"rovval: tolerance exceeded: {line}", err=True, fg="red") for line in beyond))
    logs.refuse_stopped(sim)
    if beyond:
        raise typer.Exit(1)


def _report(comparison: Comparison, vehicle: Vehicle, folder: Path | None, as_json: bool, limits: Sequence[Tolerance]) -> dict[str, Any]:
    """The report into its folder, if it has one, and the result on stdout; what `--json` prints."""
    from rovval import report
    from rovval.report.comparison.json import document as comparison_json
    from rovval.report.comparison.terminal import text

    document = comparison_json(comparison)
    files: Mapping[str, Path] = {}
    if folder is not None:
        links = {"Diagnosis": "diagnosis/diagnosis.html"} if (folder / "diagnosis" / "diagnosis.html").is_file() else {}
        files = report.write(comparison, folder, vehicle, limits=limits, links=links)
    if as_json:
        output.result_json(document)
    else:
        output.result(text(comparison))
        output.result("\nWritten:\n" + output.places(files))
    return document
