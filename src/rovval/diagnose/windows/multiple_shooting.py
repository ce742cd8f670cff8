"""Multiple shooting (Bock 1981): a run cut into short windows, each simulated from its own measured state.

A window of 10 s is three to five time constants of surge of an observation-class ROV: long enough for a missing force to show as a
velocity error, short enough that the initial state does not decide the outcome.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from rovval.alignment.duplicates import duplicates
from rovval.core.data import Flags, Run
from rovval.core.errors import BadInput, all_at_once
from rovval.diagnose.criteria import FEW_WINDOWS, LEAST_WINDOWS, MEASURED_SHARE
from rovval.diagnose.effort import STIFFER
from rovval.diagnose.windows.conditioning import condition
from rovval.diagnose.windows.contact import in_contact
from rovval.diagnose.windows.noise import clean_channels, sample_strides
from rovval.diagnose.windows.windows import Windows, residual_channels
from rovval.simulation.actuation import recorded_actuation, start_states, startable
from rovval.simulation.step import stable_plant
from rovval.vehicle.model import Vehicle


def cut(runs: Sequence[Run], vehicle: Vehicle, model: str, window_s: float) -> tuple[tuple[Windows, ...], tuple[str, ...]]:
    """Cut runs of ``vehicle`` into windows of one length: the longest of ``window_s`` (s), its half and its quarter that suits all of them.

    ``model`` is the platform whose plant simulates them. Returns the windows of each run, and for each run that is too short the reason why it was left out.

    Raises:
        BadInput: no run can be cut, or the runs differ in the channels that they hold.
    """
    if twice := [f"run {runs[later].id} holds the same samples as run {runs[earlier].id}" for earlier, later in duplicates(runs)]:
        raise BadInput(all_at_once(twice, "a log is given twice"), "give each log once, by whatever name: a copy adds no evidence")
    windows, left_out = list[Windows](), list[str]()
    for run in (condition(one)[0] for one in runs):
        try:
            windows.append(cut_run(run, vehicle, model, window_s))
        except BadInput as error:
            if len(runs) == 1:
                raise
            left_out.append(error.message)
    if not windows:
        raise BadInput(all_at_once(left_out, "no log can be diagnosed"), "use longer logs")
    shortest = min(own.steps + 1 for own in windows)
    same = tuple(own if own.steps + 1 == shortest else _cut(own.run, vehicle, model, shortest * own.run.dt) for own in windows)
    if len({own.channels for own in same}) > 1:
        held = "; ".join(f"{own.run.id}: {', '.join(own.channels)}" for own in same)
        raise BadInput(f"the logs hold different channels and cannot be diagnosed together ({held})", "diagnose them one by one")
    return same, tuple(left_out)


def cut_run(run: Run, vehicle: Vehicle, model: str, window_s: float) -> Windows:
    """Cut a run into windows of ``window_s``, or of half or a quarter of it where a short log gives too few.

    Raises:
        BadInput: fewer than `LEAST_WINDOWS` windows can be simulated; says how many and why.
    """
    for share in (1.0, 0.5):
        try:
            windows = _cut(run, vehicle, model, share * window_s)
        except BadInput:
            continue
        if windows.count >= FEW_WINDOWS:
            return windows
    return _cut(run, vehicle, model, 0.25 * window_s)


def _cut(run: Run, vehicle: Vehicle, model: str, window_s: float) -> Windows:
    """The windows of ``window_s`` (s) in which inputs are known, the vehicle is out of contact and enough is measured; raises as `cut_run`."""
    driven = recorded_actuation(run, vehicle)
    plant = stable_plant(vehicle, model, driven.inputs.speed, run.dt, STIFFER)
    channels = residual_channels(run)
    steps = round(window_s / run.dt) - 1
    contact = in_contact(run, driven)
    values, good, noise, outlier = clean_channels(run, channels)
    start = _starts(driven.known & ~contact, startable(run) & ~outlier, steps)
    inside = start[:, None] + np.arange(steps + 1)[None, :]
    possible = np.mean([1.0 / stride for stride in sample_strides(run, channels)])
    enough = good[inside].mean(axis=(1, 2)) >= MEASURED_SHARE * possible if len(start) else np.zeros(0, dtype=bool)
    start = start[enough]
    if len(start) < LEAST_WINDOWS:
        raise BadInput(
            f"run {run.id}: {len(start)} windows of {window_s:g} s hold inputs and measurements throughout, at least {LEAST_WINDOWS} are needed",
            "use a longer log, a shorter --window, or look at the gaps with `rovval compare`",
        )
    inside = start[:, None] + np.arange(steps + 1)[None, :]
    nu0, eta0, _ = start_states(run, start)
    return Windows(
        run, plant, driven, channels, start, steps, nu0, eta0, values[inside], good[inside], noise, int(outlier.sum()), float(contact.sum() * run.dt)
    )


def _starts(known: Flags, ready: Flags, steps: int) -> NDArray[np.int64]:
    """First sample of each window: as many as fit, each from a startable point with known inputs throughout."""
    blocked = np.concatenate([[0], np.cumsum(~known)])
    starts, at = [], 0
    while at + steps < len(known):
        if ready[at] and blocked[at + steps + 1] == blocked[at]:
            starts.append(at)
            at += steps + 1
        else:
            at += 1
    return np.array(starts, dtype=np.int64)
