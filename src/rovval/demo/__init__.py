"""The sample dive that comes with rovval, and the whole job done on it. The dive is SYNTHETIC: see `demo.make`."""

from __future__ import annotations

import gzip
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from rovval.storage.atomic import drafts

if TYPE_CHECKING:
    from rovval.core.data import Run

SAMPLE = Path(__file__).parent / "SYNTHETIC_merlin_dive.csv.gz"
EFFECT = "inflow_loss:loss=0.3"
SYNTHETIC = f"a Merlin dive made by rovval's own plant with sensor noise and the effect {EFFECT} left in"


@dataclass(frozen=True, slots=True)
class Shown:
    """What the demo shows: text for people, a document for programs, and where the files are."""

    text: str
    document: Mapping[str, Any]
    files: Mapping[str, Path]


def unpack(folder: Path) -> Path:
    """The sample log as the CSV file that a vehicle would have written."""
    path = folder / SAMPLE.stem
    with drafts(path) as [draft]:
        draft.write_bytes(gzip.decompress(SAMPLE.read_bytes()))
    return path


def sample() -> Run:
    """The sample dive on the 10 Hz grid, labelled as synthetic."""
    with TemporaryDirectory() as folder:
        return _read(unpack(Path(folder)))


def run(folder: Path, with_diagnosis: bool, progress: Callable[[str, float], None]) -> Shown:
    """Ingest, align, simulate, compare and diagnose the sample; reports and the log itself go to ``folder``."""
    from rovval import report
    from rovval.comparison import compare
    from rovval.diagnose import diagnose
    from rovval.report.comparison.json import document as comparison_json
    from rovval.report.comparison.terminal import text
    from rovval.report.diagnosis import json as diagnosis_json
    from rovval.report.diagnosis.terminal import text as diagnosis_text
    from rovval.simulation import simulate
    from rovval.vehicle import load

    progress("read the sample log", 0.0)
    log = unpack(folder)
    dive = _read(log)
    vehicle = load(dive.vehicle)
    progress("simulate", 0.1)
    comparison = compare(dive, simulate(dive, vehicle))
    document: dict[str, Any] = {
        "schema": "rovval.demo/1",
        "synthetic": SYNTHETIC,
        "comparison": comparison_json(comparison),
    }
    parts, corrected = [text(comparison)], None
    if with_diagnosis:
        found = diagnose([dive], vehicle, progress=lambda step, share: progress(step, 0.2 + 0.6 * share))
        found = diagnosis_json.worded(found)
        document["diagnosis"] = found.document()
        parts += [
            diagnosis_text(found),
            f"The effect that was left in this SYNTHETIC log, to judge the diagnosis by: {EFFECT}",
        ]
        corrected = simulate(dive, vehicle, effects=found.settings)
    progress("report", 0.8)
    links = {"Diagnosis": "diagnosis.html"} if with_diagnosis else {}
    files = {"log": log, **report.write(comparison, folder, vehicle, corrected, recorded=not with_diagnosis, links=links)}
    if with_diagnosis:
        files |= report.write_diagnosis(found, folder, comparison, vehicle, corrected, {"Comparison": "report.html"})
    progress("demo", 1.0)
    document["files"] = {kind: str(path) for kind, path in files.items()}
    return Shown("\n\n".join(parts), document, files)


def _read(log: Path) -> Run:
    from rovval.storage.archive import open_run

    dive = open_run(log, "merlin")
    return replace(dive, properties={**dive.properties, "synthetic": SYNTHETIC})
