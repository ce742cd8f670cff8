"""`rovval profile propose` and `rovval profile check`: a profile for a log that none is known for, and what it makes of the log."""

from __future__ import annotations

from typing import Annotated

import typer

from rovval.cli import complete, options, output
from rovval.cli.inspect import LogFile, looked_at

app = typer.Typer(rich_markup_mode=None, no_args_is_help=True, help="A profile for a new log: proposed from what the log holds, and checked.")


@app.command("propose")
def propose_command(
    file: LogFile,
    name: Annotated[str, typer.Option("--name", metavar="NAME", help="Name of the profile.")] = "my_log",
) -> None:
    """Write a profile for a log from names, units in headers and values; each guess is marked REVIEW, and every run made by it says that it is a draft.

    \b
    Example:
      rovval profile propose dive.csv > my_log.toml
      rovval profile check my_log.toml dive.csv
    """
    from rovval.ingest.inspection.proposal import proposed

    text = proposed(looked_at(file), name)
    output.result(text.rstrip("\n"))
    if (guesses := text.count("REVIEW")) > 1:
        output.say(f"{guesses - 1} guesses are marked REVIEW; next: confirm or mend them, then `rovval profile check {name}.toml {file}`")


@app.command("check")
def check_command(
    profile: Annotated[str, typer.Argument(metavar="PROFILE", help="A TOML file, or a built-in profile.", autocompletion=complete.profiles)],
    file: LogFile,
    timezone: options.TimezoneOption = None,
    json_: options.JsonFlag = False,
) -> None:
    """Read a log by a profile: what matched, the first rows in SI, what is left over, and what the log's own motion says against it.

    Exit code 2 for a profile that is wrong, 3 for a log that it does not read; every problem at once.

    \b
    Example:
      rovval profile check my_log.toml dive.csv
    """
    from dataclasses import replace

    from rovval.alignment import align
    from rovval.alignment.checks import check as against_itself
    from rovval.ingest.inspection.check import checked
    from rovval.report import profile_check

    found = checked(profile, file, timezone)
    run = align(replace(found.raw, findings=tuple(dict.fromkeys((*found.raw.findings, *against_itself(found.raw))))))
    output.result_json(profile_check.document(found, run)) if json_ else output.result(profile_check.page(found, run))
