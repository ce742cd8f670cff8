"""A calibrated vehicle's file says how far its thrusters were driven; a log that drives one a tenth further is told which, and by how much."""

from dataclasses import replace

import numpy as np
from report_cases import make_run

from rovval import vehicle
from rovval.core.data import Array, Run
from rovval.pipeline.steps import checked_against
from rovval.simulation.fitted_commands import beyond_fitted, fitted, largest
from rovval.vehicle import parse
from rovval.vehicle.model import Vehicle
from rovval.vehicle.write import to_toml

MERLIN = vehicle.load("merlin")


def speeds(run: Run) -> Array:
    return run.stack(tuple(f"n:{name}" for name in MERLIN.thrusters))


def calibrated(*runs: Run) -> Vehicle:
    """Merlin as if it had been calibrated on ``runs``, read back from its file."""
    commands = largest([speeds(run) for run in runs], MERLIN)
    return parse(to_toml(MERLIN.model_copy(update={"calibration": {"thrust.gain": 0.1, **commands}})), "calibrated")


def driven(factor: float, name: str = "n:VFP") -> Run:
    """A log whose thruster ``name`` turns ``factor`` times as fast as that of `make_run`."""
    run = make_run(600)
    return replace(run, values={**run.values, name: factor * run.values[name]})


def test_the_largest_command_of_all_logs_is_remembered_ahead_and_astern():
    found = fitted(calibrated(driven(0.5), make_run(600)))
    top = 60.0 * np.array([speeds(make_run(600)).max(axis=0), -speeds(make_run(600)).min(axis=0)])
    for k, name in enumerate(MERLIN.thrusters):
        for way, rpm in zip(("ahead", "astern"), top[:, k], strict=True):
            assert abs(found[f"command.{way}[{name}]"] - max(rpm, 0.0)) < 0.1
    assert calibrated(make_run(600)).hash == MERLIN.hash, "it moves nothing"


def test_a_log_within_a_tenth_of_them_is_not_told():
    known = calibrated(make_run(600))
    assert beyond_fitted(make_run(600), known) == ()
    assert beyond_fitted(driven(1.08), known) == ()


def test_a_thruster_that_is_driven_further_is_told_with_how_far():
    known = calibrated(make_run(600))
    run = driven(1.3)
    [found] = beyond_fitted(run, known)
    assert (found.code, found.where) == ("beyond_fit", "VFP")
    assert "30 % beyond" in found.detail
    assert f"{fitted(known)['command.ahead[VFP]']:.4g} rpm" in found.detail
    beside = checked_against(run, known)
    assert found in beside.findings
    assert checked_against(beside, known).findings == beside.findings, "said once"


def test_a_thruster_that_hardly_turned_is_held_against_the_others():
    """Noise of a speed that was zero in the fit is no command; a true one is."""
    known = calibrated(driven(0.0))
    idle = 0.05 * max(fitted(known).values()) / 60.0
    run = make_run(600)
    assert beyond_fitted(replace(run, values={**run.values, "n:VFP": np.full(600, idle)}), known) == ()
    [found] = beyond_fitted(run, known)
    assert found.where == "VFP"
    assert "next to nothing" in found.detail


def test_a_file_that_was_not_calibrated_tells_nothing():
    assert beyond_fitted(driven(9.0), MERLIN) == ()
