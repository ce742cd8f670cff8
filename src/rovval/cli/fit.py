"""`rovval fit`: tune chosen parameters of a vehicle to logs, as the thesis does by hand in 6.5."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rovval.cli import logs, options, output


def command(
    sources: options.Sources,
    parameters: Annotated[
        list[str],
        typer.Option("--parameters", metavar="NAME[,NAME]", help="What to tune, such as quadratic_drag[surge]; repeatable."),
    ],
    out: Annotated[Path, typer.Option("--out", metavar="VEHICLE.toml", help="Where the tuned vehicle is written.")],
    vehicle: options.VehicleOption = None,
    model: options.ModelOption = options.Model.fossen,
    window: options.WindowOption = 10.0,
    profile: options.ProfileOption = None,
    start_s: options.FromOption = None,
    end_s: options.ToOption = None,
    archive: options.ArchiveOption = Path("archive"),
    json_: options.JsonFlag = False,
    quiet: options.QuietOption = False,
) -> None:
    """Tune chosen parameters to one or more runs and write the tuned vehicle.

    \b
    Example:
      rovval fit dive.csv --parameters quadratic_drag[surge],quadratic_drag[sway] --out tuned.toml
    """
    from rovval.fit import fit
    from rovval.pipeline.steps import vehicle_of
    from rovval.report.fit import text
    from rovval.storage.atomic import refuse_unwritable, write_text

    refuse_unwritable(out)
    options.refuse_overwriting(vehicle, out)
    runs = logs.opened_as_one(sources, vehicle, profile, archive, quiet, start_s, end_s)
    wanted = [name for some in parameters for name in some.split(",") if name]
    tuned = fit(runs, vehicle_of(runs[0], vehicle), wanted, model=model.value, window_s=window)
    write_text(out, tuned.vehicle)
    if json_:
        output.result_json(tuned.document)
    else:
        output.result(text(tuned.document))
    output.say(f"written: {out}", quiet)
