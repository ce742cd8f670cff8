"""The functions of the package for the site: a line `{{ function NAME }}` of a page becomes its signature and what its docstring says.

By themselves, and not by mkdocstrings: `diagnose`, `fit` and `fly` are functions and folders, of which it shows the folder.
"""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from typing import Any

import griffe

SOURCE = Path(__file__).parents[2] / "src" / "rovval" / "__init__.py"


def on_page_markdown(markdown: str, **_: Any) -> str:
    """Called by mkdocs with the text of each page."""
    return re.sub(r"^\{\{ function (\w+) \}\}$", lambda found: described(found[1]), markdown, flags=re.MULTILINE)


@cache
def _module() -> griffe.Module:
    return griffe.visit("rovval", SOURCE, SOURCE.read_text(encoding="utf-8"), docstring_parser="google")


def described(name: str) -> str:
    """Heading, signature and docstring of one function."""
    function: Any = _module()[name]
    lines = [f"### {name} {{ #rovval.{name} }}", f"```python\n{_signature(function)}\n```"]
    for section in function.docstring.parse("google"):
        if section.kind.value == "text":
            lines.append(section.value)
        else:
            title = {"parameters": "Parameters", "raises": "Raises"}[section.kind.value]
            rows = (f"- `{getattr(row, 'name', None) or row.annotation}`: {row.description}" for row in section.value)
            lines.append(f"{title}:\n\n" + "\n".join(" ".join(row.split()) for row in rows))
    return "\n\n".join(lines)


def _signature(function: Any) -> str:
    """One parameter a line."""
    lines, named = [], False
    for parameter in function.parameters:
        keyword = parameter.kind is griffe.ParameterKind.keyword_only
        lines += ["    *,"] if keyword and not named else []
        named |= keyword
        default = "" if parameter.default is None else f" = {parameter.default}"
        lines.append(f"    {parameter.name}: {parameter.annotation}{default},")
    return "\n".join([f"rovval.{function.name}(", *lines, f") -> {function.returns}"])
