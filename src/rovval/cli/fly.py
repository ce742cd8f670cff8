"""`rovval fly`: a mission flown by planned speeds, the movement protocol, or controllers in the loop."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rovval.cli import complete, options, output
from rovval.core.errors import BadInput, SimulationStopped, UsageProblem

if TYPE_CHECKING:
    from rovval.fly.flight import Flight
    from rovval.fly.mission import Mission
    from rovval.vehicle.model import Vehicle


def command(
    mission: Annotated[
        str,
        typer.Argument(
            metavar="MISSION", autocompletion=complete.missions,
            help="A mission file, a CSV of t_s and each thruster's rpm, or a mission that comes with rovval: protocol, steps, survey, thrusters_singly.",
        ),
    ],
    vehicle: Annotated[
        str | None,
        typer.Option(
            "--vehicle", metavar="V", autocompletion=complete.vehicles, help="A name of `rovval list vehicle` or a TOML file. Default: the mission's."
        ),
    ] = None,
    model: options.ModelOption = options.Model.fossen,
    effect: options.EffectOption = None,
    noise: Annotated[
        float,
        typer.Option("--noise", metavar="FACTOR", min=0.0, help="Noise and bias of the mission's sensors times this; 0 closes the loop on the true state."),
    ] = 1.0,
    draws: Annotated[
        int,
        typer.Option("--draws", metavar="N", min=0, max=100_000, help="Fly so many vehicles within the file's tolerances beside it, and report the spread."),
    ] = 0,
    slop: Annotated[float, typer.Option("--calibration-slop", min=0.0, max=0.5, help="Relative tolerance of coefficients that draws are made with.")] = 0.05,
    seed: Annotated[int, typer.Option("--seed", min=0, help="Of noise and draws: equal seeds give equal flights.")] = 0,
    out: Annotated[Path | None, typer.Option("--out", metavar="RUN", help="Folder of the run. Default: archive/MISSION-VEHICLE-MODEL.")] = None,
    report_folder: Annotated[Path | None, typer.Option("--report", metavar="DIR", help="Report folder. Default: reports/RUN; none with --json.")] = None,
    dry: Annotated[
        bool, typer.Option("--dry-run", help="Print the timeline and what it would exceed; fly nothing. Exit 1 where it exceeds something.")
    ] = False,
    json_: options.JsonFlag = False,
    quiet: options.QuietOption = False,
) -> None:
    """Fly a mission: planned thruster speeds, the movement protocol, PID depth, heading and speed, way points; keep it as a run.

    The run is a log like any other: compare, diagnose, view and export work on it. With sensors in the loop it holds what the navigation filter says, and
    RUN-truth holds the true motion. docs/missions.md says how a mission is written. Exit 4 where the vehicle left sane limits.

    \b
    Example:
      rovval fly steps --vehicle bluerov2_heavy
      rovval fly survey --effect inflow_loss:loss=0.3 --out archive/survey
      rovval fly my_mission.toml --vehicle minerva --draws 1000
      rovval fly my_mission.toml --dry-run
      rovval fly speeds.csv --vehicle merlin
    """
    from rovval.fly import mission as missions
    from rovval.vehicle import load

    plan = missions.load(mission)
    if not (vehicle or plan.vehicle):
        raise UsageProblem(f"mission {plan.name} names no vehicle", "add --vehicle")
    nominal = load(vehicle or plan.vehicle)
    if dry:
        _dry_run(plan, nominal, json_)
        return
    from rovval import report
    from rovval.fly import fly
    from rovval.report.flight import json, terminal

    place = out or Path("archive") / f"{plan.name}-{nominal.name}-{model.value}"
    _refuse_replacing(place)
    flight = fly(
        plan, nominal, model.value, tuple(effect or ()), noise=noise, draws=draws, seed=seed, calibration_slop=slop, progress=output.progress(quiet)
    )
    written = _keep(flight, place)
    folder = report_folder or (None if json_ else Path("reports") / place.name)
    files = report.write_flight(flight, folder) if folder else {}
    if json_:
        output.result_json(json.document(flight) | {"run": str(place)})
    else:
        output.result(terminal.text(flight) + "\n\nWritten:\n" + "\n".join(f"  {p}" for p in written) + "\n" + output.places(files))
    if flight.stops:
        raise SimulationStopped(f"mission {plan.name}: {flight.stops[0]}; what came before is kept", "see the report; `--dry-run` says what would be exceeded")


def _dry_run(plan: Mission, vehicle: Vehicle, as_json: bool) -> None:
    """The timeline on stdout; exit 1 where something is exceeded."""
    from rovval.fly.dry_run import dry_run
    from rovval.report.flight import json, terminal

    dry = dry_run(plan, vehicle)
    if as_json:
        output.result_json(json.dry_run_document(dry))
    else:
        output.result(terminal.dry_run_text(dry))
    if dry.exceeds:
        raise typer.Exit(1)


def _refuse_replacing(place: Path) -> None:
    """A run that was measured is never replaced by one that was flown."""
    from rovval.storage.archive import load_run

    for there in (place, place.with_name(f"{place.name}-truth")):
        if there.exists():
            try:
                flown = "synthetic" in load_run(there, there.parent).properties
            except BadInput:
                flown = False
            if not flown:
                raise UsageProblem(f"{there}: is there already, and was not flown by rovval", "choose another --out")


def _keep(flight: Flight, place: Path) -> list[Path]:
    """The run into the archive that ``place`` lies in, and beside it the true motion where sensors closed the loop."""
    from rovval.storage.archive import save_run

    runs = [flight.run(place.name)] + ([flight.run(f"{place.name}-truth", truth=True)] if flight.on_sensors else [])
    return [save_run(run, place.parent, overwrite=True) for run in runs]
