"""The commands that calibrate a vehicle whose file is off in many numbers, as a person types them."""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from dataclasses import dataclass, field

from rovval.diagnose.result.diagnosis import Diagnosis

USUAL_MODEL = "fossen"


@dataclass(frozen=True, slots=True)
class Typed:
    """What a diagnosis was asked with on the command line.

    Attributes:
        sources: what was typed for each run, by its id; a run that is not there is typed by its id.
        vehicle: what was typed for the vehicle; empty for the name of the one that was diagnosed.
        options: further options with their values, such as ("--window", "5").
    """

    sources: Mapping[str, str] = field(default_factory=dict)
    vehicle: str = ""
    options: tuple[str, ...] = ()


def recalibrate(diagnosis: Diagnosis, typed: Typed | None = None) -> str:
    """The `rovval fit` of the numbers that are off; what fit cannot search for is written by `rovval diagnose` before. Empty where nothing was recalibrated."""
    found, typed = diagnosis.calibration, typed or Typed()
    if found is None:
        return ""
    logs = [typed.sources.get(run, run) for run in diagnosis.runs]
    model = [] if diagnosis.model == USUAL_MODEL else ["--model", diagnosis.model]

    def line(command: str, vehicle: str, *rest: str) -> str:
        return shlex.join(["rovval", command, *logs, *typed.options, "--vehicle", vehicle, *model, *rest])

    nominal = typed.vehicle or diagnosis.vehicle
    first = line("diagnose", nominal, "--write-vehicle", "mended.toml") + " && " if found.diagnosed else ""
    start = "mended.toml" if found.diagnosed else nominal
    return first + line("fit", start, "--parameters", ",".join(found.fitted), "--out", "calibrated.toml")
