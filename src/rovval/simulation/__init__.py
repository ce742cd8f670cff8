"""Run + Vehicle -> SimResult: the plant driven by the recorded thruster speeds, once through and in restarted windows."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from rovval.core.data import Array, Flags, Reason, Run, SimResult, Trajectory
from rovval.core.errors import SimulationStopped, UsageProblem
from rovval.plant import Plant, parse_settings
from rovval.simulation.actuation import Actuation, recorded_actuation, start_states, startable
from rovval.simulation.boundaries import beyond_the_water
from rovval.simulation.sanity_limits import first_beyond
from rovval.simulation.step import stable_plant
from rovval.vehicle.model import Vehicle

WINDOW_S = 10.0  # about three to five time constants of surge of an observation-class ROV


def simulate(
    run: Run, vehicle: Vehicle, model: str = "fossen", effects: Sequence[str] = (), window_s: float = WINDOW_S
) -> SimResult:
    """Drive ``vehicle`` through ``run``.

    ``effects`` are settings such as ``inflow_loss:loss=0.3`` on top of those that the vehicle file carries. ``window_s`` is the
    length of the restarted windows.

    Raises:
        BadInput: the run lacks thruster inputs or states to start from.
        UsageProblem: unknown effect, value out of bounds, or a window shorter than two samples.
        SimulationStopped: no stretch at all could be simulated.
    """
    length = round(window_s / run.dt)
    if length < 2:
        raise UsageProblem(f"window of {window_s} s at {run.dt} s a sample", "use at least two samples a window")
    driven = recorded_actuation(run, vehicle)
    plant = stable_plant(vehicle, model, driven.inputs.speed, run.dt)
    settings = (*carried_effects(vehicle), *effects)
    beta = parse_settings(plant, settings)
    ready = startable(run)
    free, stops, assumed = _stretches(run, plant, driven, beta, _segments(driven.known, ready))
    windowed, _, _ = _stretches(run, plant, driven, beta, _windows(driven.known, ready, length))
    if not free.ok.any():
        raise SimulationStopped(f"run {run.id}: no sample could be simulated: {'; '.join(stops) or 'inputs and states never overlap'}")
    return SimResult(
        run_id=run.id,
        vehicle=vehicle.name,
        vehicle_hash=vehicle.hash,
        model=model,
        effects=settings,
        window_s=window_s,
        dt=run.dt,
        thrusters=vehicle.thrusters,
        input_source=driven.source,
        free=free,
        windowed=windowed,
        thruster_speed=driven.inputs.speed,
        thrust=plant.thrust(driven.inputs.speed),
        assumptions=(*driven.assumptions, *assumed, *beyond_the_water(run, vehicle, free.eta)),
        stops=stops,
    )


def carried_effects(vehicle: Vehicle) -> tuple[str, ...]:
    """The effects that a vehicle file carries in its [effects] table, as settings."""
    return tuple(
        f"{hypothesis}:" + ",".join(f"{name}={value!r}" for name, value in values.items())
        for hypothesis, values in vehicle.effects.items()
    )


def _segments(known: Flags, ready: Flags) -> list[tuple[int, int]]:
    """First and past-the-end sample of each unbroken stretch of known inputs, from its first startable point."""
    return [(first, end) for begin, end in _runs(known) if (first := _first(ready, begin, end)) is not None]


def _windows(known: Flags, ready: Flags, length: int) -> list[tuple[int, int]]:
    """The restarted windows: each unbroken stretch cut every ``length`` samples, each started at its first startable point."""
    cuts = [(b, min(b + length, end)) for begin, end in _runs(known) for b in range(begin, end, length)]
    return [(first, end) for begin, end in cuts if (first := _first(ready, begin, end)) is not None and end - first > 1]


def _runs(flags: Flags) -> Iterator[tuple[int, int]]:
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(np.int8)))
    yield from zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True)


def _first(flags: Flags, begin: int, end: int) -> int | None:
    inside = np.flatnonzero(flags[begin:end])
    return begin + int(inside[0]) if len(inside) else None


def _stretches(
    run: Run, plant: Plant, driven: Actuation, beta: Array, stretches: list[tuple[int, int]]
) -> tuple[Trajectory, tuple[str, ...], tuple[str, ...]]:
    """Simulate stretches [begin, end) and lay them on the run's grid; also why any stopped and what was assumed at the start."""
    n = len(run)
    nu, eta = np.full((n, 6), np.nan), np.full((n, 6), np.nan)
    reasons = np.full(n, Reason.STOPPED, dtype=np.uint8)
    stretch = np.full(n, -1, dtype=np.int64)
    stops: list[str] = []
    assumed: tuple[str, ...] = ()
    for length, members in _by_length(stretches):
        begin = np.array([stretches[i][0] for i in members], dtype=np.int64)
        nu0, eta0, assumed = start_states(run, begin)
        motion = plant.simulate(driven.inputs, begin, length - 1, nu0, eta0, np.tile(beta, (len(begin), 1)))
        halted = dict(zip(np.flatnonzero(motion.stopped >= 0).tolist(), motion.why, strict=True))
        for lane, number in enumerate(members):
            good, why = first_beyond(motion.nu[lane]) or (length, "")
            if 0 <= motion.stopped[lane] <= good:
                good, why = int(motion.stopped[lane]), halted[lane]
            at = slice(begin[lane], begin[lane] + good)
            nu[at], eta[at] = motion.nu[lane, :good], motion.eta[lane, :good]
            reasons[at], stretch[at] = Reason.OK, number
            if good < length:
                stops.append(f"stretch from {begin[lane] * run.dt:.1f} s stopped at {(begin[lane] + good) * run.dt:.1f} s: {why}")
    return Trajectory(nu, eta, reasons, stretch), tuple(stops), assumed


def _by_length(stretches: list[tuple[int, int]]) -> Iterator[tuple[int, NDArray[np.int64]]]:
    lengths = np.array([end - begin for begin, end in stretches], dtype=np.int64)
    for length in np.unique(lengths[lengths > 0]):
        yield int(length), np.flatnonzero(lengths == length)
