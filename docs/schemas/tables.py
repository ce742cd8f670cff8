"""Tables of the JSON schemas beside this file, for the site: a line `{{ schema NAME }}` of a page becomes them."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent


def on_page_markdown(markdown: str, **_: Any) -> str:
    """Called by mkdocs with the text of each page."""
    return re.sub(r"^\{\{ schema (\w+) \}\}$", lambda found: tables(found[1]), markdown, flags=re.MULTILINE)


def tables(name: str) -> str:
    """One schema: its own keys, then each part that it is made of."""
    schema = json.loads((HERE / f"{name}.json").read_text(encoding="utf-8"))
    parts = [(schema.get("description", ""), schema, "")]
    parts += [(part.get("description", ""), part, title) for title, part in schema.get("$defs", {}).items()]
    return "\n\n".join(_table(name, said, part, title) for said, part, title in parts if part.get("properties"))


def _table(name: str, said: str, part: dict[str, Any], title: str) -> str:
    head = f"### {title} {{ #{name}-{title.lower()} }}\n\n" if title else ""
    rows = "\n".join(_rows(name, part, ""))
    return f"{head}{said}\n\n| key | type | meaning |\n|---|---|---|\n{rows}"


def _rows(name: str, part: dict[str, Any], path: str) -> list[str]:
    """One row a key; the keys of an object that stands inside follow it."""
    rows = []
    needed = part.get("required", [])
    for key, value in part["properties"].items():
        said = value.get("description", "") + ("" if key in needed else " (may be missing)" if value.get("description") else "may be missing")
        rows.append(f"| `{path}{key}` | {_kind(name, value)} | {said.replace('|', '&#124;')} |")
        for inside, mark in ((value, ""), (value.get("items", {}), "[]"), (_whole(value), ".*")):
            rows += _rows(name, inside, f"{path}{key}{mark}.") if "properties" in inside else []
    return rows


def _whole(value: dict[str, Any]) -> dict[str, Any]:
    """What every key of a table maps to, where the names of the keys are open."""
    found = value.get("additionalProperties")
    return found if isinstance(found, dict) else {}


def _kind(name: str, value: dict[str, Any]) -> str:
    """A type in words, with a link to the part that it is."""
    if "$ref" in value:
        title = value["$ref"].rpartition("/")[2]
        return f"[{title}](#{name}-{title.lower()})"
    if "const" in value:
        return f"`{json.dumps(value['const'])}`"
    if "enum" in value:
        return ", ".join(f"`{json.dumps(word)}`" for word in value["enum"])
    if options := value.get("anyOf"):
        return " or ".join(dict.fromkeys(_kind(name, option) for option in options))
    kind = value.get("type", "any")
    if isinstance(kind, list):
        return " or ".join(kind)
    if kind == "array":
        return f"list of {_kind(name, value['items'])}" if value.get("items") else "list"
    return f"table of {_kind(name, _whole(value))}" if kind == "object" and _whole(value) else str(kind)
