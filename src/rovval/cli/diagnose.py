"""`rovval diagnose`: which unmodelled effect causes the gap, where, and how far the gap shrinks with it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rovval.cli import logs, options, output

if TYPE_CHECKING:
    from rovval.core.data import Run
    from rovval.diagnose import Diagnosis
    from rovval.vehicle.model import Vehicle

JsonFile = Annotated[
    Path | None,
    typer.Option(
        "--json", metavar="FILE", help="Write the diagnosis as JSON; - is stdout, and then nothing else is printed there."
    ),
]
Out = Annotated[
    Path | None, typer.Option("--out", metavar="DIR", help="Report folder. Default: reports/RUN/diagnosis; none with --json.")
]
Slop = Annotated[
    float,
    typer.Option(
        "--calibration-slop", min=0.0, max=0.5, help="How far off a healthy simulator's coefficients may be (0.05 is 5 %)."
    ),
]
Seed = Annotated[int, typer.Option("--seed", help="Seed of the bootstrap.")]
WriteVehicle = Annotated[
    Path | None,
    typer.Option("--write-vehicle", metavar="FILE.toml", help="Write the vehicle with the causes added as effects."),
]


def command(
    sources: options.Sources,
    json_: JsonFile = None,
    out: Out = None,
    vehicle: options.VehicleOption = None,
    model: options.ModelOption = options.Model.fossen,
    window: options.WindowOption = 10.0,
    calibration_slop: Slop = 0.05,
    seed: Seed = 0,
    write_vehicle: WriteVehicle = None,
    profile: options.ProfileOption = None,
    timezone: options.TimezoneOption = None,
    start: options.FromOption = None,
    end: options.ToOption = None,
    archive: options.ArchiveOption = Path("archive"),
    pictures: options.PicturesOption = False,
    quiet: options.QuietOption = False,
) -> None:
    """Say where the gap lies, which effect of the library causes it, and how far it shrinks with it on held-out data.

    Several runs of one vehicle are taken together. Every number is about this simulator, these logs and this library.

    \b
    Example:
      rovval diagnose dive.csv --json diagnosis.json
      rovval diagnose dive1.csv dive2.csv --write-vehicle mended.toml
    """
    from rovval.diagnose import diagnose
    from rovval.pipeline.steps import vehicle_of
    from rovval.report.diagnosis import json as diagnosis_json
    from rovval.report.diagnosis.command import Typed
    from rovval.storage.atomic import refuse_unwritable

    anywhere = _folder(out, json_, "")
    refuse_unwritable(None if str(json_) == "-" else json_, write_vehicle, anywhere and anywhere / "diagnosis.json")
    options.refuse_overwriting(vehicle, write_vehicle)
    how = logs.Reading(profile, archive, timezone, start, end)
    runs = logs.opened_as_one(sources, vehicle, how, quiet)
    nominal = vehicle_of(runs[0], vehicle)
    runs = [logs.checked_against(run, nominal, quiet) for run in runs]
    found = diagnose(
        runs, nominal, model=model.value, window_s=window, calibration_slop=calibration_slop, seed=seed,
        progress=output.progress(quiet),
    )  # fmt: skip
    typed = Typed(dict(zip((run.id for run in runs), sources, strict=True)), vehicle or "", _unusual(window, how))
    found = diagnosis_json.worded(found, typed)
    for line in found.runs_left_out:
        output.say(f"left out: {line}", quiet)
    _print(found, json_, quiet)
    log = logs.with_pictures(sources[0]) if pictures else None
    _write(found, runs[0], nominal, _folder(out, json_, runs[0].id), write_vehicle, quiet, log)


def _folder(out: Path | None, json_: Path | None, run: str) -> Path | None:
    """Where the report goes: where it was asked for, else into the run's own folder; nowhere where only JSON was asked for."""
    return out if out or json_ else Path("reports") / run / "diagnosis"


def _unusual(window: float, how: logs.Reading) -> tuple[str, ...]:
    """The options that other commands on these logs need, too: those that were not left as they are."""
    given = {
        "--window": "" if window == 10.0 else f"{window:g}",
        "--profile": how.profile,
        "--timezone": how.timezone,
        "--archive": "" if str(how.archive) == "archive" else str(how.archive),
        "--from": how.start,
        "--to": how.end,
    }
    return tuple(word for flag, value in given.items() if value for word in (flag, value))


def _print(found: Diagnosis, json_: Path | None, quiet: bool) -> None:
    """The diagnosis on stdout as text, or as JSON where that was asked for; JSON into its file."""
    from rovval.report.diagnosis.terminal import text as diagnosis_text
    from rovval.storage.atomic import write_json

    if str(json_) == "-":
        output.result_json(found.document())
        return
    output.result_in_sections(diagnosis_text(found))
    if json_ is not None:
        write_json(json_, found.document())
        output.say(f"written: {json_}", quiet)


def _write(found: Diagnosis, run: Run, nominal: Vehicle, folder: Path | None, mended: Path | None, quiet: bool, log: Path | None) -> None:
    """The report with the recording of the first run, and the mended vehicle, each where it was asked for."""
    from rovval.storage.atomic import write_text

    if folder is not None:
        _report(found, run, nominal, folder, log)
        output.say(f"written: {folder}", quiet)
    if mended is not None and not found.vehicle_fixed:
        output.say(f"{mended} not written: no cause was found that could be added to the vehicle")
    elif mended is not None:
        write_text(mended, found.vehicle_fixed)
        output.say(f"written: {mended}", quiet)


def _report(found: Diagnosis, run: Run, nominal: Vehicle, folder: Path, log: Path | None) -> None:
    """The report; where the whole run cannot be simulated as a recording needs it, without one, and that is said: the diagnosis is not lost for it."""
    from rovval import report
    from rovval.core.errors import BadInput, SimulationStopped
    from rovval.pipeline.steps import before_and_after

    links = {"Comparison": "../report.html"} if (folder.parent / "report.html").is_file() else {}
    try:
        before, after = before_and_after(found, run, nominal)
        report.write_diagnosis(found, folder, before, nominal, after, links, log)
    except (BadInput, SimulationStopped) as error:
        output.say(f"no recording: {error.message}")
        report.write_diagnosis(found, folder, links=links)
