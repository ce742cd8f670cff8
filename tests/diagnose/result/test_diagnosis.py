"""The typed diagnosis: what a program gets, how it is written, and which documents it reads."""

from __future__ import annotations

import json
from typing import Any

import pytest
from diagnose_case import diagnosed
from diagnosis_schema import PUBLISHED, check_document
from jsonschema import ValidationError as Invalid
from pydantic import ValidationError
from report_cases import make_diagnosis

from rovval.core.errors import BadInput
from rovval.diagnose import Diagnosis

OLDER = {"beside_slop": {"total": 0.6, "low": 0.5, "high": 0.7}}  # as documents had it before within_tolerance


def published() -> str:
    """The schema as the file has it."""
    return json.dumps(Diagnosis.published_schema(), indent=2) + "\n"


def test_the_published_schema_is_that_of_the_types():
    assert PUBLISHED.read_text(encoding="utf-8") == published(), f"write it anew: PYTHONPATH=tests/cases python {__file__}"


def test_every_field_says_what_it_means():
    schema = Diagnosis.published_schema()
    for name, part in (("Diagnosis", schema), *schema["$defs"].items()):
        for key, row in part["properties"].items():
            assert row.get("description"), f"{name}.{key}"


def test_the_engine_fills_every_field_but_the_words():
    assert set(Diagnosis.model_fields) - diagnosed().model_fields_set == {"schema_", "answer", "sentence"}


def test_a_program_reads_attributes():
    found = Diagnosis.read(make_diagnosis())
    (cause,) = found.causes
    assert found.verdict == "partly_explained" and cause.effect == "inflow_loss" and cause.parameters["loss"].value == 0.31
    assert found.shrinkage.total == 0.66 and found.gap.axes["surge"].unit == "m/s" and found.left and found.left.axes == ("yaw",)


def test_it_is_frozen():
    with pytest.raises(ValidationError):
        setattr(Diagnosis.read(make_diagnosis()), "verdict", "no_gap")  # noqa: B010


@pytest.mark.parametrize("older", [{}, {"verdict": "unknown", "causes": []}, OLDER, {"left": None, "a key of a later version": 1}])
def test_older_and_later_documents_are_read_and_written_whole(older: dict[str, Any]):
    document = Diagnosis.read(make_diagnosis() | older).document()
    check_document(document)
    assert document["beside_slop"] == document["within_tolerance"] == older.get("beside_slop")


def test_an_older_key_stands_beside_the_one_that_took_its_place():
    detection = diagnosed().document()["detection"]
    assert detection["slop"] == detection["tolerance_share"] and detection["strain"] == detection["largest_departure"]


def test_what_is_no_diagnosis_is_refused_with_all_that_is_missing():
    broken = {key: value for key, value in make_diagnosis().items() if key not in ("vehicle", "ranking")} | {"verdict": "maybe"}
    with pytest.raises(BadInput, match=r"(?s)diagnosis of dive-0007: 3 problems.*vehicle.*verdict.*ranking"):
        Diagnosis.read(broken)


def test_a_document_that_lacks_a_key_is_not_what_the_schema_says():
    document = Diagnosis.read(make_diagnosis()).document()
    del document["gap"]["axes"]["surge"]["floor_rms"]
    with pytest.raises(Invalid, match="floor_rms"):
        check_document(document)


if __name__ == "__main__":
    PUBLISHED.write_text(published(), encoding="utf-8")
