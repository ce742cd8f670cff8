"""`rovval compare --between A B`: two platforms on one log or protocol, two simulations, or two runs, beside each other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from rovval.cli import complete, logs, output
from rovval.core.errors import UsageProblem

if TYPE_CHECKING:
    from rovval.comparison.between import Difference, Track
    from rovval.core.data import Run
    from rovval.vehicle.model import Vehicle

PROTOCOL = "the movement protocol (thesis, table 4.6)"


def difference(
    names: tuple[str, str], source: str | None, vehicle: str | None, effects: Sequence[str], how: logs.Reading, out: Path | None, as_json: bool, quiet: bool
) -> None:  # fmt: skip
    """B minus A on stdout; difference.json, .md and .html into ``out``, where it is given."""
    from rovval.comparison.between import between as subtract

    platforms = [name for name in names if name in complete.known("platform")]
    if not platforms and source is not None:
        raise UsageProblem(f"{source}: two files need no log", f"leave it out, or give platforms: {', '.join(complete.known('platform'))}")
    if source is not None and (source.endswith(".toml") or source in _missions()):
        a, b = (_flown(source, vehicle, name, effects) if name in platforms else _track(name, None, effects, how, quiet) for name in names)
        result, what = subtract(a, b), f"mission {source}"
        _told(result, what, out, as_json, quiet)
        return
    driven: tuple[Run, Vehicle] | None = _driven(source, vehicle, how, quiet) if platforms else None
    a, b = (_track(name, driven, effects, how, quiet) for name in names)
    result = subtract(a, b)
    what = "as recorded in the files" if driven is None else f"{driven[1].name}, {driven[0].source or PROTOCOL}"
    _told(result, what, out, as_json, quiet)


def _missions() -> tuple[str, ...]:
    """Missions that come with rovval: a CSV is a log here, whatever it might plan elsewhere."""
    from rovval.fly import mission

    return mission.names()


def _told(result: Difference, what: str, out: Path | None, as_json: bool, quiet: bool) -> None:
    """The difference on stdout, and in a folder where one is given."""
    from rovval.report import between as report
    from rovval.report.common.files import write_all

    if out is not None:
        import json

        files = {
            "difference.json": json.dumps(report.document(result, what), indent=2, allow_nan=False) + "\n",
            "difference.md": report.markdown(result, what), "difference.html": report.html(result, what),
        }  # fmt: skip
        output.say(output.places(write_all(out, files)), quiet)
    output.result_json(report.document(result, what)) if as_json else output.result(report.text(result, what))


def _driven(source: str | None, vehicle: str | None, how: logs.Reading, quiet: bool) -> tuple[Run, Vehicle]:
    """The run that drives platforms, and whose vehicle: a log's, or the movement protocol of any vehicle."""
    from rovval import vehicle as vehicles
    from rovval.pipeline.steps import vehicle_of

    if source is not None:
        run = logs.opened(source, how, quiet)
        return run, vehicle_of(run, vehicle)
    from rovval.fly.scenarios.movements import protocol
    from rovval.fly.scenarios.still_water import commanded

    loaded = vehicles.load(vehicle or "merlin")
    return replace(commanded(loaded, protocol(loaded), "movement-protocol"), source=""), loaded


def _flown(mission: str, vehicle: str | None, model: str, effects: Sequence[str]) -> Track:
    """The true motion of a mission that a platform flies."""
    from rovval import vehicle as vehicles
    from rovval.comparison.between import of_run
    from rovval.fly import fly
    from rovval.fly import mission as missions

    plan = missions.load(mission)
    return of_run(fly(plan, vehicles.load(vehicle or plan.vehicle or "merlin"), model, effects).run(truth=True), model)


def _track(name: str, driven: tuple[Run, Vehicle] | None, effects: Sequence[str], how: logs.Reading, quiet: bool) -> Track:
    """The motion that a name stands for: of a platform, of a simulation's file, or of a run."""
    from rovval.comparison.between import of_run, of_simulation
    from rovval.simulation.file import load_simulation

    if driven is not None and name in complete.known("platform"):
        from rovval.simulation import simulate

        return of_simulation(simulate(*driven, name, effects), name)
    if name.endswith(".parquet") and Path(name).is_file():
        return of_simulation(load_simulation(Path(name)), Path(name).stem)
    return of_run(logs.opened(name, replace(how, start=None, end=None), quiet), name)
