"""Missions: a vehicle flown by planned thruster speeds, the movement protocol, or controllers in the loop; and the thesis's scenarios.

`fly` reads as the algorithm. A mission is laid out in time (`plan`); at each sample instruments and an INS-like filter, or the true state, say where the
vehicle is (`sensors`, `navigation`), the leg says what is wanted (`guidance`), the autopilot which wrench that takes (`controllers`), the allocation which
thruster speeds (`allocation`), and the plant moves on. One lane flies the vehicle as its file has it; further lanes vehicles within its tolerances.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from rovval import effects as library
from rovval.core.channels import AXES
from rovval.core.data import Array
from rovval.core.errors import UsageProblem
from rovval.core.frames import rotation_from_euler
from rovval.fly.flight import Flight
from rovval.fly.loop.allocation import Thrusters, thrusters_of
from rovval.fly.loop.controllers import Autopilot, SetPoints, State
from rovval.fly.loop.guidance import LineOfSight, held
from rovval.fly.loop.navigation import Navigation
from rovval.fly.loop.sensors import Instruments
from rovval.fly.mission import Hold, Mission, WayPoints
from rovval.fly.plan import DT, Phase, lay_out
from rovval.fly.record import Record
from rovval.fly.tolerances import drawn
from rovval.plant import Plant, parse_settings
from rovval.plant.stepping import Stepper
from rovval.simulation import carried_effects
from rovval.simulation.step import MOST, steps_a_sample
from rovval.vehicle.model import Vehicle, allocation

Progress = Callable[[str, float], None]


def fly(
    mission: Mission, vehicle: Vehicle, model: str = "fossen", effects: Sequence[str] = (), *, noise: float = 1.0, draws: int = 0, seed: int = 0,
    calibration_slop: float = 0.05, progress: Progress | None = None,
) -> Flight:  # fmt: skip
    """Fly a mission. Equal arguments give an equal flight; the first lane's does not depend on ``draws``.

    Args:
        effects: settings such as ``"current_constant:north=0.3"`` beside those of the mission and of the vehicle's file.
        noise: factor on noise and bias of the mission's sensors; 0 closes the loop on the true state.
        draws: so many vehicles within the file's tolerances (Monte Carlo) beside the one of the file.
        calibration_slop: relative standard deviation of a healthy vehicle's coefficients.
        progress: is called with what is being done and the share that is done.

    Raises:
        UsageProblem: an effect, axis or table of the mission that does not exist or is out of bounds.
    """
    thrusters = thrusters_of(vehicle, mission.limits)
    phases = lay_out(mission, vehicle, thrusters)
    settings = (*carried_effects(vehicle), *environment(mission), *mission.water.effects, *effects)
    seeds = np.random.SeedSequence(seed).spawn(2)
    plant, beta = _lanes(vehicle, model, settings, thrusters, draws, calibration_slop, np.random.default_rng(seeds[0]))
    eta = np.tile(_start(mission), (len(beta), 1))
    water = Stepper(plant, beta, np.zeros_like(eta), eta, DT)
    eyes = _Eyes(mission, vehicle, water, noise, seeds[1])
    pilot = Autopilot(vehicle, mission.control, thrusters, DT)
    speed, record = np.zeros((len(beta), len(thrusters.names))), Record(phases[-1].last, len(thrusters.names), len(beta), phases)
    for phase in phases:
        ask = _asked(phase, eyes.see(water), mission, vehicle, thrusters)
        for k in range(phase.first, phase.last):
            state = eyes.see(water)
            wanted, fastest, turn = ask(state)
            command, wrench, given = _commanded(phase, k, wanted, state, pilot, thrusters, vehicle, fastest)
            record.keep(k, phase, water.nu, water.eta, eyes.altitude(water), state, speed, command, wrench, given, wanted, turn, water.stopped < 0)
            if water.stopped[0] >= 0:
                break
            speed = thrusters.turned(speed, command, DT)
            water.step(speed, eyes.altitude(water))
            eyes.close()
        if progress:
            progress("fly", phase.last / phases[-1].last)
    columns = record.columns()
    return Flight(
        mission=mission, vehicle=vehicle.name, vehicle_hash=vehicle.hash, model=model, effects=settings, seed=seed, noise=noise, draws=draws, dt=DT,
        thrusters=thrusters.names, phases=phases, **columns, held=record.held(columns, DT), passed=record.passed(DT),
        stops=(water.why[0],) if water.stopped[0] >= 0 else (), draws_stopped=int((water.stopped[1:] >= 0).sum()), notes=_notes(thrusters, mission),
    )  # fmt: skip


def environment(mission: Mission) -> tuple[str, ...]:
    """Surface and bottom of a mission as settings of effects."""
    bottom = mission.water.bottom_m
    return (*(("free_surface:share=1",) if mission.water.surface else ()), *((f"seabed:firmness=1,depth={bottom!r}",) if bottom is not None else ()))


class _Eyes:
    """What the loop is closed on: the true state, or instruments and their filter."""

    def __init__(self, mission: Mission, vehicle: Vehicle, water: Stepper, noise: float, seed: np.random.SeedSequence) -> None:
        sensors, gravity = mission.sensors, vehicle.water.gravity
        self._bottom = mission.water.bottom_m
        self._before = np.zeros((len(water.nu), 3))
        self._seen: State | None = None
        self._instruments = self._filter = None
        if sensors is not None and noise > 0:
            self._instruments = Instruments(sensors, len(water.nu), gravity, DT, seed, noise)
            self._filter = Navigation(sensors, water.nu, water.eta, gravity, DT, noise)

    def altitude(self, water: Stepper) -> Array | None:
        """True height of the origin above the bottom (B,), m; None without one."""
        return None if self._bottom is None else self._bottom - water.eta[:, 2]

    def see(self, water: Stepper) -> State:
        """The state at this sample; asked again at the same one it is the same."""
        if self._seen is None:
            if self._instruments is None or self._filter is None:
                self._seen = State(water.nu, water.eta, self.altitude(water))
            else:
                self._seen = self._filter.update(self._instruments.measure(water.nu, water.eta, self._before, self.altitude(water)))
                self._before = np.einsum("bij,bj->bi", rotation_from_euler(water.eta[:, 3:]), water.nu[:, :3])
        return self._seen

    def close(self) -> None:
        """The sample is over."""
        self._seen = None


Ask = Callable[[State], tuple[SetPoints, float, NDArray[np.int64] | None]]


def _asked(phase: Phase, state: State, mission: Mission, vehicle: Vehicle, thrusters: Thrusters) -> Ask:
    """What a phase asks for in a state, how fast a set-point of depth may move, m/s, and how many way points each lane has reached (B,)."""
    leg, size = phase.leg, len(state.eta)
    if isinstance(leg, Hold):
        wanted = held(leg, size)
    elif isinstance(leg, WayPoints):
        thrusters.refuse_uncontrolled(("surge", "heave", "yaw"), phase.label)
        line = LineOfSight(leg, state, vehicle.body.size[0], mission.control.bandwidth_rad_s, bool(thrusters.controlled[AXES.index("sway")]))
        return lambda now: (line.set_points(now), line.fastest, line.next)
    else:
        keep = {"depth": state.eta[:, 2].copy(), "heading": state.eta[:, 5].copy()}
        wanted = SetPoints(**{name: keep[name] for name in phase.hold})
    thrusters.refuse_uncontrolled(wanted.axes, phase.label)
    if wanted.altitude is not None and mission.water.bottom_m is None:
        raise UsageProblem(f"{phase.label}: an altitude is held above a bottom, and the mission has none", "give [water] bottom_m")
    return lambda now: (wanted, np.inf, None)


def _commanded(
    phase: Phase, k: int, wanted: SetPoints, state: State, pilot: Autopilot, thrusters: Thrusters, vehicle: Vehicle, fastest: float
) -> tuple[Array, Array, Array]:
    """Thruster speeds (B, k) rev/s for the next sample, the autopilot's wrench (B, 6), and the share of it (B, 6) that the limits allow."""
    wrench = pilot.wrench(wanted, state, fastest)
    if phase.speed is None or wanted.axes:
        asked = wrench
        if phase.speed is not None:  # a movement of the protocol beside what is held
            planned = phase.speed[k - phase.first]
            asked = wrench + allocation(vehicle) @ (np.where(planned > 0, thrusters.k_pos, thrusters.k_neg) * planned * np.abs(planned))
        command, given = thrusters.allocate(asked)
        pilot.integrate(given)
        return command, wrench, given
    row = phase.speed[min(k + 1 - phase.first, len(phase.speed) - 1)]
    command = np.tile(np.clip(row, -thrusters.limit, thrusters.limit), (len(state.eta), 1))
    return command, wrench, np.full((len(state.eta), 6), 1.0 if (np.abs(row) <= thrusters.limit).all() else 0.0)


def _lanes(
    vehicle: Vehicle, model: str, settings: Sequence[str], thrusters: Thrusters, draws: int, slop: float, rng: np.random.Generator
) -> tuple[Plant, Array]:
    """The plant and the parameters of each lane (1 + draws, K), the first the file's own."""
    most = thrusters.most.max(axis=1)
    substeps = steps_a_sample(vehicle, most[None], DT) if np.isfinite(most).all() else MOST
    plant = Plant(vehicle, model, substeps)
    late = [s for s in settings if library.load(s.partition(":")[0].partition("[")[0].strip()).place == "sensor"]
    if late:
        raise UsageProblem(
            f"{', '.join(late)}: an effect of the log, and a flight has no log yet", "give the mission's [sensors] noise, bias, delay or dropout"
        )
    beta = parse_settings(plant, settings)
    return plant, np.concatenate([beta[None], drawn(plant, beta, draws, slop, rng)])


def _start(mission: Mission) -> Array:
    """First pose (6,)."""
    s = mission.start
    return np.array([s.north_m, s.east_m, s.depth_m, *np.radians([s.roll_deg, s.pitch_deg, s.heading_deg])])


def _notes(thrusters: Thrusters, mission: Mission) -> tuple[str, ...]:
    """What a reader of the flight should know of it."""
    unknown = [n for n, limit in zip(thrusters.names, thrusters.limit, strict=True) if not np.isfinite(limit)]
    said = f"no greatest speed is known for {', '.join(unknown)}, so none limits them: give [limits] rpm, or rpm_max in the vehicle's file"
    return (said,) if unknown else ()
