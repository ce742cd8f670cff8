"""A diagnosis as JSON document (schema rovval.diagnosis/1) with the words that a person reads in it."""

from __future__ import annotations

from typing import Any

from rovval.diagnose.result.diagnosis import Diagnosis
from rovval.report.diagnosis.command import Typed, recalibrate
from rovval.report.diagnosis.sentences.no_cause import unexplained
from rovval.report.diagnosis.sentences.sentence import answer, sentence


def document(d: Diagnosis, typed: Typed | None = None) -> dict[str, Any]:
    """The document with its sentences and commands, the latter as they were ``typed`` on the command line."""
    return worded(d, typed).document()


def worded(d: Diagnosis, typed: Typed | None = None) -> Diagnosis:
    """The diagnosis with its sentences and commands in it; those that it has already, as one that was read from a file, stay."""
    left, tuned = d.left, d.calibration
    if left and not left.text:
        left = left.model_copy(update={"text": unexplained(d)})
    if tuned and not tuned.command:
        tuned = tuned.model_copy(update={"command": recalibrate(d, typed)})
    return d.model_copy(update={"left": left, "calibration": tuned, "answer": answer(d), "sentence": sentence(d)})
