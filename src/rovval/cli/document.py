"""docs/reference/commands.md, written out of the commands themselves: ``python -m rovval.cli.document > docs/reference/commands.md``."""

from __future__ import annotations

import inspect
import sys
from collections.abc import Iterator
from enum import Enum
from html import escape
from typing import Any

import typer

from rovval.cli.app import app

HEAD = """# Commands

Written by `python -m rovval.cli.document` out of `src/rovval/cli`; change that. `rovval COMMAND --help` prints the same.

Results go to stdout, messages and progress to stderr. With `--json` stdout is one JSON document (schemas: [JSON](schemas.md)), and a refusal is one, too,
on stderr. Colour and bars are for terminals; with `NO_COLOR` set there is no colour at all. `rovval run` without a terminal writes a line of progress every ten
seconds.

| exit code | meaning |
|---|---|
| 0 | done |
| 1 | done, and a stated tolerance is exceeded (or a scenario is not met) |
| 2 | usage or configuration |
| 3 | unusable input; of `rovval run`: a log stands in quarantine, or a source has no log at all |
| 4 | the simulation left sane limits; the result holds what came before |
| 70 | internal error; the message says where the traceback lies |
| 130 | interrupted |
"""


def text() -> str:
    """The page, Markdown."""
    root: Any = typer.main.get_command(app)
    return "\n".join([HEAD, *(_section(name, command) for name, command in _commands(root))])


def _commands(group: Any, path: str = "rovval") -> Iterator[tuple[str, Any]]:
    """Every command by its whole name, those of a group after the group's own."""
    for name, command in group.commands.items():
        whole = f"{path} {name}"
        if hasattr(command, "commands"):
            yield from _commands(command, whole)
        else:
            yield whole, command


def _section(name: str, command: Any) -> str:
    """One command."""
    words, _, example = inspect.cleandoc(command.help or "").partition("\b\n")
    arguments = " ".join(_placeholder(p) for p in command.params if p.param_type_name == "argument")
    parts = [f"## {name}", " ".join(words.split()), f"```\n{name} {arguments} [OPTIONS]\n```".replace("  ", " ")]
    lines = inspect.cleandoc(example.replace("Example:", "", 1)).splitlines()
    parts += ["Example:\n\n```\n" + "\n".join(lines) + "\n```"] if lines else []
    rows = [_row(p) for p in command.params if p.name != "help"]
    parts += ["| | default | meaning |\n|---|---|---|\n" + "\n".join(rows)] if rows else []
    return "\n\n".join(parts) + "\n"


def _placeholder(parameter: Any) -> str:
    """What stands for a value."""
    if parameter.metavar:
        return str(parameter.metavar)
    return "|".join(str(m.value) for m in type(parameter.default)) if isinstance(parameter.default, Enum) else parameter.name.strip("_").upper()


def _row(parameter: Any) -> str:
    """One argument or option."""
    shown = _placeholder(parameter)
    if parameter.param_type_name == "option":
        opts = ", ".join((*parameter.opts, *parameter.secondary_opts))
        shown = opts if parameter.is_flag else f"{opts} {shown}"
    default = "required" if parameter.required else _default(parameter.default)
    said = " ".join((parameter.help or "").split())
    return "| " + " | ".join(cell.replace("|", "&#124;") for cell in (f"<code>{escape(shown)}</code>", default, said)) + " |"


def _default(value: Any) -> str:
    """A default as one would type it; nothing for a flag that is off."""
    if value is None or value is False or value == "" or callable(value):
        return ""
    return "on" if value is True else f"`{value.value if isinstance(value, Enum) else value}`"


if __name__ == "__main__":
    sys.stdout.write(text())
