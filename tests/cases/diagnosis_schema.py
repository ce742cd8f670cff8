"""The published schema of a diagnosis, and whether a document is one."""

from __future__ import annotations

import functools
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from jsonschema import Draft202012Validator

from rovval.diagnose import Diagnosis

PUBLISHED = Path(__file__).parents[2] / "docs" / "schemas" / "diagnosis.json"


@functools.cache
def _validator() -> Draft202012Validator:
    schema = json.loads(PUBLISHED.read_text(encoding="utf-8"))
    Draft202012Validator.check_schema(schema)
    return Draft202012Validator(schema)


def check_document(document: Mapping[str, Any]) -> None:
    """A document as it is written is what the published schema says, and is the same after it was read."""
    _validator().validate(json.loads(json.dumps(document, allow_nan=False)))
    assert Diagnosis.read(document).document() == document
