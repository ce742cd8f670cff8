"""A diagnosis as JSON document (schema rovval.diagnosis/1) with the words that a person reads in it."""

from __future__ import annotations

from typing import Any

from rovval.diagnose import Diagnosis
from rovval.report.diagnosis.command import Typed, recalibrate
from rovval.report.diagnosis.nothing import unexplained
from rovval.report.diagnosis.sentence import first, sentence


def document(diagnosis: Diagnosis, typed: Typed | None = None) -> dict[str, Any]:
    """The document with its sentences and commands, the latter as they were ``typed`` on the command line."""
    found = diagnosis.document()
    if diagnosis.left:
        found["left"] |= {"text": diagnosis.left.text or unexplained(found)}
    if diagnosis.calibration:
        found["calibration"] |= {"command": diagnosis.calibration.command or recalibrate(diagnosis, typed)}
    return found | {"answer": diagnosis.answer or first(found), "sentence": diagnosis.sentence or sentence(found)}
