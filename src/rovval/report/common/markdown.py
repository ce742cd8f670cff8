"""Pieces of Markdown that every report uses."""

from __future__ import annotations

from collections.abc import Iterable, Sequence


def grid(header: Sequence[str], rows: Iterable[Sequence[str]], text_columns: int = 1) -> str:
    """A table, its first ``text_columns`` to the left and numbers to the right."""
    marks = ["---" if j < text_columns else "---:" for j in range(len(header))]
    return "\n".join("| " + " | ".join(r).replace("\n", " ") + " |" for r in (header, marks, *rows))


def bullets(items: Iterable[str]) -> str:
    """A list of lines, "" for none."""
    return "\n".join(f"- {item}" for item in items)


def under(title: str, *parts: str) -> list[str]:
    """A heading with what belongs under it; nothing where there is nothing."""
    return [f"## {title}", *parts] if any(parts) else []
