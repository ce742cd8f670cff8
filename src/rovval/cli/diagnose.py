"""`rovval diagnose`: which unmodelled effect causes the gap, where, and how far the gap shrinks with it."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rovval.cli import options, output


def command(
    sources: options.Sources,
    json_: Annotated[
        Path | None,
        typer.Option(
            "--json", metavar="FILE", help="Write the diagnosis as JSON; - is stdout, and then nothing else is printed there."
        ),
    ] = None,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="DIR", help="Report folder. Default: reports/RUN; none with --json.")
    ] = None,
    vehicle: options.VehicleOption = None,
    model: options.ModelOption = options.Model.fossen,
    window: options.WindowOption = 10.0,
    calibration_slop: Annotated[
        float,
        typer.Option(
            "--calibration-slop", min=0.0, max=0.5, help="How far off a healthy simulator's coefficients may be (0.05 is 5 %)."
        ),
    ] = 0.05,
    seed: Annotated[int, typer.Option("--seed", help="Seed of the bootstrap.")] = 0,
    write_vehicle: Annotated[
        Path | None,
        typer.Option("--write-vehicle", metavar="FILE.toml", help="Write the vehicle with the causes added as effects."),
    ] = None,
    profile: options.ProfileOption = None,
    archive: options.ArchiveOption = Path("archive"),
    quiet: options.QuietOption = False,
) -> None:
    """Say where the gap lies, which effect of the library causes it, and how far it shrinks with it on held-out data.

    Several runs of one vehicle are taken together. Every number is about this simulator, these logs and this library.

    \b
    Example:
      rovval diagnose dive.csv --json diagnosis.json
      rovval diagnose dive1.csv dive2.csv --profile merlin --write-vehicle mended.toml
    """
    from rovval import report, store
    from rovval.diagnose import diagnose
    from rovval.pipeline.atomic import write_json, write_text
    from rovval.pipeline.steps import vehicle_of
    from rovval.report.table import diagnosis_text

    runs = [store.open_run(source, profile, archive) for source in sources]
    nominal = vehicle_of(runs[0], vehicle)
    found = diagnose(
        runs,
        nominal,
        model=model.value,
        window_s=window,
        calibration_slop=calibration_slop,
        seed=seed,
        progress=output.progress(quiet),
    )
    to_stdout = json_ is not None and str(json_) == "-"
    if to_stdout:
        output.result_json(found.document)
    else:
        output.result(diagnosis_text(found.document))
    if json_ is not None and not to_stdout:
        write_json(json_, found.document)
        output.say(f"written: {json_}", quiet)
    if out is not None or json_ is None:
        place = out or Path("reports") / runs[0].id / "diagnosis"
        report.write_diagnosis(found.document, place)
        output.say(f"written: {place}", quiet)
    if write_vehicle is not None and not found.vehicle_fixed:
        output.say(f"{write_vehicle} not written: no cause was found that could be added to the vehicle")
    elif write_vehicle is not None:
        write_text(write_vehicle, found.vehicle_fixed)
        output.say(f"written: {write_vehicle}", quiet)
