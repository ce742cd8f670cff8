"""The thesis's figures 5.1 to 5.21, drawn from our own scenarios: which one shows what, of which scenario, on which platform."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from rovval.core.channels import AXES, VELOCITIES, members
from rovval.core.data import Array, Comparison, Run, SimResult
from rovval.core.units import DEGREES
from rovval.fly.mission import WayPoints
from rovval.fly.scenarios import Outcome
from rovval.fly.scenarios.way_points import square
from rovval.report.drawings.chart import chart, path
from rovval.report.drawings.drawing import Drawing
from rovval.vehicle.model import Vehicle, allocation

ROS, SIMULINK = "uuv", "fossen"  # platforms that stand for the thesis's two
Drawn = Callable[[Outcome, Vehicle], list[Drawing]]


@dataclass(frozen=True, slots=True)
class Figure:
    """One figure of the thesis: its ``number`` and ``caption`` there, the ``scenario`` and ``platform`` ("" for either) that it is drawn from, and
    the ``reason`` why ours looks otherwise."""

    number: str
    caption: str
    scenario: int
    platform: str
    draw: Drawn
    reason: str = ""


def _sim(outcome: Outcome) -> SimResult:
    assert outcome.motion is not None
    return outcome.motion


def velocity(outcome: Outcome, vehicle: Vehicle) -> list[Drawing]:
    """Linear and angular velocity in the body frame."""
    sim = _sim(outcome)
    linear = {name: sim.free.nu[:, j] for j, name in enumerate(VELOCITIES[:3])}
    angular = {name: sim.free.nu[:, 3 + j] * DEGREES for j, name in enumerate(VELOCITIES[3:])}
    return [chart("velocity", "m/s", sim.dt, linear), chart("angular velocity", "deg/s", sim.dt, angular)]


def inputs(outcome: Outcome, vehicle: Vehicle) -> list[Drawing]:
    """Commanded speed of each thruster."""
    sim = _sim(outcome)
    return [chart("commanded speed", "rpm", sim.dt, {name: sim.thruster_speed[:, j] * 60.0 for j, name in enumerate(sim.thrusters)})]


def response(outcome: Outcome, vehicle: Vehicle) -> list[Drawing]:
    """Speed in and thrust out of each thruster."""
    sim = _sim(outcome)
    return [*inputs(outcome, vehicle), chart("thrust", "N", sim.dt, {name: sim.thrust[:, j] for j, name in enumerate(sim.thrusters)})]


def forces(outcome: Outcome, vehicle: Vehicle) -> list[Drawing]:
    """Force and moment of all thrusters on the six axes."""
    sim = _sim(outcome)
    wrench = sim.thrust @ allocation(vehicle).T
    return [
        chart("force of the thrusters", "N", sim.dt, {axis: wrench[:, j] for j, axis in enumerate(AXES[:3])}),
        chart("moment of the thrusters", "N m", sim.dt, {axis: wrench[:, 3 + j] for j, axis in enumerate(AXES[3:])}),
    ]


def of_thrusters(angular: bool) -> Drawn:
    """Speed of each thruster's place through the world, or the turn that all of them share."""

    def draw(outcome: Outcome, vehicle: Vehicle) -> list[Drawing]:
        sim = _sim(outcome)
        nu = sim.free.nu
        if angular:
            return [chart("angular velocity of every thruster", "deg/s", sim.dt, {n: nu[:, 3 + j] * DEGREES for j, n in enumerate(VELOCITIES[3:])})]
        speed = {t.name: np.linalg.norm(nu[:, :3] + np.cross(nu[:, 3:], np.array(t.position)), axis=1) for t in vehicle.thruster}
        return [chart("speed of each thruster's place", "m/s", sim.dt, speed)]

    return draw


def thruster_pair(*numbers: int) -> Drawn:
    """Speed in and thrust out of some thrusters, by their place in the file."""

    def draw(outcome: Outcome, vehicle: Vehicle) -> list[Drawing]:
        sim = _sim(outcome)
        some = [(j, f"T{j} {sim.thrusters[j]}") for j in numbers if j < len(sim.thrusters)]
        if not some:
            return []
        speed = chart("input", "rpm", sim.dt, {name: sim.thruster_speed[:, j] * 60.0 for j, name in some})
        return [speed, chart("output", "N", sim.dt, {name: sim.thrust[:, j] for j, name in some})]

    return draw


def position(outcome: Outcome, vehicle: Vehicle) -> list[Drawing]:
    """Place and attitude in the world."""
    sim = _sim(outcome)
    eta = sim.free.eta
    turned = np.column_stack([eta[:, 3:5], np.unwrap(eta[:, 5])]) * DEGREES  # a heading that passes south is no leap
    return [
        chart("position", "m", sim.dt, {name: eta[:, j] for j, name in enumerate(("north", "east", "down"))}),
        chart("attitude", "deg", sim.dt, {name: turned[:, j] for j, name in enumerate(("roll", "pitch", "heading"))}),
    ]


def way(outcome: Outcome, vehicle: Vehicle) -> list[Drawing]:
    """The path in three dimensions, and the way points."""
    [leg] = square(vehicle).leg
    assert isinstance(leg, WayPoints)
    return [path("path", _sim(outcome).free.eta[:, :3], np.array(leg.points))]


def closed(draw: Drawn) -> Drawn:
    """The same of the motion in closed loop."""

    def drawn(outcome: Outcome, vehicle: Vehicle) -> list[Drawing]:
        return draw(replace(outcome, motion=outcome.closed), vehicle) if outcome.closed else []

    return drawn


def setpoint_and_feedback(outcome: Outcome, vehicle: Vehicle) -> list[Drawing]:
    """Each thruster's set-point and measured speed, where the log has them."""
    run = outcome.run
    assert isinstance(run, Run)
    drawings = []
    for name in members(tuple(run.values), "n"):
        curves: dict[str, Array] = {label: run.get(f"{kind}:{name}") * 60.0 for label, kind in (("set-point", "n_cmd"), ("feedback", "n"))
                                    if run.measured(f"{kind}:{name}")}  # fmt: skip
        drawings += [chart(name, "rpm", run.dt, curves)] if curves else []
    return drawings


def performance(outcome: Outcome, vehicle: Vehicle) -> list[Drawing]:
    """Measured and simulated velocity of each measured axis."""
    c = outcome.comparison
    assert isinstance(c, Comparison)
    drawings = []
    for j, (axis, name) in enumerate(zip(AXES, VELOCITIES, strict=True)):
        if axis not in c.not_measured:
            factor, unit = (DEGREES, "deg/s") if j > 2 else (1.0, "m/s")
            both = {"vehicle": c.run.get(name) * factor, "simulator": c.sim.free.nu[:, j] * factor}
            drawings.append(chart(axis, unit, c.run.dt, both))
    return drawings


NOISE = "Ours has no noise: the thesis reads its velocities through Gazebo's sensors (1e-3 m/s, 6.2)."
TRIM = "Ours sinks slowly from its trim, as 6.2 says of both of the thesis's."
TIMES = "The thesis turned the knobs by hand at times that it does not print; ours turns each thruster for 30 s, one after the other."
LOOP = (
    "The thesis steered by way points with a controller that it calls premature (6.4), whose gains and points it does not print; "
    "ours is a square with a step of depth, steered by gains that follow from the vehicle's mass and drag."
)
LAG = "Thrust is that of the commanded speed: the thruster's own 0.05 s is not drawn."
PLACES = "Speed of each thruster's place: positions are assumed (docs/thesis.md)."
RIGID = "A rigid body has one angular velocity: all seven curves are these three."
PRIVATE = "The thesis's log is not public: this is the log that was given."
FIGURES = (
    Figure("5.1", "ROV velocity versus time in ROS", 1, ROS, velocity, f"{NOISE} {TRIM}"),
    Figure("5.2", "ROV individual thruster response in ROS", 1, ROS, response),
    Figure("5.3", "Input to individual thruster in MATLAB", 1, SIMULINK, inputs),
    Figure("5.4", "ROV thrust in MATLAB", 1, SIMULINK, forces),
    Figure("5.5", "ROV velocity in MATLAB", 1, SIMULINK, velocity, TRIM),
    Figure("5.6", "ROV velocity versus time in ROS", 2, ROS, velocity, f"{TIMES} {NOISE}"),
    Figure("5.7", "ROV individual thruster response in ROS", 2, ROS, response, LAG),
    Figure("5.8", "Individual thruster velocity (linear) in ROS", 2, ROS, of_thrusters(False), PLACES),
    Figure("5.9", "Individual thruster velocity (angular) in ROS", 2, ROS, of_thrusters(True), RIGID),
    Figure("5.10", "Input to individual thruster in MATLAB", 2, SIMULINK, inputs, TIMES),
    Figure("5.11", "ROV thrust in MATLAB", 2, SIMULINK, forces),
    Figure("5.12", "ROV velocity in MATLAB", 2, SIMULINK, velocity, TIMES),
    Figure("5.13", "Thruster 1 and 0 input and output versus time", 3, ROS, thruster_pair(1, 0)),
    Figure("5.14", "Thruster 3 and 2 input and output versus time", 3, ROS, thruster_pair(3, 2)),
    Figure("5.15", "Thruster 5 and 4 input and output versus time", 3, ROS, thruster_pair(5, 4)),
    Figure("5.16", "Thruster 6 input and output versus time", 3, ROS, thruster_pair(6, 7), "A vehicle with eight thrusters has the last one here."),
    Figure("5.17", "ROV change in position in MATLAB", 3, SIMULINK, closed(position), LOOP),
    Figure("5.18", "ROV motion, 3-D plot in MATLAB", 3, SIMULINK, closed(way), LOOP),
    Figure("5.19", "ROV velocity in MATLAB", 3, SIMULINK, closed(velocity), LOOP),
    Figure("5.20", "Response from the thrusters of the vehicle: set-point and feedback", 4, "", setpoint_and_feedback, PRIVATE),
    Figure("5.21", "Performance: vehicle and simulator", 5, SIMULINK, performance, PRIVATE),
)  # fmt: skip
