"""A run as a calibration sees it: overlapping windows restarted from the measured state, and how far a simulation is from each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rovval.core.channels import VELOCITIES
from rovval.core.data import Array, Flags, Run
from rovval.core.errors import BadInput
from rovval.core.frames import rotation_from_euler
from rovval.fit.calibration.kinematics import Kinematics, kinematics
from rovval.plant import Plant
from rovval.simulation.actuation import Actuation, recorded_actuation, start_states, startable
from rovval.vehicle.model import Vehicle

CHANNELS = (*VELOCITIES, "down x", "down y", "down z", "z")  # the body components of the vertical stand for roll and pitch: no angle wraps in them
LEVEL = {"down x": "theta", "down y": "phi"}  # angles of which these components are as much off, of a vehicle that is nearly level
FEWEST = 2  # windows of a run: with one nothing is restarted


@dataclass(frozen=True, slots=True)
class Record:
    """``start`` (m,) first samples of the windows, ``steps`` samples each; ``nu0`` and ``eta0`` (m, 6) measured there; ``measured`` and ``ok``
    (m, steps + 1, 10) by `CHANNELS`; and what ``kinematics`` say of the sensors."""

    run: Run
    actuation: Actuation
    start: NDArray[np.int64]
    steps: int
    nu0: Array
    eta0: Array
    measured: Array
    ok: Flags
    kinematics: Kinematics


def record(run: Run, vehicle: Vehicle, window_s: float) -> Record:
    """Cut a run into windows of ``window_s`` s, one behind another, at points where everything logged holds a value.

    Raises:
        BadInput: fewer than two windows with known thruster inputs, or no thruster inputs at all.
    """
    actuation, steps = recorded_actuation(run, vehicle), round(window_s / run.dt)
    ready = startable(run)
    start, at = list[int](), 0
    while at + steps < len(run):
        if ready[at] and actuation.known[at : at + steps].all():
            start.append(at)
            at += steps
        else:
            at += 1
    if len(start) < FEWEST:
        raise BadInput(
            f"run {run.id}: {len(start)} windows of {window_s:g} s with thruster inputs and a measured start, at least {FEWEST} are needed",
            "give a longer log, or a shorter --window",
        )
    first = np.array(start, dtype=np.int64)
    nu0, eta0, _ = start_states(run, first)
    at_samples = first[:, None] + np.arange(steps + 1)
    level = run.ok("phi") & run.ok("theta")
    seen = np.concatenate([run.stack(VELOCITIES), vertical(run.stack(("phi", "theta"))), run.stack(("z",))], axis=1)
    good = np.column_stack([*(run.ok(c) for c in VELOCITIES), level, level, level, run.ok("z")])
    measured, ok = seen[at_samples], good[at_samples]
    ok[:, 0] = False  # where the window begins, measured and simulated are the same
    return Record(run, actuation, first, steps, nu0, eta0, measured, ok, kinematics(run, vehicle, window_s))


def begun(one: Record, seconds: float) -> Record:
    """The record with nothing but the first ``seconds`` of each window."""
    steps = min(round(seconds / one.run.dt), one.steps)
    return replace(one, steps=steps, measured=one.measured[:, : steps + 1], ok=one.ok[:, : steps + 1])


def vertical(roll_pitch: Array) -> Array:
    """Body components (..., 3) of the unit vector that points down, from roll and pitch (..., 2): third row of the rotation (Fossen 2021, 2.31)."""
    euler = np.concatenate([roll_pitch, np.zeros_like(roll_pitch[..., :1])], axis=-1)
    return np.asarray(rotation_from_euler(euler)[..., 2, :])


def residual(one: Record, plant: Plant, beta: Array) -> Array:
    """Simulated minus measured (m, steps + 1, 10), 0 where nothing was measured. A window that leaves sane limits is NaN from there on."""
    lanes = np.tile(beta, (len(one.start), 1))
    motion = plant.simulate(one.actuation.inputs, one.start, one.steps, one.nu0, one.eta0, lanes)
    simulated = np.concatenate([motion.nu, vertical(motion.eta[..., 3:5]), motion.eta[..., 2:3]], axis=-1)
    stopped = (motion.stopped[:, None] >= 0) & (np.arange(one.steps + 1) >= motion.stopped[:, None])
    error = np.where(one.ok, simulated - one.measured, 0.0)
    return np.where(stopped[..., None] & one.ok, np.nan, error)


def rms(residuals: Sequence[Array], ok: Sequence[Flags]) -> dict[str, float]:
    """Root mean square by channel of the ``residuals`` (m, n, 10) of several runs, where ``ok``."""
    found = dict[str, float]()
    for i, name in enumerate(CHANNELS):
        error = np.concatenate([r[..., i][good[..., i]] for r, good in zip(residuals, ok, strict=True)])
        if len(error) and name != "down z":  # of a level vehicle it says nothing of roll and pitch
            found[LEVEL.get(name, name)] = float(np.sqrt(np.mean(error**2)))
    return found
