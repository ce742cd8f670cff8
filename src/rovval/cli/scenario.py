"""`rovval scenario`: the thesis's five test scenarios."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rovval.cli import complete, logs, options, output
from rovval.core.errors import UsageProblem

if TYPE_CHECKING:
    from rovval.core.data import Run
    from rovval.fly.scenarios import Outcome

NEED_A_LOG = (4, 5)
ALL = (1, 2, 3, 4, 5)
THESIS = ("fossen", "uuv")  # for its Simulink model and its ROS simulator


def command(
    number: Annotated[
        str, typer.Argument(metavar="1..5|all", help="1 stability, 2 thrusters, 3 movements, 4 log channels, 5 comparison.")
    ],
    source: Annotated[
        str | None,
        typer.Argument(
            metavar="[LOG|RUN]", help="For 4 and 5. Default: the sample log; of another vehicle the protocol flown with sensors.",
            autocompletion=complete.sources,
        ),
    ] = None,
    vehicle: options.VehicleOption = None,
    model: Annotated[
        options.Model | None,
        typer.Option("--model", help="Platform. Default: fossen, and in the document uuv beside it, as the thesis has two."),
    ] = None,
    rpm: Annotated[
        float | None,
        typer.Option("--rpm", min=0.0, help="Speed of the fastest thruster. Default: what 70 rpm is on Merlin, by the speed that holds 1 m/s."),
    ] = None,
    profile: options.ProfileOption = None,
    timezone: options.TimezoneOption = None,
    start: options.FromOption = None,
    end: options.ToOption = None,
    archive: options.ArchiveOption = Path("archive"),
    out: Annotated[Path | None, typer.Option("--out", metavar="DIR", help="Write the document with figures, and recordings.")] = None,
    json_: options.JsonFlag = False,
    quiet: options.QuietOption = False,
) -> None:
    """The test scenarios of the thesis (4.2 to 4.6), held against the results that it expects; exit 1 if one is not met.

    1: stability at zero rpm, and righting from a tilt. 2: each thruster up to speed and back. 3: surge, sway, heave and yaw, both ways, 30 s
    each with 30 s of rest. 4: the channels of a hardware log. 5: simulator beside vehicle. With --out one document has the
    thesis's figures 5.1 to 5.21 and tables 6.1 and 6.2 under their numbers, ours beside the printed.

    \b
    Example:
      rovval scenario 1
      rovval scenario 2 --vehicle bluerov2_heavy --model uuv
      rovval scenario 4 dive.csv --profile merlin
      rovval scenario all --out reports/thesis
    """
    numbers = _numbers(number)
    if source is None and (start is not None or end is not None):
        raise UsageProblem("--from and --to cut a log, and none was given", "give the log")
    if source is not None and not set(numbers) & set(NEED_A_LOG):
        raise UsageProblem(f"scenario {number} takes no log: it commands the thrusters itself", "leave the log out")
    judged = model.value if model else THESIS[0]
    models = (judged,) if model or out is None else THESIS
    run = _log(source, vehicle, rpm, logs.Reading(profile, archive, timezone, start, end), quiet) if set(numbers) & set(NEED_A_LOG) else None
    outcomes = {(n, m): _outcome(n, vehicle, m, rpm, run) for n in numbers for m in (("",) if n == 4 else (judged,) if n == 5 else models)}
    documents = [_document(outcome) for outcome in outcomes.values()]
    if out is not None:
        from rovval import vehicle as vehicles
        from rovval.report.scenario.document import write

        files = write(outcomes, vehicles.load(vehicle or "merlin"), out, {"schema": "rovval.scenarios/1", "scenarios": documents})
        output.say("Written:\n" + output.places(files), quiet)
    if json_:
        output.result_json(documents[0] if len(documents) == 1 else {"schema": "rovval.scenarios/1", "scenarios": documents})
    else:
        from rovval.report.scenario.terminal import text

        output.result("\n\n".join(text(outcome) for outcome in outcomes.values()))
    if not all(outcome.passed for outcome in outcomes.values()):
        raise typer.Exit(1)


def _numbers(number: str) -> tuple[int, ...]:
    if number == "all":
        return ALL
    if number in map(str, ALL):
        return (int(number),)
    raise UsageProblem(f"no scenario {number!r}", "give 1 to 5, or all")


def _log(source: str | None, vehicle: str | None, rpm: float | None, how: logs.Reading, quiet: bool) -> Run:
    """The log that was given; else the sample dive, which is Merlin's, or the same of another vehicle. Both are synthetic."""
    if source is not None:
        return logs.opened(source, how, quiet)
    from rovval import demo
    from rovval.fly.scenarios.stand_in import stand_in
    from rovval.vehicle import load

    sample, nominal = demo.sample(), load(vehicle or "merlin")
    return sample if nominal.name == sample.vehicle else stand_in(nominal, rpm)


def _outcome(number: int, vehicle: str | None, model: str, rpm: float | None, run: Run | None) -> Outcome:
    from rovval.fly.scenarios.hardware import hardware
    from rovval.fly.scenarios.movements import movements
    from rovval.fly.scenarios.performance import performance
    from rovval.fly.scenarios.stability import stability
    from rovval.fly.scenarios.thrusters import thrusters
    from rovval.pipeline.steps import vehicle_of
    from rovval.vehicle import load

    if number in NEED_A_LOG:
        assert run is not None
        return hardware(run) if number == 4 else performance(run, vehicle_of(run, vehicle), model)
    nominal = load(vehicle or "merlin")
    if number == 1:
        return stability(nominal, model)
    return (thrusters if number == 2 else movements)(nominal, model, rpm)


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
