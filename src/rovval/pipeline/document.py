"""docs/reference/pipelines.md, written out of the pipeline file's own model: ``python -m rovval.pipeline.document > docs/reference/pipelines.md``."""

from __future__ import annotations

import json
import sys
from pathlib import PurePath
from typing import Any

from pydantic import BaseModel
from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined

from rovval.pipeline.planning.config import Pipeline, Source

HEAD = """# Pipeline files

What `rovval run PIPELINE.toml` reads. Written by `python -m rovval.pipeline.document` out of `src/rovval/pipeline/planning/config.py`; change that.

A pipeline file says which logs, of which vehicle, go through which steps, and what counts as too far off. A misspelt key is refused, all problems of a
file at once, before the first log is touched. How it runs at night: [Running at night](../night.md); what is kept of it: [The catalogue](../catalogue.md).
"""
EXAMPLE = """## Example

```toml
name = "nightly"
steps = ["ingest", "simulate", "compare", "diagnose"]
archive = "archive"
reports = "reports/nightly"
settle_s = 60.0
tolerances = ["window.surge=0.10", "window.yaw.iae=200", "trend.surge=3"]

[[source]]
logs = ["logs/**/*.csv"]
profile = "merlin"

[[source]]
logs = ["bags/*.bag", "dives/*/dive.toml"]
profile = "my_bag.toml"
vehicle = "bluerov2_heavy"
```
"""


def text() -> str:
    """The whole page, Markdown."""
    return "\n".join([HEAD, _section("The file", Pipeline), _section("[[source]]", Source), EXAMPLE])


def _section(title: str, model: type[BaseModel]) -> str:
    """One table of the file."""
    schema = model.model_json_schema()["properties"]
    rows = [f"| `{name}` | {_default(field)} | {_allowed(schema[name])} | {field.description} |" for name, field in model.model_fields.items()]
    about = (model.__doc__ or "").replace("``", "`").strip()
    return "\n".join([f"## {title}", "", about, "", "| key | default | takes | meaning |", "|---|---|---|---|", *rows, ""])


def _default(field: FieldInfo) -> str:
    """What stands for a key that the file leaves out."""
    value: Any = field.default
    if value is PydanticUndefined:
        return "needed"
    if value in (None, "", ()):
        return ""
    return f"`{value.as_posix() if isinstance(value, PurePath) else json.dumps(value)}`"


def _allowed(schema: dict[str, Any]) -> str:
    """What a key takes, as the model's JSON schema has it."""
    kind = next(k for k in schema.get("anyOf", [schema]) if k.get("type") != "null")
    if kind.get("type") == "array":
        inner = kind["items"]
        return "tables" if "$ref" in inner else f"list of {', '.join(f'`{word}`' for word in inner['enum'])}" if "enum" in inner else "list of texts"
    signs = (("exclusiveMinimum", "> {:g}"), ("minimum", ">= {:g}"), ("exclusiveMaximum", "< {:g}"), ("maximum", "<= {:g}"))
    bounds = " and ".join(sign.format(kind[key]) for key, sign in signs if key in kind)
    name = {"number": "number", "integer": "whole number", "boolean": "`true`, `false`", "string": "text"}.get(kind.get("type", ""), "text")
    return f"{name} {bounds}".strip()


if __name__ == "__main__":
    sys.stdout.write(text())
