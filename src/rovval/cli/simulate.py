"""`rovval simulate`: drive the simulator with a run's recorded thruster speeds."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rovval.cli import logs, options, output

if TYPE_CHECKING:
    from rovval.core.data import SimResult


def command(
    source: options.Source,
    vehicle: options.VehicleOption = None,
    model: options.ModelOption = options.Model.fossen,
    effect: options.EffectOption = None,
    window: options.WindowOption = 10.0,
    profile: options.ProfileOption = None,
    timezone: options.TimezoneOption = None,
    start: options.FromOption = None,
    end: options.ToOption = None,
    archive: options.ArchiveOption = Path("archive"),
    out: Annotated[
        Path | None, typer.Option("--out", metavar="FILE", help="Parquet file. Default: reports/RUN/MODEL.parquet.")
    ] = None,
    json_: options.JsonFlag = False,
    quiet: options.QuietOption = False,
) -> None:
    """Drive the simulator with the thruster speeds that the vehicle recorded, and keep the simulated motion.

    \b
    Example:
      rovval simulate dive.csv --profile merlin
      rovval simulate dive.csv --effect inflow_loss:loss=0.3 --out loss.parquet
    """
    from rovval.pipeline.steps import simulated, vehicle_of
    from rovval.simulation.file import save_simulation

    run = logs.opened(source, logs.Reading(profile, archive, timezone, start, end), quiet)
    nominal = vehicle_of(run, vehicle)
    run = logs.checked_against(run, nominal, quiet)
    sim = simulated(run, nominal, model.value, tuple(effect or ()), window)
    path = out or Path("reports") / run.id / f"{model.value}.parquet"
    save_simulation(sim, path)
    for line in (*sim.assumptions, *sim.stops):
        output.say(f"  {line}", quiet)
    summary = _summary(sim, path)
    if json_:
        output.result_json(summary)
    else:
        output.result("\n".join(f"{key:<12} {_plain(value)}" for key, value in summary.items() if key != "schema"))
    logs.refuse_stopped(sim)


def _summary(sim: SimResult, path: Path) -> dict[str, Any]:
    return {
        "schema": "rovval.simulation/1",
        "run": sim.run_id,
        "vehicle": sim.vehicle,
        "model": sim.model,
        "effects": list(sim.effects),
        "input": sim.input_source,
        "samples": len(sim.free.ok),
        "simulated": int(sim.free.ok.sum()),
        "windows": int(sim.windowed.stretch.max()) + 1,
        "window_s": sim.window_s,
        "assumptions": list(sim.assumptions),
        "stops": list(sim.stops),
        "file": str(path),
    }


def _plain(value: Any) -> str:
    return ("; ".join(value) or "none") if isinstance(value, list) else str(value)
