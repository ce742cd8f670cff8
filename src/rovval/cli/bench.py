"""`rovval fit TABLE --motor` and `--response`: a thruster from its bench."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

from rovval.cli import output
from rovval.core.errors import UsageProblem


def fitted(sources: Sequence[str], motor: bool, response: bool, columns: str, out: Path | None, as_json: bool, quiet: bool) -> None:
    """What was found on stdout, and as JSON in ``out`` where it is given."""
    from rovval.fit import bench
    from rovval.storage.atomic import write_text

    if (motor and response) or len(sources) != 1:
        raise UsageProblem("--motor and --response take one table, and one of the two", "call it once for each")
    try:
        chosen = tuple(int(c) for c in columns.split(","))
    except ValueError:
        chosen = ()
    if len(chosen) != 2 or min(chosen) < 1:
        raise UsageProblem(f"--columns {columns}: not two numbers from 1 up", "write --columns 1,2")
    text, document = (bench.motor if motor else bench.response)(Path(sources[0]), chosen)
    if out is not None:
        write_text(out, json.dumps(document, indent=2, allow_nan=False) + "\n")
        output.say(f"written: {out}", quiet)
    output.result_json(document) if as_json else output.result(text)
