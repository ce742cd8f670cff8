"""Reports of a Comparison or a Diagnosis: json for machines, md and html for people, a rerun recording to look around in."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rovval.data import Comparison, SimResult
    from rovval.vehicle.model import Vehicle


def write(comparison: Comparison, folder: Path, vehicle: Vehicle, corrected: SimResult | None = None) -> Mapping[str, Path]:
    """Write report.json, report.md, report.html and run.rrd into ``folder``, whole or not at all; name -> path.

    ``corrected`` is a simulation of the same run with the effects of a diagnosis in it: the recording's third trace.
    """
    from rovval.report import html, json, markdown, recording
    from rovval.report.files import write_all

    return write_all(
        Path(folder),
        {
            "report.json": json.text(json.document(comparison)),
            "report.md": markdown.text(comparison),
            "report.html": html.text(comparison),
            "run.rrd": lambda path: recording.write(comparison, path, vehicle, corrected),
        },
    )
