"""`rovval blind`: the withheld-effect check."""

from __future__ import annotations

import typer

app = typer.Typer(
    no_args_is_help=True, help="The withheld-effect check: sealed cases from an independent plant, answered and scored."
)
