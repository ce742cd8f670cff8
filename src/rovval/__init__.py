"""rovval: where a simulator of a remotely operated vehicle and the real vehicle disagree, why, and by how much less once mended.

The functions of this file are the API for scripts and notebooks: `load`, `simulate`, `compare`, `diagnose`, `fit`, `fly`, and `plot` for what
each returns. They do what the commands of the same names do, without files: results are frozen objects, nothing is printed or
written, and every refusal is a `rovval.core.errors.RovvalError`. Libraries are imported by the first call that needs them.
"""

from __future__ import annotations

import sys
from types import FunctionType, ModuleType
from typing import TYPE_CHECKING

from rovval.core.version import __version__

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from rovval.core.data import Comparison, Run, SimResult
    from rovval.diagnose import Diagnosis
    from rovval.fit import FitResult
    from rovval.fly.flight import Flight
    from rovval.fly.mission import Mission
    from rovval.report.notebook import Page
    from rovval.vehicle.model import Vehicle

    AnyVehicle = Vehicle | str | Path | None

__all__ = ["__version__", "compare", "diagnose", "fit", "fly", "load", "plot", "simulate"]


def load(
    source: str | Path, profile: str | Path | None = None, archive: str | Path = "archive", *, start_s: float | None = None, end_s: float | None = None
) -> Run:
    """A log as a run: channels on a 10 Hz grid in SI, body axes forward-starboard-down, world north-east-down.

    Args:
        source: a log file or bag folder, or the id of a run in ``archive``.
        profile: how to read the log: a name of `rovval list profile` or a TOML file; None takes the one built-in profile that fits.
        start_s: where the stretch of it that is taken begins, s since the run's start; None is where the log begins.
        end_s: where it ends; None is where the log ends.

    Raises:
        BadInput: the log cannot be used, fits none or several of the built-in profiles, or the stretch is beyond it or empty.
        UsageProblem: there is no such profile, or it is wrong.
    """
    from pathlib import Path

    from rovval.alignment.stretch import stretch_of
    from rovval.storage.archive import open_run

    return stretch_of(open_run(source, None if profile is None else str(profile), Path(archive)), start_s, end_s)


def simulate(
    run: Run, vehicle: AnyVehicle = None, *, model: str = "fossen", effects: Sequence[str] = (), window_s: float = 10.0
) -> SimResult:
    """The motion of ``vehicle`` when it is driven by the thruster speeds of ``run``, free and in windows restarted every ``window_s`` s.

    Args:
        vehicle: a vehicle, a name of `rovval list vehicle` or a TOML file; None is the vehicle that the run names.
        effects: settings such as ``"inflow_loss:loss=0.3"`` beside those that the vehicle's file carries.

    Raises:
        BadInput: the run lacks thruster inputs, or states to start from.
        UsageProblem: unknown vehicle, model or effect, or a value out of bounds.
        SimulationStopped: no sample could be simulated.
    """
    from rovval import simulation

    return simulation.simulate(run, _vehicle(run, vehicle), model, effects, window_s)


def compare(run: Run, simulated: SimResult | AnyVehicle = None) -> Comparison:
    """How far a simulation is from ``run``, per axis: simulated minus measured, in SI, of the free run and of the restarted windows.

    Args:
        simulated: what `simulate` returned for this run, or a vehicle as `simulate` takes it.

    Raises:
        BadInput: the two have unlike numbers of rows, or nothing was both measured and simulated.
    """
    from rovval import comparison
    from rovval.core.data import SimResult

    return comparison.compare(run, simulated if isinstance(simulated, SimResult) else simulate(run, simulated))


def diagnose(
    runs: Run | Sequence[Run],
    vehicle: AnyVehicle = None,
    *,
    model: str = "fossen",
    window_s: float = 10.0,
    calibration_slop: float = 0.05,
    seed: int = 0,
    progress: Callable[[str, float], None] | None = None,
) -> Diagnosis:
    """Where the gap between ``vehicle``'s simulator and its logs lies, which effects cause it, and how far it shrinks with them.

    The result's ``sentence`` says it in words; ``verdict``, ``causes``, ``gap`` and the rest are its typed parts.

    Args:
        runs: one run, or several of one vehicle, which are then one experiment.
        vehicle: as `simulate` takes it.
        calibration_slop: relative standard deviation that a healthy simulator's coefficients may have.
        seed: of the bootstrap.
        progress: is called with what is being done and the share that is done, 0 to 1.

    Raises:
        BadInput: too little of the logs can be simulated, or thruster inputs are missing.
    """
    from rovval.diagnose.pipeline import diagnose
    from rovval.pipeline.steps import checked_against
    from rovval.report.diagnosis.json import document

    logs = _several(runs)
    nominal = _vehicle(logs[0], vehicle)
    logs = [checked_against(run, nominal) for run in logs]
    found = diagnose(
        logs, nominal, model=model, window_s=window_s, calibration_slop=calibration_slop, seed=seed, progress=progress
    )  # fmt: skip
    words = document(found)
    return found.model_copy(update={name: words[name] for name in ("answer", "sentence")})


def fit(
    runs: Run | Sequence[Run],
    parameters: Sequence[str],
    vehicle: AnyVehicle = None,
    *,
    model: str = "fossen",
    window_s: float = 10.0,
    progress: Callable[[str, float], None] | None = None,
) -> FitResult:
    """Chosen parameters of ``vehicle`` tuned to its logs by re-simulation, each with a 90 % interval; the rest stays within tolerance.

    Args:
        parameters: such as ``"quadratic_drag[surge]"``, or ``"quadratic_drag"`` for all its axes; `rovval list effect` has the names.
        vehicle: as `simulate` takes it.

    Raises:
        UsageProblem: names every parameter that does not exist, at once.
        BadInput: too little of the logs can be simulated.
    """
    from rovval.fit import fit

    logs = _several(runs)
    return fit(logs, _vehicle(logs[0], vehicle), parameters, model=model, window_s=window_s, progress=progress)


def fly(
    mission: Mission | str | Path,
    vehicle: AnyVehicle = None,
    *,
    model: str = "fossen",
    effects: Sequence[str] = (),
    noise: float = 1.0,
    draws: int = 0,
    seed: int = 0,
    calibration_slop: float = 0.05,
    progress: Callable[[str, float], None] | None = None,
) -> Flight:
    """A mission flown: planned thruster speeds, the movement protocol, or controllers and way points in the loop (docs/missions.md).

    The result's ``run()`` is a run that every other function of this file takes.

    Args:
        mission: a mission, one of those that come with rovval (``"survey"``) or a TOML file.
        vehicle: as `simulate` takes it; None is the vehicle that the mission names.
        effects: settings such as ``"current_constant:north=0.3"`` beside the mission's own.
        noise: factor on noise and bias of the mission's sensors; 0 closes the loop on the true state.
        draws: so many vehicles within the file's tolerances beside the one of the file.
        calibration_slop: relative standard deviation that a healthy simulator's coefficients may have, for the draws.

    Raises:
        UsageProblem: no such mission, vehicle, model or effect, or something of the mission that cannot be flown.
    """
    from rovval.core.errors import UsageProblem
    from rovval.fly import fly
    from rovval.fly.mission import Mission, load
    from rovval.vehicle import load as load_vehicle
    from rovval.vehicle.model import Vehicle

    plan = mission if isinstance(mission, Mission) else load(mission)
    if vehicle is None and not plan.vehicle:
        raise UsageProblem(f"mission {plan.name} names no vehicle", "give one")
    nominal = vehicle if isinstance(vehicle, Vehicle) else load_vehicle(str(vehicle or plan.vehicle))
    return fly(plan, nominal, model, effects, noise=noise, draws=draws, seed=seed, calibration_slop=calibration_slop, progress=progress)


def plot(result: Run | SimResult | Comparison | Diagnosis | FitResult | Flight) -> Page:
    """What `load`, `simulate`, `compare`, `diagnose`, `fit` or `fly` returned, as a page: a notebook shows it, ``.save(path)`` writes one file."""
    from rovval.report.notebook import page_of

    return page_of(result)


def _several(runs: Run | Sequence[Run]) -> list[Run]:
    from rovval.core.data import Run
    from rovval.core.errors import UsageProblem

    found = [runs] if isinstance(runs, Run) else list(runs)
    if not found:
        raise UsageProblem("no run was given", "give what `rovval.load` returns")
    return found


def _vehicle(run: Run, wanted: AnyVehicle) -> Vehicle:
    from rovval.pipeline.steps import vehicle_of
    from rovval.vehicle.model import Vehicle

    return wanted if isinstance(wanted, Vehicle) else vehicle_of(run, None if wanted is None else str(wanted))


class _Package(ModuleType):
    """This package. Importing a room binds its name here, and two rooms have the name of a function: these can then be called as it."""

    def __setattr__(self, name: str, value: object) -> None:
        function = self.__dict__.get(name)
        if isinstance(value, ModuleType) and isinstance(function, FunctionType):
            called = staticmethod(function)
            value.__class__ = type("Room", (ModuleType,), {"__call__": called, "__wrapped__": called})  # the latter for its signature
        super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Package
