"""`rovval report`: several runs, or several models, side by side."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rovval.cli import logs, options, output
from rovval.core.errors import UsageProblem

Models = Annotated[list[options.Model] | None, typer.Option("--model", help="A platform, as of `rovval compare`; repeatable. Default: fossen.")]
Out = Annotated[Path | None, typer.Option("--out", metavar="DIR", help="Where the page is written. Default: reports/side_by_side; none with --json.")]


def command(
    sources: options.Sources,
    vehicle: options.VehicleOption = None,
    model: Models = None,
    window: options.WindowOption = 10.0,
    profile: options.ProfileOption = None,
    timezone: options.TimezoneOption = None,
    start: options.FromOption = None,
    end: options.ToOption = None,
    archive: options.ArchiveOption = Path("archive"),
    out: Out = None,
    json_: options.JsonFlag = False,
    quiet: options.QuietOption = False,
) -> None:
    """Compare several runs, or one run by several models, and set the errors side by side: one page, a row each.

    \b
    Example:
      rovval report dive1.csv dive2.csv
      rovval report dive.csv --model fossen --model uuv
    """
    from rovval.comparison import compare
    from rovval.pipeline.steps import simulated, vehicle_of
    from rovval.report import side_by_side
    from rovval.report.common.files import write_all
    from rovval.storage.atomic import json_text

    models = list(dict.fromkeys(model or [options.Model.fossen]))
    if len(sources) * len(models) < 2:
        raise UsageProblem("report of one run by one model: nothing stands beside it", "give more runs or more models, or use `rovval compare`")
    comparisons, show = [], output.progress(quiet)
    for k, source in enumerate(sources):
        run = logs.opened(source, logs.Reading(profile, archive, timezone, start, end), quiet)
        nominal = vehicle_of(run, vehicle)
        show("simulate", k / len(sources))
        comparisons += [compare(run, simulated(run, nominal, one.value, (), window)) for one in models]
    show("simulate", 1.0)
    document = side_by_side.document(comparisons)
    folder = Path("reports") / "side_by_side" if out is None and not json_ else out
    files = {} if folder is None else write_all(folder, {"side_by_side.json": json_text(document), "side_by_side.html": side_by_side.html(comparisons)})
    if json_:
        output.result_json(document)
    else:
        output.result(side_by_side.text(comparisons))
        output.result("\nWritten:\n" + output.places(files))
