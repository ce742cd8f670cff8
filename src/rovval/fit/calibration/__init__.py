"""Calibration: all that a vehicle's file may have wrong, estimated from logs at once; read `calibrate` first.

Every unknown has a prior about the file and none is frozen: what the logs do not show stays where its prior holds it, and is said to. What
only some vehicles need (thrusters that differ from one another) is added where it predicts every run left out better.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import exp, isfinite, log
from typing import Any

import numpy as np

from rovval.core.channels import AXES, VELOCITIES
from rovval.core.data import Array, Run
from rovval.core.errors import BadInput, SimulationStopped, UsageProblem
from rovval.core.version import __version__
from rovval.diagnose.criteria import HELD_OUT_RUNS
from rovval.diagnose.effort import PROGRESSIVE_S
from rovval.diagnose.inference.identifiability import seen_together
from rovval.diagnose.windows.noise import clean_channels
from rovval.fit.calibration.apparent_sizes import apparent_sizes
from rovval.fit.calibration.discrepancy import discrepancy
from rovval.fit.calibration.estimate import Estimate, Problem, held_out_gain, maximum
from rovval.fit.calibration.random_effects import tolerances
from rovval.fit.calibration.record import Record, begun, record, residual, rms
from rovval.fit.calibration.unknowns import Unknown, applied, bounds, unknowns
from rovval.plant import Plant, parse_settings
from rovval.plant.platforms import USUAL
from rovval.plant.slots import slots
from rovval.simulation import carried_effects, simulate
from rovval.simulation.fitted_commands import Excess, excesses, fitted, largest
from rovval.simulation.fitted_errors import kept
from rovval.simulation.fitted_tolerances import (
    fitted_discrepancy,
    fitted_tolerances,
    with_discrepancy,
    with_sizes,
    with_tolerances,
)
from rovval.simulation.step import steps_a_sample
from rovval.vehicle.model import Vehicle

FLOORS = {"m/s": 0.005, "rad/s": 0.005, "1": 0.005, "m": 0.01}  # least noise that a channel is taken to have: a window's start has as much (chosen)
HELD_BY_PRIOR = 0.8  # of the prior's standard deviation: a posterior as wide says that the logs show next to nothing of it (chosen)
QUANTILE = 1.645  # of a 90 % interval of a normal

Progress = Callable[[str, float], None]


@dataclass(frozen=True, slots=True)
class Row:
    """One unknown: ``value`` beside the file as it was given (a factor, or an offset in ``unit``) with its 90 % interval and standard ``error`` (of a
    factor's logarithm), ``moved`` from its prior's mean in standard deviations of the prior, and whether the logs ``show`` it or the prior holds it."""

    unknown: Unknown
    value: float
    low: float
    high: float
    error: float
    moved: float
    shown: bool


@dataclass(frozen=True, slots=True)
class AxisError:
    """Mean absolute error of a free run in the axis's velocity (m/s or rad/s): by the file as given, by the calibrated vehicle, and by one that was
    calibrated without this run (None: there is no other)."""

    run: str
    axis: str
    unit: str
    given: float
    calibrated: float
    left_out: float | None
    rows: int


@dataclass(frozen=True, slots=True)
class Calibration:
    """The calibrated ``vehicle``; its unknowns; the ``matrix`` (k, k) of their correlations, and pairs of them that go together; errors of free runs; of
    each of the ``options`` the change of twice the log likelihood of every run left out, and which were ``accepted``; whether the search ``converged``;
    logs ``left_out``; thrusters that a run drives further than the runs that it was predicted from (``extrapolated``)."""

    vehicle: Vehicle
    rows: tuple[Row, ...]
    matrix: tuple[tuple[float, ...], ...]
    correlations: tuple[tuple[str, str, float], ...]
    errors: tuple[AxisError, ...]
    options: Mapping[str, tuple[float, ...]]
    accepted: tuple[str, ...]
    converged: bool
    left_out: tuple[str, ...]
    extrapolated: tuple[tuple[str, Excess], ...] = ()

    def document(self) -> dict[str, Any]:
        """The same as JSON (schema rovval.calibration/1), factors of the file's numbers and offsets in SI, commands in rpm."""
        units = {slot.key: slot.parameter.unit for slot in slots(self.vehicle, USUAL)}
        return {
            "schema": "rovval.calibration/1",
            "rovval": __version__,
            "run": ", ".join(dict.fromkeys(one.run for one in self.errors)),
            "vehicle": self.vehicle.name,
            "vehicle_hash": self.vehicle.hash,
            "unknowns": {
                one.unknown.key: {
                    "kind": one.unknown.kind, "value": one.value, "low": one.low, "high": one.high, "unit": one.unknown.unit,
                    "meaning": one.unknown.meaning, "moved": one.moved, "shown": one.shown, "standard_error": one.error, "prior": one.unknown.sd,
                    "manoeuvre": one.unknown.manoeuvre,
                }
                for one in self.rows
            },
            "matrix": [list(row) for row in self.matrix],
            "correlations": [{"of": [a, b], "value": value} for a, b, value in self.correlations],
            "free_run": [
                {"run": e.run, "axis": e.axis, "unit": e.unit, "given": e.given, "calibrated": e.calibrated, "left_out": e.left_out, "n": e.rows}
                for e in self.errors
            ],
            "options": [
                {"name": name, "gain": [gain if isfinite(gain) else None for gain in by_run], "accepted": name in self.accepted}
                for name, by_run in self.options.items()
            ],
            "commands": dict(fitted(self.vehicle)),
            "tolerances": {key: {"sd": sd, "unit": units[key]} for key, sd in fitted_tolerances(self.vehicle).items()},
            "discrepancy": {kind: {"sd": sd, "unit": "N" if kind.startswith(AXES[:3]) else "N m"} for kind, sd in fitted_discrepancy(self.vehicle).items()},
            "extrapolated": [
                {"run": run, "thruster": e.thruster, "way": e.way, "rpm": e.worst, "others": e.limit, "rows": e.count, "n": e.rows}
                for run, e in self.extrapolated
            ],
            "converged": self.converged,
            "left_out": list(self.left_out),
        }  # fmt: skip


def calibrate(runs: Sequence[Run], vehicle: Vehicle, *, model: str = "fossen", window_s: float = 10.0, progress: Progress | None = None) -> Calibration:
    """The vehicle whose simulation is nearest to its logs, by a maximum a posteriori estimate of what its file may have wrong.

    Args:
        runs: logs of this vehicle; with two or more, each is predicted once by a calibration without it.
        window_s: length of the windows, each restarted from the measured state.

    Raises:
        BadInput: no run has enough windows, or the simulation of the file as given stops in all of them.
        SimulationStopped: the calibrated vehicle leaves sane limits on one of its own logs.
    """
    say = progress or (lambda text, share: None)
    records, left_out = _records(runs, vehicle, window_s)
    asked = unknowns(vehicle, _channels(records))
    chosen = tuple(one for one in asked if not one.optional)
    say(f"calibrating {len(chosen)} unknowns on {sum(len(one.start) for one in records)} windows", 0.05)
    estimate = _estimate(records, vehicle, chosen, model, (_beginning(records, vehicle, chosen, model),))
    gains, others = dict[str, tuple[float, ...]](), tuple[Estimate, ...]()
    if len(records) > 1:
        others = _from_the_others(records, vehicle, chosen, model, estimate.values)
        predicted = _prediction(records, vehicle, chosen, model, others)
        for name, more in (_options(asked) if len(records) >= HELD_OUT_RUNS else {}).items():  # of two, one alone would judge
            say(f"asking whether {name} predicts runs left out better", 0.4)
            wider = tuple(one for one in asked if one in chosen or one in more)
            start = _widened(estimate, chosen, wider)
            gains[name] = tuple(float(gain) for gain in _promised(records, vehicle, chosen, wider, model, start))
            if min(gains[name]) <= 0:
                continue  # not even in the tangent, where a prediction costs nothing
            found = _from_the_others(records, vehicle, wider, model, start)
            better = _prediction(records, vehicle, wider, model, found)
            gains[name] = tuple(float(gain) for gain in better - predicted)
            if min(gains[name]) > 0:
                estimate, chosen, predicted, others = _estimate(records, vehicle, wider, model, (start,)), wider, better, found
    say("simulating the logs with the calibrated vehicle", 0.8)
    by = others or (estimate,) * len(records)
    left = _left(records, vehicle, chosen, model, by)
    own, calibrated = [one.run for one in records], _remembering(applied(vehicle, chosen, estimate.values), records, left)
    known = tolerances(own, calibrated, model, window_s)
    apart = [with_tolerances(applied(vehicle, chosen, e.values), *known) for e in by]
    unmodelled, sizes = discrepancy(own, apart, model, window_s), apparent_sizes(own, apart, model, window_s)
    calibrated = with_sizes(with_discrepancy(with_tolerances(calibrated, *known), unmodelled), sizes)
    errors = _errors(records, vehicle, calibrated, chosen, model, others)
    accepted = tuple(name for name, by_run in gains.items() if min(by_run) > 0)
    rows = tuple(_row(vehicle, one, estimate, i) for i, one in enumerate(chosen))
    matrix = tuple(tuple(float(value) for value in row) for row in estimate.correlation)
    further = _extrapolated(records, vehicle)
    pairs = seen_together([one.key for one in chosen], estimate.correlation)
    return Calibration(calibrated, rows, matrix, pairs, errors, gains, accepted, estimate.converged, left_out, further)


def _records(runs: Sequence[Run], vehicle: Vehicle, window_s: float) -> tuple[tuple[Record, ...], tuple[str, ...]]:
    """Every run that can be used, and why others cannot."""
    found, problems = list[Record](), list[BadInput]()
    for run in runs:
        try:
            found.append(record(run, vehicle, window_s))
        except BadInput as problem:
            problems.append(problem)
    if not found:
        raise problems[0]
    return tuple(found), tuple(str(problem) for problem in problems)


def _channels(records: Sequence[Record]) -> tuple[str, ...]:
    """Channels that some run holds."""
    return tuple(c for c in (*VELOCITIES, "phi", "theta", "z") if any(one.run.measured(c) for one in records))


def _remembering(vehicle: Vehicle, records: Sequence[Record], left: Mapping[str, float]) -> Vehicle:
    """The vehicle with what a reader of its file must know beside what the calibration moved: the largest command of each thruster in its logs, beyond which
    nothing was fitted, and the errors ``left``, by which a healthy vehicle is known."""
    return vehicle.model_copy(update={"calibration": {**vehicle.calibration, **largest([_speed(one) for one in records], vehicle), **left}})


def _extrapolated(records: Sequence[Record], vehicle: Vehicle) -> tuple[tuple[str, Excess], ...]:
    """Thrusters of each run that go further there than in all the others, which predict it."""
    if len(records) < 2:
        return ()
    limits = [largest([_speed(one) for one in _without(records, i)], vehicle) for i in range(len(records))]
    return tuple((one.run.id, e) for one, limit in zip(records, limits, strict=True) for e in excesses(_speed(one), limit, vehicle))


def _left(records: Sequence[Record], vehicle: Vehicle, chosen: Sequence[Unknown], model: str, by: Sequence[Estimate]) -> dict[str, float]:
    """Errors by channel that the calibrations ``by`` leave of one run each, in windows: on a log that it has not seen a vehicle shows those of a prediction."""
    each = [_problem((one,), vehicle, chosen, model).residuals(e.values)[0] for one, e in zip(records, by, strict=True)]
    ok = [one.ok & np.isfinite(r) for one, r in zip(records, each, strict=True)]
    return kept(rms(each, ok), [rms([r], [k]) for r, k in zip(each, ok, strict=True)])


def _speed(one: Record) -> Array:
    """Thruster speeds (n, k) rev/s of a run, where they are known."""
    return one.actuation.inputs.speed[one.actuation.known]


def _problem(records: Sequence[Record], vehicle: Vehicle, chosen: Sequence[Unknown], model: str) -> Problem:
    given = Plant(vehicle, model)
    needed = max(steps_a_sample(vehicle, given.thrust(one.actuation.inputs.speed), one.run.dt) for one in records)
    steps = 2 * needed  # the vehicle may be stiffer than its file says

    def residuals(values: Array) -> Sequence[Array]:
        plant = Plant(applied(vehicle, chosen, values), model, steps)
        try:
            beta = parse_settings(plant, carried_effects(plant.vehicle))
        except UsageProblem:  # lag, sensor or tether beyond the bounds of its effect: no vehicle
            return [np.full(one.ok.shape, np.nan) for one in records]
        return [residual(one, plant, beta) for one in records]

    mean = np.array([-vehicle.calibration.get(one.key, 0.0) for one in chosen])
    sd, (low, high) = np.array([one.sd for one in chosen]), bounds(vehicle, chosen)
    return Problem(
        residuals, [one.ok for one in records], records[0].run.dt, _floor(records), mean, sd, low, high, [one.kinematics.of(chosen) for one in records]
    )  # fmt: skip


def _floor(records: Sequence[Record]) -> Array:
    """Noise (10,) of the channels: white noise of the sensors as the logs show it, the median over runs."""
    named = (*VELOCITIES, "phi", "theta", "z")
    noise = np.median([clean_channels(one.run, named)[2] for one in records], axis=0)
    tilt = float(np.hypot(noise[6], noise[7]))
    found = np.array([*noise[:6], tilt, tilt, tilt, noise[8]])
    least = np.array([FLOORS[unit] for unit in (*("m/s",) * 3, *("rad/s",) * 3, *("1",) * 3, "m")])
    return np.asarray(np.maximum(np.nan_to_num(found), least))


def _estimate(records: Sequence[Record], vehicle: Vehicle, chosen: Sequence[Unknown], model: str, starts: Sequence[Array]) -> Estimate:
    try:
        return maximum(_problem(records, vehicle, chosen, model), starts)
    except ValueError as error:
        raise BadInput(
            f"the simulation of {vehicle.name} leaves sane limits within the windows, wherever the search begins",
            "look at `rovval simulate`; mend gross errors of the file, or give a shorter --window",
        ) from error


def _beginning(records: Sequence[Record], vehicle: Vehicle, chosen: Sequence[Unknown], model: str) -> Array:
    """Where the search begins (k,): the best fit of the first `PROGRESSIVE_S` of each window, one after the other.

    The first of them is fitted from the file as it is, and with half and twice the thrust and drag: of forces only their ratio to the mass shows well, so that
    a search may end at a thrust that is far off. Over a whole window a vehicle that rolls or pitches freely loses the phase of its motion, and a fit from far
    away ends in the nearest of many local minima; over short windows the loss has few.
    """
    scaled = np.array([float(one.key == "thrust.gain" or "_drag[" in one.key) for one in chosen])
    starts: tuple[Array, ...] = (np.zeros(len(chosen)), -log(2.0) * scaled, log(2.0) * scaled)
    for seconds in PROGRESSIVE_S:
        starts = (_estimate([begun(one, seconds) for one in records], vehicle, chosen, model, starts).values,)
    return starts[0]


def _options(asked: Sequence[Unknown]) -> dict[str, tuple[Unknown, ...]]:
    """What is only added where it predicts better, by what it is called."""
    found = dict[str, tuple[Unknown, ...]]()
    for one in asked:
        if one.optional:
            name = one.key.partition("[")[0]
            found[name] = (*found.get(name, ()), one)
    return found


def _widened(estimate: Estimate, chosen: Sequence[Unknown], wider: Sequence[Unknown]) -> Array:
    """The values of an estimate with further unknowns at 0."""
    known = dict(zip((one.key for one in chosen), estimate.values, strict=True))
    return np.array([known.get(one.key, 0.0) for one in wider])


def _without(records: Sequence[Record], left: int) -> tuple[Record, ...]:
    return tuple(one for i, one in enumerate(records) if i != left)


def _promised(records: Sequence[Record], vehicle: Vehicle, chosen: Sequence[Unknown], wider: Sequence[Unknown], model: str, start: Array) -> Array:
    """What `_prediction` of every run (m,) gains with the ``wider`` unknowns, in the model linearised at ``start`` (k,)."""
    return held_out_gain(_problem(records, vehicle, wider, model), start, np.array([one in chosen for one in wider]))


def _from_the_others(records: Sequence[Record], vehicle: Vehicle, chosen: Sequence[Unknown], model: str, start: Array) -> tuple[Estimate, ...]:
    """The calibration of all runs but one, for each."""
    return tuple(_estimate(_without(records, i), vehicle, chosen, model, (start,)) for i in range(len(records)))


def _prediction(records: Sequence[Record], vehicle: Vehicle, chosen: Sequence[Unknown], model: str, others: Sequence[Estimate]) -> Array:
    """Twice the log likelihood of every run (m,) under the calibration of the ``others``, at its scales, up to a constant."""
    apart = zip(records, others, strict=True)
    return np.array([2.0 * _problem((one,), vehicle, chosen, model).log_likelihood(e.values, e.scale) for one, e in apart])


def _errors(
    records: Sequence[Record], vehicle: Vehicle, calibrated: Vehicle, chosen: Sequence[Unknown], model: str, others: Sequence[Estimate]
) -> tuple[AxisError, ...]:
    """Mean absolute errors of free runs; ``others`` are the calibrations without each, none of a single run.

    Raises:
        SimulationStopped: the calibrated vehicle leaves sane limits on a run on which the vehicle as given does not.
    """
    found = list[AxisError]()
    for i, one in enumerate(records):
        apart = applied(vehicle, chosen, others[i].values) if others else None
        given, after = (simulate(one.run, v, model) for v in (vehicle, calibrated))
        if after.stops and not given.stops:
            raise SimulationStopped(
                f"run {one.run.id}: the calibrated vehicle leaves sane limits: {after.stops[0]}; no vehicle is written",
                "give logs with more motion on that axis, or a shorter --window",
            )
        left = simulate(one.run, apart, model) if apart else None
        for axis, (name, channel) in enumerate(zip(AXES, VELOCITIES, strict=True)):
            sims = [s for s in (given, after, left) if s is not None]
            both = np.all([one.run.ok(channel), *(s.free.ok for s in sims)], axis=0)
            if both.any():
                mae = [float(np.abs(s.free.nu[both, axis] - one.run.get(channel)[both]).mean()) for s in sims]
                unit = "m/s" if axis < 3 else "rad/s"
                found.append(AxisError(one.run.id, name, unit, mae[0], mae[1], mae[2] if left else None, int(both.sum())))
    return tuple(found)


def _row(vehicle: Vehicle, one: Unknown, estimate: Estimate, i: int) -> Row:
    value, error = float(estimate.values[i]), float(estimate.error[i])
    middle, low, high = (exp(x) if one.kind == "factor" else x for x in (value, value - QUANTILE * error, value + QUANTILE * error))
    moved = (value + vehicle.calibration.get(one.key, 0.0)) / one.sd
    return Row(one, middle, low, high, error, moved, error < HELD_BY_PRIOR * one.sd)
