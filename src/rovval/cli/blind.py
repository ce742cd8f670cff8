"""`rovval blind`: the withheld-effect check, on logs of an independent plant whose labels are sealed."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rovval.cli import complete, options, output
from rovval.core.counts import counted
from rovval.core.progress import Progress

app = typer.Typer(
    no_args_is_help=True,
    help="The withheld-effect check: make sealed logs with hidden effects, answer them, open the seal and score.",
    epilog="All of it: `rovval blind make sets/a --size full && rovval blind answer sets/a && rovval blind score sets/a`.",
)
Set = Annotated[Path, typer.Argument(metavar="DIR", help="Folder of the sealed set.")]
Key = Annotated[
    Path | None, typer.Option("--key", metavar="FILE", help="Where the key lies. Default: DIR.key, beside the folder.")
]
Workers = Annotated[int, typer.Option("--workers", metavar="N", min=1, help="Processes, one thread each.")]


@app.command()
def make(
    folder: Set,
    vehicle: Annotated[str, typer.Option("--vehicle", metavar="V", autocompletion=complete.vehicles)] = "merlin",
    seed: Annotated[
        int | None, typer.Option("--seed", help="Equal seeds make equal logs. Default: drawn, and sealed too.")
    ] = None,
    plant: Annotated[str, typer.Option("--plant", metavar="a|b", help="Which of the two independent plants flies.")] = "a",
    size: Annotated[
        str, typer.Option("--size", metavar="full|small|COUNT", help="Several hundred logs, 24, or so many.")
    ] = "full",
    healthy: Annotated[
        float | None,
        typer.Option("--healthy", metavar="SHARE", help="Share of healthy logs. Default: 0.3 of plant b; of plant a the grid's."),
    ] = None,
    seconds: Annotated[float | None, typer.Option("--seconds", metavar="S", help="Length of each log. Default: 300.")] = None,
    cases: Annotated[
        Path | None, typer.Option("--cases", metavar="FILE", help="JSON list of missions and effects, instead of --size.")
    ] = None,
    key: Key = None,
    workers: Workers = 2,
    quiet: options.QuietOption = False,
) -> None:
    """Make logs with hidden effects by plants that share no code with rovval's own or with each other, and seal their labels.

    \b
    Example:
      rovval blind make sets/small --seed 7 --size small
      rovval blind make sets/b --plant b --vehicle minerva --size 60 --healthy 0.4
    """
    from rovval.blind.cases.generate import read_cases
    from rovval.blind.cases.questions import Question
    from rovval.blind.plant.spec import PLANTS
    from rovval.blind.sealed.make import make_set
    from rovval.core.errors import UsageProblem
    from rovval.vehicle import LIBRARY, load

    if plant not in PLANTS:
        raise UsageProblem(f"--plant {plant} is no plant", f"use one of {', '.join(PLANTS)}")
    load(vehicle)
    path = Path(vehicle) if vehicle.endswith(".toml") else LIBRARY / f"{vehicle}.toml"
    asked = [Question(case) for case in read_cases(cases, seed or 0, PLANTS[plant])] if cases else None
    made = make_set(
        folder, path, seed, size, plant=PLANTS[plant], healthy=healthy, seconds=seconds, asked=asked, key=key, workers=workers, say=_steps(quiet)
    )
    manifest = made.manifest()
    output.result(f"{counted(manifest['count'], 'log')} in {made.logs}; labels sealed, SHA-256 {manifest['labels_sha256']}")
    output.say(f"key: {key or made.key}; next: rovval blind answer {folder}", quiet)


@app.command()
def answer(
    folder: Set,
    fresh: Annotated[bool, typer.Option("--fresh", help="Throw away answers that are there and begin again.")] = False,
    floors: Annotated[bool, typer.Option(help="Also ask the simple methods that the score is compared with.")] = True,
    workers: Workers = 2,
    quiet: options.QuietOption = False,
) -> None:
    """Diagnose every log of a set and commit the answers by digest; goes on where it was stopped.

    \b
    Example:
      rovval blind answer sets/small
    """
    from rovval.blind.sealed.answer import answer_set

    done = answer_set(folder, workers=workers, baselines=floors, fresh=fresh, say=_steps(quiet))
    output.result(f"answers of engine {done['engine']} committed at {done['committed']}, SHA-256 {done['sha256']}")
    output.say(f"next: rovval blind score {folder}", quiet)


@app.command()
def score(
    folder: Set,
    key: Key = None,
    history: Annotated[
        Path | None, typer.Option("--history", metavar="FILE", help="JSON lines of unsealings. Default: the repository's.")
    ] = None,
    json_: options.JsonFlag = False,
    workers: Workers = 2,
    quiet: options.QuietOption = False,
) -> None:
    """Open the seal, check all digests and score. After this no answer to the set is accepted any more.

    \b
    Example:
      rovval blind score sets/small
    """
    from rovval.blind.scoring.score import score_set
    from rovval.report.blind import html as blind_html
    from rovval.report.blind import terminal as blind_terminal
    from rovval.storage.atomic import write_text

    result = score_set(folder, key=key, kept=history, workers=workers, say=_steps(quiet))
    write_text(folder / "score.html", blind_html.text(result))
    if json_:
        output.result_json(result)
    else:
        output.result(blind_terminal.text(result))
        output.say(output.places({"html": folder / "score.html", "json": folder / "score.json"}), quiet)


@app.command()
def pool(
    folders: Annotated[list[Path], typer.Argument(metavar="DIR...", help="Folders of scored sets, of any vehicles and of both plants.")],
    json_: options.JsonFlag = False,
) -> None:
    """Several scored sets together, each plant apart: counts with intervals, reliability of the stated probabilities, every wrong log.

    \b
    Example:
      rovval blind pool sets/a sets/b sets/b_minerva
    """
    from rovval.blind.scoring.pool import pool as pooled
    from rovval.report.blind import terminal as blind_terminal

    result = pooled(folders)
    if json_:
        output.result_json(result)
    else:
        output.result(blind_terminal.pooled(result))


def _steps(quiet: bool) -> Progress:
    """One line a step on a terminal, else a line for each log: a long run in a batch system is to be followed too."""
    import sys

    if quiet or sys.stderr.isatty():
        return output.progress(quiet)
    return lambda step, share: output.say(step)
