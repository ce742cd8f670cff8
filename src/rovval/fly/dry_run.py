"""A mission before it is flown: its timeline, and what it would exceed, by statics alone."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from rovval.core.channels import AXES
from rovval.core.counts import counted
from rovval.core.data import Array
from rovval.fly.loop.allocation import Thrusters, thrusters_of
from rovval.fly.loop.controllers import axis_of, strongest
from rovval.fly.mission import Hold, Mission, Protocol, Singly, Speeds, WayPoints
from rovval.fly.plan import DT, Phase, lay_out
from rovval.vehicle.audit import uncontrolled_axes
from rovval.vehicle.model import Vehicle

WORDS = {
    "depth_m": "depth {} m", "altitude_m": "altitude {} m", "heading_deg": "heading {} deg", "speed_m_s": "{} m/s ahead", "sway_m_s": "{} m/s to starboard",
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Entry:
    """One phase: when it begins and ends, s, what it does, and what it would exceed."""

    start_s: float
    end_s: float
    label: str
    does: str
    exceeds: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class DryRun:
    """The timeline of a mission on a vehicle, and what is known of neither."""

    mission: str
    vehicle: str
    entries: tuple[Entry, ...]

    @property
    def duration_s(self) -> float:
        """How long the mission takes."""
        return self.entries[-1].end_s

    @property
    def exceeds(self) -> tuple[str, ...]:
        """All that it would exceed, with the phase."""
        return tuple(f"{e.label}: {problem}" for e in self.entries for problem in e.exceeds)


def dry_run(mission: Mission, vehicle: Vehicle) -> DryRun:
    """What a mission would do, when, and what of it the vehicle or the water does not allow.

    Steady forces alone are reckoned: the drag at the speeds that are asked for against the greatest thrust along that axis, thruster speeds against their
    limits, depths against surface and bottom, the length of a way against its time.

    Raises UsageProblem as `rovval.fly.fly` does.
    """
    thrusters = thrusters_of(vehicle, mission.limits)
    at, entries = (mission.start.north_m, mission.start.east_m, mission.start.depth_m), []
    for phase in lay_out(mission, vehicle, thrusters):
        problems = (*_thruster_speeds(phase, thrusters), *_set_points(phase, mission, vehicle, thrusters), *_way(phase, at, mission, vehicle))
        entries.append(Entry(phase.start_s, phase.end_s, phase.label, _does(phase), problems))
        at = phase.leg.points[-1] if isinstance(phase.leg, WayPoints) else at
    return DryRun(mission.name, vehicle.name, tuple(entries))


def _does(phase: Phase) -> str:
    match phase.leg:
        case Hold() as leg:
            given = {name: getattr(leg, name) for name in WORDS if getattr(leg, name) is not None}
            return ", ".join(WORDS[name].format(f"{value:g}") for name, value in given.items())
        case WayPoints() as leg:
            return f"{counted(len(leg.points), 'point')} at {leg.speed_m_s:g} m/s"
        case Speeds() | Protocol() | Singly():
            fastest = 0.0 if phase.speed is None else float(np.abs(phase.speed).max()) * 60.0
            return f"thrusters at up to {fastest:.4g} rpm" + (f", {' and '.join(phase.hold)} held" if phase.hold else "")


def _thruster_speeds(phase: Phase, thrusters: Thrusters) -> Iterator[str]:
    """Planned speeds beyond the thrusters' limits, and changes of them."""
    if phase.speed is None:
        return
    most = np.abs(phase.speed).max(axis=0)
    change = np.abs(np.diff(phase.speed, axis=0)).max(axis=0, initial=0.0) / DT
    for name, top, limit, quick in zip(thrusters.names, most, thrusters.limit, change, strict=True):
        if top > limit:
            yield f"{name} at {60 * top:.4g} rpm, limit {60 * limit:.4g} rpm"
        if quick > thrusters.rate:
            yield f"{name} changes by {60 * quick:.4g} rpm/s, limit {60 * thrusters.rate:.4g} rpm/s"


def _set_points(phase: Phase, mission: Mission, vehicle: Vehicle, thrusters: Thrusters) -> Iterator[str]:
    """Speeds beyond the thrust, depths beyond surface and bottom, axes that cannot be pushed."""
    leg = phase.leg
    if isinstance(leg, Hold):
        needs = {"heave": leg.depth_m if leg.altitude_m is None else leg.altitude_m, "yaw": leg.heading_deg, "surge": leg.speed_m_s, "sway": leg.sway_m_s}
        speeds = {"surge": leg.speed_m_s or 0.0, "sway": leg.sway_m_s or 0.0}
        depths = [leg.depth_m] if leg.depth_m is not None else []
        if leg.altitude_m is not None:
            if mission.water.bottom_m is None:
                yield "an altitude is held, and the mission has no bottom: give [water] bottom_m"
            else:
                depths = [mission.water.bottom_m - leg.altitude_m]
    elif isinstance(leg, WayPoints):
        needs, speeds, depths = {"heave": 0.0, "yaw": 0.0, "surge": 0.0}, {"surge": leg.speed_m_s}, [p[2] for p in leg.points]
    else:
        return
    for axis, value in needs.items():
        if value is not None and axis in uncontrolled_axes(vehicle):
            yield f"{axis} cannot be pushed alone by the thrusters of {vehicle.name}"
    for axis, speed in speeds.items():
        force, there = float(axis_of(vehicle, axis).drag(np.array(abs(speed)))), strongest(thrusters, axis)
        if force > there and AXES[AXES.index(axis)] not in uncontrolled_axes(vehicle):
            yield f"{abs(speed):g} m/s in {axis} takes {force:.4g} N, the thrusters give {there:.4g} N"
    half = 0.5 * vehicle.body.size[2]
    for depth in depths:
        if mission.water.surface and depth < half:
            yield f"depth {depth:g} m is at the surface: the hull is {half:g} m high above its middle"
        if mission.water.bottom_m is not None and depth > mission.water.bottom_m - half:
            yield f"depth {depth:g} m touches the bottom at {mission.water.bottom_m:g} m: the hull is {half:g} m deep below its middle"


def _way(phase: Phase, at: tuple[float, float, float], mission: Mission, vehicle: Vehicle) -> Iterator[str]:
    """A way that is longer than its time."""
    if isinstance(phase.leg, WayPoints):
        path: Array = np.array([at, *phase.leg.points])
        length = float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())
        if (least := length / phase.leg.speed_m_s) > phase.leg.for_s:
            yield f"{length:.4g} m at {phase.leg.speed_m_s:g} m/s take {least:.4g} s without a turn, the leg has {phase.leg.for_s:g} s"
