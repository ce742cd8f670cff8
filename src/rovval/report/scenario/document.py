"""The scenarios as one document that a reader of the thesis follows: its checks, its figures in its order, its tables beside ours."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

from rovval.comparison.between import between, of_simulation
from rovval.core.data import Comparison
from rovval.fly.scenarios import Outcome
from rovval.fly.scenarios.table_6_1 import CIRCULAR, refusals, rows
from rovval.plant import platforms
from rovval.report import between as difference
from rovval.report.common.files import Writer, write_all
from rovval.report.common.markdown import bullets, grid
from rovval.report.common.numbers import number
from rovval.report.common.page import render
from rovval.report.common.versions import foot
from rovval.report.drawings.drawing import Drawing
from rovval.report.scenario.figures import FIGURES, ROS, SIMULINK
from rovval.report.scenario.terminal import SIGNS
from rovval.vehicle.model import Vehicle

Outcomes = Mapping[tuple[int, str], Outcome]  # by scenario and platform
TABLE_6_2 = {  # thesis table 6.2: error (m/s, deg/s) and integral absolute error (m, deg), hardware against simulator
    "surge": (-0.096, 22.94), "sway": (0.078, 13.92), "heave": (-0.006, 10.76), "roll": (-0.299, 65.41), "pitch": (-0.32, 63.59), "yaw": (-2.01, 487.1),
}  # fmt: skip
EXPECTED = {
    1: "Tables 4.1 and 4.2: thrust and velocity must be zero at zero rpm. Section 6.2: velocities almost zero, sinks gradually, does not tip over.",
    2: "Tables 4.3 and 4.4: thrust varies with the thruster's speed, and the vehicle starts to move accordingly.",
    3: "Tables 4.5 and 4.6: 30 s of each movement, 30 s of rest; nothing in particular is expected. Section 6.4 says which thrusters push which way.",
    4: "Section 4.5: 10 Hz, set-point and feedback of seven thrusters, position, attitude, velocity, acceleration.",
    5: "Table 4.7: velocities of simulator and vehicle under the same thruster speeds; nothing in particular is expected.",
}


@dataclass(frozen=True, slots=True)
class Table:
    """A table: its ``title``, a heading a column, rows of words, and what is to be known of it."""

    title: str
    header: Sequence[str]
    rows: Sequence[Sequence[str]]
    notes: Sequence[str]


@dataclass(frozen=True, slots=True)
class Drawn:
    """A figure as drawn: its number and caption in the thesis, what ours is of, why it looks otherwise, and the drawings."""

    number: str
    caption: str
    of: str
    reason: str
    drawings: Sequence[Drawing]


def write(outcomes: Outcomes, vehicle: Vehicle, folder: Path, document: Mapping[str, Any]) -> Mapping[str, Path]:
    """scenarios.html, scenarios.md and scenarios.json into ``folder``, and a recording of each motion; name -> path."""
    import json

    files: dict[str, str | Writer] = {
        "scenarios.html": html(outcomes, vehicle), "scenarios.md": markdown(outcomes, vehicle),
        "scenarios.json": json.dumps(document, indent=2, allow_nan=False) + "\n",
    }  # fmt: skip
    for (scenario, model), outcome in outcomes.items():
        for name, one in (("", outcome), ("-closed", replace(outcome, motion=outcome.closed))):
            if (comparison := recorded(one)) is not None and (not name or outcome.closed is not None):
                files[f"scenario-{scenario}-{model}{name}.rrd"] = partial(_record, comparison, vehicle)
    return write_all(folder, files)


def _record(comparison: Comparison, vehicle: Vehicle, path: Path) -> None:
    from rovval.report.recording import write as recording

    recording.write(comparison, path, vehicle)


def recorded(outcome: Outcome) -> Comparison | None:
    """What a recording shows of a scenario: its comparison, or its motion beside nothing that was measured."""
    from rovval.core.channels import AXES
    from rovval.fly.scenarios.still_water import unmeasured

    if outcome.comparison is not None or outcome.motion is None:
        return outcome.comparison
    return Comparison(unmeasured(outcome.motion), outcome.motion, {}, {}, {}, AXES)


def figures(outcomes: Outcomes, vehicle: Vehicle) -> list[Drawn]:
    """The thesis's figures for which there is a scenario, in its order; where its platform was not asked for, the one that was."""
    found = []
    for figure in FIGURES:
        here = {model: o for (n, model), o in outcomes.items() if n == figure.scenario}
        if not here:
            continue
        model = figure.platform if figure.platform in here else next(iter(here))
        if drawings := figure.draw(here[model], vehicle):
            of = f"{vehicle.name}, {model}" if model else "the log"
            found.append(Drawn(figure.number, figure.caption, of, figure.reason, drawings))
    return found


def tables(outcomes: Outcomes, vehicle: Vehicle) -> list[Table]:
    """Table 6.1 and its claim of 10 %, 6.3's "similar", and table 6.2, each beside ours, as far as the scenarios are there."""
    found = [_table_6_1(vehicle)] if any(n == 2 for n, _ in outcomes) else []
    for scenario, claim in ((2, "6.3: velocities are \"similar and consistent\""), (3, "6.1: \"a 10% variation in ROV dynamics\"")):
        pair = [outcomes.get((scenario, model)) for model in (SIMULINK, ROS)]
        if all(o is not None and o.motion is not None for o in pair):
            found.append(_claim(scenario, claim, *(o.motion for o in pair if o is not None)))
    found += [_table_6_2(o) for (n, model), o in outcomes.items() if n == 5 and model in (SIMULINK, "")]
    return found


def _table_6_1(vehicle: Vehicle) -> Table:
    names = platforms.names()
    header = ("thruster", "printed MATLAB", "printed ROS", "ROS over MATLAB", *names, "uuv over fossen")
    lines = []
    for row in rows(vehicle):
        printed = "-" if row.matlab is None or row.ros is None else f"{100 * (row.ros / row.matlab - 1):+.1f} %"
        ours = [f"{row.ours[name]:.1f}" if name in row.ours else "-" for name in names]
        both = f"{100 * (row.ours['uuv'] / row.ours['fossen'] - 1):+.1f} %" if {"uuv", "fossen"} <= row.ours.keys() else "-"
        lines.append((row.thruster, *("-" if v is None else f"{v:.1f}" for v in (row.matlab, row.ros)), printed, *ours, both))
    circular = [f"Circular for Merlin: {model}'s gains are the printed {column} column." for model, column in CIRCULAR.items()]
    notes = (
        *circular, "What is not: that thrust read off the motion gives them back (masses, allocation), and how far the columns are apart.",
        "Printed as Nm, read as N.",
    )  # fmt: skip
    refused = [f"{model} cannot simulate this vehicle: {why}." for model, why in refusals(vehicle).items()]
    return Table("Table 6.1: thrust at 70 rpm, N", header, lines, notes if vehicle.name == "merlin" else ("The printed columns are Merlin's.", *refused))


def _claim(scenario: int, claim: str, a: Any, b: Any) -> Table:
    d = between(of_simulation(a, SIMULINK), of_simulation(b, ROS))
    title = f"Section {claim}: {ROS} minus {SIMULINK} in scenario {scenario}"
    return Table(title, difference.HEAD, difference.lines(d), (difference.said(d), difference.FOOT))


def _table_6_2(outcome: Outcome) -> Table:
    ours = outcome.document["table_6_2"]
    lines = []
    for axis, (error, iae) in TABLE_6_2.items():
        row = ours.get(axis)
        units = ("deg/s", "deg") if axis in ("roll", "pitch", "yaw") else ("m/s", "m")
        seen = ("not measured", "") if row is None else (f"{row['mean_error']:+.3g} {units[0]}", f"{number(row['iae'])} {units[1]}")
        lines.append((axis, f"{error:+g} {units[0]}", f"{iae:g} {units[1]}", *seen))
    notes = ("The thesis's log is not public: its figures cannot be recomputed. Ours are of another log, of another length: an IAE grows with it.",
             "The thesis does not say which way its error is taken, nor its units; ours is simulated minus measured.")  # fmt: skip
    header = ("axis", "printed error", "printed IAE", "our mean error", "our IAE")
    return Table(f"Table 6.2: error of the simulator, ours on {outcome.document['run']}", header, lines, notes)


def markdown(outcomes: Outcomes, vehicle: Vehicle) -> str:
    """The checks and tables, and where to find the figures."""
    parts = [f"# The thesis's scenarios, {vehicle.name}", f"Platforms: {_platforms(outcomes)}."]
    for (scenario, model), outcome in outcomes.items():
        parts += [f"## Scenario {scenario}: {outcome.title}{f', {model}' if model else ''}", EXPECTED[scenario]]
        parts.append(grid(("", "expected", "seen"), [(SIGNS[c.holds], c.expected, c.seen) for c in outcome.checks], 3))
    for table in tables(outcomes, vehicle):
        parts += [f"## {table.title}", grid(table.header, table.rows, 1), bullets(table.notes)]
    drawn = [(f.number, f.caption, f.of, f.reason or "as in the thesis") for f in figures(outcomes, vehicle)]
    parts += ["## Figures", "Drawn in scenarios.html beside this file.", grid(("figure", "the thesis's caption", "ours is of", "why ours differs"), drawn, 4)]
    return "\n\n".join(parts) + "\n"


def _platforms(outcomes: Outcomes) -> str:
    """Which platform stands for which of the thesis's two; where one was asked for, it stands for both."""
    asked = {model for _, model in outcomes if model}
    if len(asked) == 1:
        return f"{asked.pop()} alone, for both of the thesis's (without --model: {SIMULINK} for its Simulink model, {ROS} for its ROS simulator)"
    return f"{SIMULINK} for the thesis's Simulink model, {ROS} for its ROS simulator"


def html(outcomes: Outcomes, vehicle: Vehicle) -> str:
    """One page: what was checked, then figure by figure and table by table."""
    failed = [f"{o.title} ({model})" for (_, model), o in outcomes.items() if not o.passed]
    judged = [c for o in outcomes.values() for c in o.checks if c.holds is not None]
    said = [f"{sum(bool(c.holds) for c in judged)} of {len(judged)} expectations hold." + (f" Not met: {', '.join(failed)}." if failed else "")]
    return render(
        "scenarios.html", title=f"{vehicle.name} · the thesis's scenarios", eyebrow="The thesis's test scenarios", name=vehicle.name, banner="",
        said=[*said, "Figures and tables have the thesis's order and numbers, each from our own simulation, with the reason where it must differ."],
        facts={"platforms": _platforms(outcomes)}, outcomes=[
            {"number": n, "model": model, "title": o.title, "expected": EXPECTED[n], "checks": [(SIGNS[c.holds], c.expected, c.seen) for c in o.checks]}
            for (n, model), o in outcomes.items()
        ], figures=figures(outcomes, vehicle), tables=tables(outcomes, vehicle), footer=foot(),
    )  # fmt: skip
