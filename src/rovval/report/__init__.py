"""Reports of a Comparison or a Diagnosis: json for machines, md and html for people, a rerun recording to look around in."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rovval.comparison.tolerance import Tolerance
    from rovval.core.data import Comparison, SimResult
    from rovval.diagnose.result.diagnosis import Diagnosis
    from rovval.fly.flight import Flight
    from rovval.vehicle.model import Vehicle


def write(
    comparison: Comparison, folder: Path, vehicle: Vehicle, corrected: SimResult | None = None, recorded: bool = True, limits: Sequence[Tolerance] = (),
    links: Mapping[str, str] | None = None, log: Path | None = None,
) -> Mapping[str, Path]:  # fmt: skip
    """Write report.json, report.md, report.html and, where it is to be ``recorded``, run.rrd into ``folder``, whole or not at all; name -> path.

    ``corrected`` is a simulation of the same run with the effects of a diagnosis in it, whose report has or will have the recording in the same
    ``folder``: the recording's third trace. ``limits`` are the tolerances that were stated, ``links`` the pages that belong to this
    one, by what they are called, relative to ``folder``. The recording carries camera and sonar pictures of the ``log``, if it is given.
    """
    from rovval.report.common.files import Writer, write_all
    from rovval.report.comparison import html, json, markdown
    from rovval.report.recording import write as recording

    files: dict[str, str | Writer] = {
        "report.json": json.text(json.document(comparison)),
        "report.md": markdown.text(comparison),
        "report.html": html.text(comparison, recorded or corrected is not None, limits, links),
    }
    if recorded:
        files["run.rrd"] = lambda path: recording.write(comparison, path, vehicle, corrected, log=log)
    return write_all(folder, files)


def write_diagnosis(
    diagnosis: Diagnosis,
    folder: Path,
    comparison: Comparison | None = None,
    vehicle: Vehicle | None = None,
    corrected: SimResult | None = None,
    links: Mapping[str, str] | None = None,
    log: Path | None = None,
) -> Mapping[str, Path]:
    """Write diagnosis.json, diagnosis.md and diagnosis.html into ``folder``, whole or not at all; name -> path.

    With a comparison and its vehicle it also writes run.rrd, which carries the diagnosis, with the corrected simulation as its third trace.
    ``links`` and ``log`` as of `write`.
    """
    from rovval.report.common.files import Writer, write_all
    from rovval.report.comparison import json
    from rovval.report.diagnosis import html as diagnosis_html
    from rovval.report.diagnosis import markdown as diagnosis_markdown
    from rovval.report.diagnosis.json import worded
    from rovval.report.recording import write as recording

    if comparison is not None and not diagnosis.synthetic:
        diagnosis = diagnosis.model_copy(update={"synthetic": comparison.run.properties.get("synthetic", "")})
    diagnosis = worded(diagnosis)
    files: dict[str, str | Writer] = {
        "diagnosis.json": json.text(diagnosis.document()),
        "diagnosis.md": diagnosis_markdown.text(diagnosis),
        "diagnosis.html": diagnosis_html.text(diagnosis, comparison, corrected, comparison is not None and vehicle is not None, links),
    }
    if comparison is not None and vehicle is not None:
        files["run.rrd"] = lambda path: recording.write(comparison, path, vehicle, corrected, diagnosis, log)
    return write_all(folder, files)


def write_flight(flight: Flight, folder: Path) -> Mapping[str, Path]:
    """Write flight.json and flight.html into ``folder``, both or neither; name -> path."""
    from rovval.report.common.files import write_all
    from rovval.report.flight import html, json
    from rovval.storage.atomic import json_text

    return write_all(folder, {"flight.json": json_text(json.document(flight)), "flight.html": html.text(flight)})


def write_fit(document: dict[str, Any], folder: Path) -> Mapping[str, Path]:
    """Write fit.json and fit.html of a fit or a calibration into ``folder``, both or neither; name -> path."""
    from rovval.report.common.files import write_all
    from rovval.report.fit import html
    from rovval.storage.atomic import json_text

    return write_all(folder, {"fit.json": json_text(document), "fit.html": html(document)})
