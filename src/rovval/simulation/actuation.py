"""What drives the plant in a run: thruster speeds, from the best channel that the log holds, and the states to start from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rovval.core.channels import VELOCITIES
from rovval.core.data import Array, Flags, Run
from rovval.core.errors import BadInput, Finding, all_at_once
from rovval.core.frames import attitude_difference, rotation_from_euler
from rovval.plant import Inputs
from rovval.vehicle.model import Mixer, PulseTable, Vehicle

SLOPE_HALF_WIDTH = 5  # samples: a velocity that was not logged starts as the slope of its pose over +-0.5 s (chosen)
SOURCES = {"n": "measured speed", "n_cmd": "speed set-point", "pwm": "pulse width", "stick": "pilot's sticks"}


@dataclass(frozen=True, slots=True)
class Actuation:
    """Inputs of the plant on the run's grid, where they are known (n,), from which channels, and what was assumed."""

    inputs: Inputs
    known: Flags
    source: str
    assumptions: tuple[str, ...]


def recorded_actuation(run: Run, vehicle: Vehicle) -> Actuation:
    """Thruster speeds (n, k) rev/s of a run: measured speed, else set-point, else pulse width, else pilot's sticks.

    Raises:
        BadInput: no family of channels covers every thruster of the vehicle; says what the log holds.
    """
    partly: list[str] = []
    for family, convert in (("n", _speeds), ("n_cmd", _speeds), ("pwm", _pulses), ("stick", _sticks)):
        wanted = _wanted(family, vehicle)
        if wanted and all(run.measured(name) for name in wanted):
            known = np.all([run.ok(name) for name in wanted], axis=0)
            speed = np.zeros((len(run), len(vehicle.thrusters)))
            speed[known], assumptions = convert(run, wanted, known, vehicle)  # what is not known is never looked up in a table
            return Actuation(
                inputs=Inputs(
                    dt=run.dt,
                    speed=speed,
                    hold=family != "n",
                    t=run.t,
                    altitude=_optional(run, "altitude"),
                    wall_distance=_optional(run, "wall_distance"),
                    voltage=_optional(run, "voltage"),
                    tether_length=_optional(run, "tether_length"),
                    turned=_turned(run),
                ),
                known=known,
                source=SOURCES[family],
                assumptions=(*(f"{lack}, so the {SOURCES[family]} drives all thrusters" for lack in partly), *assumptions),
            )
        gone = [name.partition(":")[2] for name in wanted if not run.measured(name)]
        if len(gone) < len(wanted):
            partly.append(f"{SOURCES[family]} is missing for {', '.join(gone)}")
    held = sorted(n for n in run.values if n.partition(":")[0] in ("n", "n_cmd", "pwm", "stick"))
    why = "; ".join(partly) or f"the log holds {', '.join(held) or 'none'}"
    raise BadInput(
        f"run {run.id}: no thruster input for {vehicle.name} ({', '.join(vehicle.thrusters)}); {why}",
        "map a speed, set-point, pulse width or stick channel for every thruster in the profile, or choose the right --vehicle",
    )


def replaced_input(run: Run, vehicle: Vehicle) -> tuple[Finding, ...]:
    """A finding where a better channel of the thrusters is in the log and does not cover all of them, so that another drives the plant.

    Empty where no family covers every thruster: `recorded_actuation` refuses such a run.
    """
    partly: list[tuple[str, str]] = []
    for family in SOURCES:
        wanted = _wanted(family, vehicle)
        gone = [name for name in wanted if not run.measured(name)]
        if wanted and not gone:
            return tuple(
                Finding("thruster_input", lack, f"no {SOURCES[had]}, so the {SOURCES[family]} drives all thrusters") for had, lack in partly
            )
        if len(gone) < len(wanted):
            partly.append((family, ", ".join(gone)))
    return ()


def start_states(run: Run, at: NDArray[np.int64]) -> tuple[Array, Array, tuple[str, ...]]:
    """Measured velocities and poses (m, 6) at grid points ``at``; what was not logged is derived or taken as zero, and said."""
    assumptions = []
    nu = np.stack([run.get(name)[at] for name in VELOCITIES], axis=1)
    eta = np.stack([run.get(name)[at] for name in ("x", "y", "z", "phi", "theta", "psi")], axis=1)
    derived = _velocity_from_pose(run, at)
    for i, name in enumerate(VELOCITIES):
        if not run.measured(name):
            usable = np.isfinite(derived[:, i])
            nu[:, i] = np.where(usable, derived[:, i], 0.0)
            how = "the slope of the measured pose" if usable.any() else "zero"
            assumptions.append(f"{name} was not logged: each stretch starts with it at {how}")
    for i, name in enumerate(("x", "y", "z", "phi", "theta", "psi")):
        if not run.measured(name):
            assumptions.append(f"{name} was not logged: each stretch starts with it at zero")
        eta[:, i] = np.where(np.isfinite(eta[:, i]), eta[:, i], 0.0)
    return nu, eta, tuple(assumptions)


def startable(run: Run) -> Flags:
    """Grid points (n,) at which every logged velocity, attitude and depth holds a value, so that a stretch may start there."""
    needed = [n for n in (*VELOCITIES, "z", "phi", "theta", "psi") if run.measured(n)]
    if not needed:
        raise BadInput(f"run {run.id}: neither velocity nor pose was logged", "map navigation channels in the profile")
    return np.asarray(np.all([run.ok(name) for name in needed], axis=0))


def _wanted(family: str, vehicle: Vehicle) -> tuple[str, ...]:
    if family == "stick":
        return tuple(f"stick:{axis}" for axis in vehicle.mixer.factors) if vehicle.mixer and vehicle.pulse_table else ()
    if family == "pwm" and not vehicle.pulse_table:
        return ()
    return tuple(f"{family}:{name}" for name in vehicle.thrusters)


def _speeds(run: Run, names: tuple[str, ...], known: Flags, vehicle: Vehicle) -> tuple[Array, tuple[str, ...]]:
    return run.stack(names)[known], ()


def _pulses(run: Run, names: tuple[str, ...], known: Flags, vehicle: Vehicle) -> tuple[Array, tuple[str, ...]]:
    table = vehicle.pulse_table
    assert table is not None
    said = f"thrust from pulse width by the table at {table.voltage:g} V"
    return _equivalent_speed(run.stack(names)[known], run, known, vehicle, table), (said,)


def _sticks(run: Run, names: tuple[str, ...], known: Flags, vehicle: Vehicle) -> tuple[Array, tuple[str, ...]]:
    mixer, table = vehicle.mixer, vehicle.pulse_table
    assert mixer is not None
    assert table is not None
    said = f"pulse widths from the pilot's sticks by the vehicle's mixer (manual mode), thrust by the table at {table.voltage:g} V"
    return _equivalent_speed(mix(run.stack(names)[known], mixer), run, known, vehicle, table), (said,)


def _refuse_outside(table: PulseTable, pwm: Array, run: Run, known: Flags, vehicle: Vehicle) -> None:
    """Raise BadInput where a pulse width is outside the table, of each thruster: nothing is extrapolated."""
    low, high = table.pwm_us[0], table.pwm_us[-1]
    outside, t = (pwm < low) | (pwm > high), run.t[known]
    problems = [
        f"{name}: {off.sum()} samples from {widths[off].min():g} to {widths[off].max():g} us, the first at t = {t[np.argmax(off)]:.1f} s"
        for name, widths, off in zip(vehicle.thrusters, pwm.T, outside.T, strict=True) if off.any()
    ]  # fmt: skip
    if problems:
        raise BadInput(
            all_at_once(problems, f"run {run.id}: pulse widths outside the thruster table of {vehicle.name} ({low:g} to {high:g} us)"),
            "extend pulse_table in the vehicle's file, mend the column that the profile reads, or leave that part out with --from and --to",
        )


def mix(sticks: Array, mixer: Mixer) -> Array:
    """Pulse widths (n, k) us of sticks (n, m) in the mixer's order; the sum for a motor is limited to +-1 as the autopilot does."""
    demand = sticks @ np.array(list(mixer.factors.values()))
    return np.asarray(mixer.neutral_us + mixer.span_us * np.clip(demand, -1.0, 1.0))


def _equivalent_speed(pwm: Array, run: Run, known: Flags, vehicle: Vehicle, table: PulseTable) -> Array:
    """Speed (rev/s), of pulse widths (m, k) us at the ``known`` grid points, at which the quadratic law of the table's thruster gives the table's thrust: the
    table stays exact, the law simple."""
    _refuse_outside(table, pwm, run, known, vehicle)
    thrust = np.interp(pwm, table.pwm_us, table.thrust)
    ahead, astern = table.k_pos or [t.k_pos for t in vehicle.thruster], table.k_neg or [t.k_neg for t in vehicle.thruster]
    gain = np.where(thrust >= 0, ahead, astern)
    return np.asarray(np.sign(thrust) * np.sqrt(np.abs(thrust) / gain) / 60.0)


def _optional(run: Run, name: str) -> Array | None:
    """A side channel with its gaps held from the last value before (it varies slowly), or None where it was not logged."""
    if not run.measured(name):
        return None
    ok, values = run.ok(name), run.get(name)
    last = np.maximum.accumulate(np.where(ok, np.arange(len(run)), -1))
    first = int(np.argmax(ok))
    return np.asarray(values[np.where(last < 0, first, last)])


def _turned(run: Run) -> Array | None:
    """Yaw (rad) since the run's start, whole turns counted, or None where no heading was logged but that of the start."""
    heading = _optional(run, "psi")
    return None if heading is None or run.ok("psi").sum() < 2 else np.asarray(np.unwrap(heading) - heading[0])


def _velocity_from_pose(run: Run, at: NDArray[np.int64]) -> Array:
    """Body velocities (m, 6) as the slope of the pose about each point; NaN where the pose is missing there."""
    before, after = np.maximum(at - SLOPE_HALF_WIDTH, 0), np.minimum(at + SLOPE_HALF_WIDTH, len(run) - 1)
    seconds = ((after - before) * run.dt)[:, None]
    position, attitude = run.stack(("x", "y", "z")), run.stack(("phi", "theta", "psi"))
    rate = (position[after] - position[before]) / seconds
    euler = attitude[at]
    level = np.where(np.isfinite(euler), euler, 0.0)
    missing_xy = np.isnan(rate[:, :2]).all(axis=1, keepdims=True)
    world = np.where(np.isnan(rate) & np.concatenate([missing_xy, missing_xy, np.zeros_like(missing_xy)], axis=1), 0.0, rate)
    linear = np.einsum("mji,mj->mi", rotation_from_euler(level), world)
    angular = attitude_difference(attitude[after], attitude[before]) / seconds
    return np.concatenate([linear, angular], axis=1)


