"""Logs as the commands take them: read, and what was found in them said on stderr, so that no number stands alone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from rovval.cli import output
from rovval.core.errors import SimulationStopped, UsageProblem

if TYPE_CHECKING:
    from rovval.core.data import Run, SimResult
    from rovval.vehicle.model import Vehicle

MOST_FINDINGS = 6  # findings of a run in a terminal; the others stand in its report


@dataclass(frozen=True, slots=True)
class Reading:
    """How a command was asked to read its logs, by its options: ``start`` and ``end`` are seconds or markers."""

    profile: str | None = None
    archive: Path = Path("archive")
    timezone: str | None = None
    start: str | None = None
    end: str | None = None


def opened(source: str, how: Reading, quiet: bool = False) -> Run:
    """The run of a log file, folder or id, or the stretch of it that is asked for; its findings on stderr."""
    from rovval.alignment.stretch import stretch_of
    from rovval.storage.archive import open_run

    show = output.progress(quiet)
    try:
        run = stretch_of(open_run(source, how.profile, how.archive, how.timezone, show), how.start, how.end)
    finally:
        show("", 1.0)
    print_findings(run, quiet)
    return run


def with_pictures(source: str) -> Path | None:
    """The log file or folder at ``source``, of which a recording takes the pictures; None for a run of the archive, which has none."""
    return Path(source) if Path(source).exists() else None


def checked_against(run: Run, vehicle: Vehicle, quiet: bool = False) -> Run:
    """The run beside the vehicle's file: what it exceeds there is among its findings, and said on stderr."""
    from rovval.pipeline import steps

    beside = steps.checked_against(run, vehicle)
    for finding in beside.findings[len(run.findings) :]:
        output.say(f"{run.id}: {finding}", quiet)
    return beside


def refuse_stopped(sim: SimResult) -> None:
    """Raises `SimulationStopped` where the free run left sane limits: what could be simulated is written and printed by then."""
    if not sim.stops:
        return
    more = f" (and {len(sim.stops) - 1} more)" if len(sim.stops) > 1 else ""
    raise SimulationStopped(
        f"run {sim.run_id}: the simulation left sane limits: {sim.stops[0]}{more}; what came before is in the result",
        "check unit and scale of the thruster speeds, and that the vehicle is the log's own",
    )


def opened_as_one(sources: Sequence[str], vehicle: str | None, how: Reading, quiet: bool = False) -> list[Run]:
    """Runs that are one experiment: each given once, all of one vehicle unless ``vehicle`` says which, of each the same stretch. Raises
    `UsageProblem`."""
    from rovval.alignment.duplicates import duplicates

    runs = [opened(source, how, quiet) for source in sources]
    if twice := [f"{sources[later]} is given twice, as {sources[earlier]} already" for earlier, later in duplicates(runs)]:
        raise UsageProblem("; ".join(twice), "give each log once, by whatever name: a copy adds no evidence")
    named = {run.vehicle: source for run, source in zip(runs, sources, strict=True) if run.vehicle}
    if vehicle is None and len(named) > 1:
        raise UsageProblem(
            "logs of several vehicles: " + ", ".join(f"{source} is of {name}" for name, source in named.items()),
            "give the logs of one vehicle together, or say with --vehicle which vehicle all of them are of",
        )
    return runs


def print_findings(run: Run, quiet: bool = False) -> None:
    """What a reader of any result should know about this log, on stderr."""
    if not run.findings:
        return
    counted = f"{run.id}: {len(run.findings)} finding{'s'[: len(run.findings) > 1]} in this log"
    lines = [output.styled(counted, err=True, fg="yellow")]
    lines += [f"  {finding}" for finding in run.findings[:MOST_FINDINGS]]
    if (more := len(run.findings) - MOST_FINDINGS) > 0:
        lines.append(f"  and {more} more: `rovval ingest --json` and the report of `rovval compare` have all")
    output.say("\n".join(lines), quiet)
