"""Commands as a script sees them, and a short dive to give them."""

from __future__ import annotations

import functools
import gzip
from pathlib import Path

from typer.testing import CliRunner, Result

from rovval import demo
from rovval.cli.app import app
from rovval.core.errors import RovvalError

SECONDS = 40


@functools.cache
def dive() -> str:
    """The first `SECONDS` of the sample dive as a Merlin log."""
    with gzip.open(demo.SAMPLE, "rt", encoding="utf-8") as sample:
        return "".join(line for line, _ in zip(sample, range(SECONDS * 10 + 1), strict=False))


def write_dive(folder: Path) -> Path:
    """That dive as dive.csv in ``folder``."""
    path = folder / "dive.csv"
    path.write_text(dive(), encoding="utf-8")
    return path


def run(*args: str, code: int = 0) -> Result:
    """What `rovval ...` printed; a refusal is raised as it is, any other exit code than ``code`` fails."""
    done = CliRunner().invoke(app, list(args))
    if isinstance(done.exception, RovvalError):
        raise done.exception
    assert done.exit_code == code, done.output
    return done
