"""A mission laid out in time: which leg holds from when to when, and the thruster speeds that are planned beforehand."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rovval.core.channels import AXES
from rovval.core.counts import counted
from rovval.core.data import RATE_HZ, Array
from rovval.core.errors import UsageProblem, all_at_once
from rovval.effects.lanes import reference_speed
from rovval.fly.loop.allocation import Thrusters
from rovval.fly.mission import Hold, Leg, Mission, Protocol, Singly, Speeds, WayPoints
from rovval.vehicle.model import Vehicle

DT = 1.0 / RATE_HZ


@dataclass(frozen=True, slots=True)
class Phase:
    """Samples ``first`` to ``last`` (exclusive) of the mission, told by ``leg``.

    ``speed`` (last - first, k) rev/s where it is planned. ``push`` says which axis a protocol moves in open loop (and ``speed`` has the thrusters for
    it), ``hold`` what the autopilot keeps meanwhile.
    """

    first: int
    last: int
    leg: Leg
    label: str
    speed: Array | None = None
    push: str = ""
    hold: tuple[str, ...] = ()

    @property
    def start_s(self) -> float:
        """When it begins, s."""
        return self.first * DT

    @property
    def end_s(self) -> float:
        """When it ends, s."""
        return self.last * DT


def lay_out(mission: Mission, vehicle: Vehicle, thrusters: Thrusters) -> tuple[Phase, ...]:
    """The phases of a mission, one after the other. Raises UsageProblem where a table of speeds is missing or wrong, or an axis cannot be moved."""
    phases: list[Phase] = []
    for number, leg in enumerate(mission.leg, 1):
        first = phases[-1].last if phases else 0
        match leg:
            case Speeds():
                planned = read_speeds(mission.folder / leg.file, vehicle)
                phases.append(Phase(first, first + len(planned), leg, f"{counted(number, 'speed')} of {Path(leg.file).name}", planned))
            case Protocol():
                phases += _protocol(number, leg, first, thrusters)
            case Singly():
                phases += _singly(number, leg, first, vehicle)
            case Hold() | WayPoints():
                what = "way points" if isinstance(leg, WayPoints) else "hold"
                phases.append(Phase(first, first + max(1, round(leg.for_s / DT)), leg, f"{number} {what}"))
    return tuple(phases)


def _protocol(number: int, leg: Protocol, first: int, thrusters: Thrusters) -> list[Phase]:
    """Two phases, a movement and a pause, for each axis and way."""
    phases: list[Phase] = []
    for axis in leg.axes:
        for sign, way in ((1, "+"), (-1, "-")):
            speed = _pattern(leg, axis, sign, thrusters)
            kept = tuple(h for h in leg.hold if {"depth": "heave", "heading": "yaw"}[h] != axis)
            for seconds, label, row, push in ((leg.move_s, f"{axis} {way}", speed, axis), (leg.rest_s, "rest", 0.0 * speed, "rest")):
                if samples := round(seconds / DT):
                    begin = phases[-1].last if phases else first
                    phases.append(Phase(begin, begin + samples, leg, f"{number} {label}", np.tile(row, (samples, 1)), push, kept))
    return phases


def _singly(number: int, leg: Singly, first: int, vehicle: Vehicle) -> list[Phase]:
    """Two phases, a push and a pause, for each thruster and way."""
    top = leg.rpm / 60.0 if leg.rpm is not None else leg.speed_m_s * reference_speed(vehicle)  # drag and thrust both grow with the square
    phases: list[Phase] = []
    for j, name in enumerate(vehicle.thrusters):
        for sign, way in ((1.0, "ahead"), (-1.0, "astern")):
            row = np.zeros(len(vehicle.thrusters))
            row[j] = sign * top
            for seconds, label, speed in ((leg.push_s, f"{name} {way}", row), (leg.rest_s, "rest", 0.0 * row)):
                if samples := round(seconds / DT):
                    begin = phases[-1].last if phases else first
                    phases.append(Phase(begin, begin + samples, leg, f"{number} {label}", np.tile(speed, (samples, 1))))
    return phases


def _pattern(leg: Protocol, axis: str, sign: int, thrusters: Thrusters) -> Array:
    """Speeds (k,) rev/s that push along one axis, the fastest of them as fast as the leg says."""
    thrusters.refuse_uncontrolled([axis], "the movement protocol")
    wrench = np.zeros((1, 6))
    wrench[0, AXES.index(axis)] = float(sign)
    speed = thrusters.speed_of(thrusters.share(wrench))[0]
    if leg.rpm is None and not np.isfinite(thrusters.limit).all():
        raise UsageProblem(
            "the movement protocol runs at a share of the thrusters' greatest speed, and that is not known",
            "give the leg's rpm, or [limits] rpm, or rpm_max in the vehicle's file",
        )
    top = leg.rpm / 60.0 if leg.rpm is not None else leg.share * float(thrusters.limit.min())
    return np.asarray(speed * top / np.abs(speed).max())


def read_speeds(path: Path, vehicle: Vehicle) -> Array:
    """Planned thruster speeds (n, k) rev/s at 10 Hz of a CSV with ``t_s`` and a column in rpm for each thruster that turns.

    Raises UsageProblem: no such file, unknown columns, cells that are no numbers, times that do not grow; all at once.
    """
    try:
        with path.open(newline="", encoding="utf-8-sig") as file:
            rows = [row for row in csv.reader(file) if row]
    except (OSError, UnicodeDecodeError) as error:
        raise UsageProblem(f"{path}: cannot be read: {error}", "name a CSV beside the mission file") from None
    header = [cell.strip() for cell in rows[0]] if rows else []
    problems = [f"no column {'t_s'!r}"] if "t_s" not in header else []
    problems += [f"column {n!r} is no thruster of {vehicle.name} ({', '.join(vehicle.thrusters)})" for n in header if n not in ("t_s", *vehicle.thrusters)]
    problems += [f"column {n!r} stands there twice" for n in dict.fromkeys(header) if header.count(n) > 1]
    table = _numbers(rows[1:], len(header), problems)
    if problems:
        raise UsageProblem(all_at_once(problems, str(path)), "the first line names t_s and thrusters; speeds are in rpm")
    t = table[:, header.index("t_s")]
    if len(t) < 2 or t[0] != 0.0 or (np.diff(t) <= 0).any():
        raise UsageProblem(f"{path}: t_s must begin at 0 and grow, over two rows at least", "mend the column")
    grid = np.arange(round(t[-1] / DT) + 1) * DT
    columns = [np.interp(grid, t, table[:, header.index(n)]) / 60.0 if n in header else np.zeros(len(grid)) for n in vehicle.thrusters]
    return np.stack(columns, axis=1)


def _numbers(rows: Sequence[Sequence[str]], width: int, problems: list[str]) -> Array:
    """The cells as numbers; what is none is added to ``problems`` with its row."""
    table = np.zeros((len(rows), width))
    for i, row in enumerate(rows):
        if len(row) != width:
            problems.append(f"line {i + 2} has {len(row)} cells, the header {width}")
            continue
        for j, cell in enumerate(row):
            try:
                table[i, j] = float(cell)
            except ValueError:
                problems.append(f"line {i + 2}: {cell!r} is not a number")
    if not np.isfinite(table).all():
        problems.append("a cell is not finite")
    return table
