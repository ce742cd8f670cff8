"""`rovval scenario`: the thesis's five test scenarios."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rovval.cli import complete, logs, options, output
from rovval.core.errors import UsageProblem

if TYPE_CHECKING:
    from rovval.fly.scenarios import Outcome

NEED_A_LOG = (4, 5)


def command(
    number: Annotated[
        int,
        typer.Argument(
            metavar="1..5", min=1, max=5, help="1 stability, 2 thrusters, 3 movements, 4 log channels, 5 comparison."
        ),
    ],
    source: Annotated[
        str | None,
        typer.Argument(metavar="[LOG|RUN]", help="For 4 and 5. Default: the sample log.", autocompletion=complete.sources),
    ] = None,
    vehicle: options.VehicleOption = None,
    model: options.ModelOption = options.Model.fossen,
    profile: options.ProfileOption = None,
    start_s: options.FromOption = None,
    end_s: options.ToOption = None,
    archive: options.ArchiveOption = Path("archive"),
    json_: options.JsonFlag = False,
) -> None:
    """The test scenarios of the thesis (4.2 to 4.6), held against the results that it expects; exit 1 if one is not met.

    1: stability at zero rpm. 2: each thruster from 0 to 70 rpm and back. 3: surge, sway, heave and yaw, both ways, 30 s each
    with 30 s of rest. 4: the channels of a hardware log. 5: simulator beside vehicle.

    \b
    Example:
      rovval scenario 1
      rovval scenario 2 --vehicle bluerov2_heavy --model freefloating
      rovval scenario 4 dive.csv --profile merlin
    """
    if source is None and (start_s is not None or end_s is not None):
        raise UsageProblem("--from and --to cut a log, and none was given", "give the log")
    if source is not None and number not in NEED_A_LOG:
        raise UsageProblem(f"scenario {number} takes no log: it commands the thrusters itself", "leave the log out")
    outcome = (
        _with_log(number, source, vehicle, model.value, profile, archive, (start_s, end_s))
        if number in NEED_A_LOG
        else _alone(number, vehicle, model.value)
    )
    if json_:
        output.result_json(_document(outcome))
    else:
        from rovval.report.scenario import text

        output.result(text(outcome))
    if not outcome.passed:
        raise typer.Exit(1)


def _alone(number: int, vehicle: str | None, model: str) -> Outcome:
    from rovval.fly.scenarios.movements import movements
    from rovval.fly.scenarios.stability import stability
    from rovval.fly.scenarios.thrusters import thrusters
    from rovval.vehicle import load

    return {1: stability, 2: thrusters, 3: movements}[number](load(vehicle or "merlin"), model)


def _with_log(
    number: int, source: str | None, vehicle: str | None, model: str, profile: str | None, archive: Path, between: tuple[float | None, float | None]
) -> Outcome:
    from rovval import demo
    from rovval.pipeline.steps import vehicle_of

    run = demo.sample() if source is None else logs.opened(source, profile, archive, False, *between)
    if number == 4:
        from rovval.fly.scenarios.hardware import hardware

        return hardware(run)
    from rovval.fly.scenarios.performance import performance

    return performance(run, vehicle_of(run, vehicle), model)


def _document(outcome: Outcome) -> dict[str, Any]:
    return {
        "schema": "rovval.scenario/1",
        "scenario": outcome.number,
        "title": outcome.title,
        "vehicle": outcome.vehicle,
        "model": outcome.model,
        "passed": outcome.passed,
        "checks": [{"expected": c.expected, "seen": c.seen, "holds": c.holds} for c in outcome.checks],
        **outcome.document,
    }
