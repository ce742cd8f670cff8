"""What the commands and the batch do with one log: each step a call of the room below it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from rovval.core.errors import BadInput, UsageProblem

if TYPE_CHECKING:
    from rovval.core.data import Array, Comparison, Run, SimResult
    from rovval.diagnose.result.diagnosis import Diagnosis
    from rovval.vehicle.model import Vehicle

DAY_S = 86400.0
TIME_OF_DAY = "time_of_day_s_at_start"  # what ingest notes of a clock without a date


def vehicle_of(run: Run, wanted: str | None) -> Vehicle:
    """The vehicle that was asked for, else the one that the run names."""
    from rovval import vehicle

    if wanted or run.vehicle:
        return vehicle.load(wanted or run.vehicle)
    raise UsageProblem(
        f"run {run.id} (profile {run.profile!r}) names no vehicle",
        f"add --vehicle with one of {', '.join(vehicle.names())}, or a path to a .toml file",
    )


def checked_against(run: Run, vehicle: Vehicle) -> Run:
    """The run with what it shows beside the vehicle's own file among its findings: speeds beyond its limits or
    beyond the logs that it was fitted on, thrusters that lack an input."""
    from dataclasses import replace

    from rovval.simulation.actuation import replaced_input
    from rovval.simulation.fitted_commands import beyond_fitted
    from rovval.simulation.sanity_limits import overspeed, thrust_against_motion

    beside = (*replaced_input(run, vehicle), *overspeed(run, vehicle), *thrust_against_motion(run, vehicle), *beyond_fitted(run, vehicle))
    return replace(run, findings=tuple(dict.fromkeys((*run.findings, *beside))))


def other_velocities(path: Path, run: Run, profile: str | None, archive: Path, timezone: str | None = None) -> Array:
    """Body velocities of another simulation of ``run`` on its grid (n, 6), NaN where there is none.

    ``path`` is a parquet file of `rovval simulate` or any file that a profile reads, in the ``timezone`` of the log.
    """
    import numpy as np

    from rovval.core.channels import VELOCITIES
    from rovval.simulation.file import load_simulation
    from rovval.storage.archive import open_run

    if not path.exists():
        raise UsageProblem(f"{path} does not exist", "give --with a .parquet of `rovval simulate` or a log of velocities")
    if path.suffix == ".parquet":
        nu = load_simulation(path).free.nu
        if len(nu) != len(run):
            raise BadInput(f"{path}: {len(nu)} samples, run {run.id} has {len(run)}", "give the simulation of this run")
        return nu
    other = open_run(str(path), profile, archive, timezone)
    if not any(other.measured(name) for name in VELOCITIES):
        raise BadInput(
            f"{path}: holds none of {', '.join(VELOCITIES)} by profile {other.profile!r}",
            "name its profile with --with-profile",
        )
    shift = _shift(run, other)
    nu = np.full((len(run), len(VELOCITIES)), np.nan)
    first, last = max(shift, 0), min(shift + len(other), len(run))
    if first >= last:
        raise BadInput(f"{path}: its stamps do not overlap those of run {run.id}", "give the simulation of this run")
    nu[first:last] = other.stack(VELOCITIES)[first - shift : last - shift]
    return nu


def _shift(run: Run, other: Run) -> int:
    """Grid point of ``run`` at which ``other`` begins, by the clock that both know; without one they must be equally long."""
    if run.t0_ns is not None and other.t0_ns is not None:
        return round((other.t0_ns - run.t0_ns) * 1e-9 / run.dt)
    if TIME_OF_DAY in run.properties and TIME_OF_DAY in other.properties:
        late = _seconds_of_day(other) - _seconds_of_day(run)
        return round(((late + DAY_S / 2) % DAY_S - DAY_S / 2) / run.dt)
    if len(run) == len(other):
        return 0
    raise BadInput(
        f"{other.source}: {len(other)} samples against {len(run)} of run {run.id}, and no clock that both know",
        "give both the same kind of stamps, or a file of the same rows",
    )


def _seconds_of_day(run: Run) -> float:
    return float(run.properties[TIME_OF_DAY]) + float(run.properties["grid_start_s"])


def simulated(run: Run, vehicle: Vehicle, model: str, effects: Sequence[str], window_s: float) -> SimResult:
    """`rovval.simulation.simulate`, imported when called."""
    from rovval.simulation import simulate

    return simulate(run, vehicle, model, effects, window_s)


def before_and_after(found: Diagnosis, run: Run, vehicle: Vehicle) -> tuple[Comparison, SimResult | None]:
    """The run beside its simulation, and its simulation with the causes that were ``found``; None where there are none. Raises as `simulate` does."""
    from rovval.comparison import compare

    corrected = simulated(run, vehicle, found.model, found.settings, found.window_s) if found.settings else None
    return compare(run, simulated(run, vehicle, found.model, (), found.window_s)), corrected
