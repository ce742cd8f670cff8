"""`rovval blind`: the withheld-effect check, on logs of an independent plant whose labels lie apart."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rovval.cli import complete, output
from rovval.errors import UsageProblem

app = typer.Typer(no_args_is_help=True, help="The withheld-effect check: cases from an independent plant, answered and scored.")


@app.command()
def make(
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Where the logs are written, under random names.")],
    labels: Annotated[
        Path | None, typer.Option("--labels", metavar="DIR", help="Where the answers are kept. Default: DIR-labels.")
    ] = None,
    vehicle: Annotated[str, typer.Option("--vehicle", metavar="V", autocompletion=complete.vehicles)] = "merlin",
    seed: Annotated[int, typer.Option("--seed", help="Equal seeds make equal logs.")] = 0,
    cases: Annotated[
        Path | None, typer.Option("--cases", metavar="FILE", help="JSON list of missions and effects. Default: the whole grid.")
    ] = None,
    limit: Annotated[int | None, typer.Option("--limit", min=1, help="Only the first so many cases.")] = None,
    workers: Annotated[int, typer.Option("--workers", metavar="N", min=1)] = 2,
) -> None:
    """Make logs with hidden effects by a plant that shares no code with rovval's own.

    \b
    Example:
      rovval blind make --out cases --labels sealed --seed 7 --limit 24
    """
    from rovval import vehicle as vehicles
    from rovval.blind.generate import generate, read_cases
    from rovval.blind.grid import grid

    vehicles.load(vehicle)
    path = Path(vehicle) if vehicle.endswith(".toml") else vehicles.LIBRARY / f"{vehicle}.toml"
    chosen = read_cases(cases, seed) if cases else grid(path, seed, 1)
    made = generate(path, chosen[:limit], out, labels or out.with_name(f"{out.name}-labels"), seed, workers)
    failed = sum("failed" in label for label in made.values())
    output.result(f"{len(made) - failed} logs in {out}" + (f", {failed} flights failed" if failed else ""))


@app.command()
def answer() -> None:
    """Diagnose every log of a set (not in this version).

    \b
    Example:
      rovval blind answer cases
    """
    raise UsageProblem(
        "`rovval blind answer` is not in this version", "diagnose the logs one by one: `rovval diagnose LOG --json FILE`"
    )


@app.command()
def score() -> None:
    """Open the seal and score the answers (not in this version).

    \b
    Example:
      rovval blind score cases
    """
    raise UsageProblem("`rovval blind score` is not in this version", "compare the diagnoses with labels.json")
