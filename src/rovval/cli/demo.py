"""`rovval demo`: the whole job on the sample log that comes with rovval."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rovval.cli import options, output


def command(
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Where the log and the reports are written.")] = Path(
        "reports/demo"
    ),
    diagnose: Annotated[bool, typer.Option("--diagnose/--no-diagnose", help="Also say which effect causes the gap.")] = True,
    json_: options.JsonFlag = False,
    quiet: options.QuietOption = False,
) -> None:
    """The whole job on an embedded sample log: ingest, align, simulate, compare, diagnose.

    The log is SYNTHETIC: a Merlin dive that rovval's own plant made, with sensor noise and one effect that the simulator does
    not know. The report shows how far the simulator is off on each axis, the diagnosis which effect does it.

    \b
    Example:
      rovval demo
      rovval demo --out /tmp/demo --no-diagnose
    """
    from rovval.demo import run

    shown = run(out, with_diagnosis=diagnose, progress=output.progress(quiet))
    if json_:
        output.result_json(shown.document)
        return
    output.result_in_sections(shown.text)
    output.result("\nWritten:\n" + output.places(shown.files))
