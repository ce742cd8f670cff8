"""`discrepancy`: forces that no equation has are as large as the logs of a calibration have them, and no diagnosis takes them for something new."""

from __future__ import annotations

import functools

import numpy as np
import pytest
from diagnose_case import merlin, own, without

from rovval.core.channels import AXES
from rovval.diagnose.inference.map_fit import healthy_fit
from rovval.diagnose.problem.problem import pose
from rovval.diagnose.residuals.perturbations import Columns
from rovval.diagnose.search.discrepancy import forces_beside
from rovval.diagnose.windows.multiple_shooting import cut
from rovval.fit.calibration.discrepancy import discrepancy
from rovval.fit.calibration.random_effects import variances
from rovval.simulation.fitted_tolerances import fitted_discrepancy, fitted_tolerances, with_discrepancy, with_tolerances
from rovval.vehicle import parse
from rovval.vehicle.write import to_toml

FOREIGN = ("cross_drag:yaw_to_sway=0.0,sway_to_yaw=0.3",)


@functools.cache
def found(planted: tuple[str, ...] = (), logs: int = 3) -> dict[str, float]:
    """Of logs with an effect that the vehicle's file does not have."""
    return discrepancy([own(planted, seed, 100.0) for seed in range(1, logs + 1)], [merlin()] * logs, "fossen", 10.0)


def test_sizes_of_each_group_are_found_with_the_scatter_of_a_sample():
    """Effects of two groups, drawn with a standard deviation of 2 and of 0.5, each seen with an error of 0.3."""
    rng, true, group = np.random.default_rng(3), np.array([2.0, 0.5]), np.repeat([0, 1], 40)
    runs = list[tuple[np.ndarray, np.ndarray, np.ndarray]]()
    for _ in range(3):
        seen = true[group] * rng.normal(size=80) + 0.3 * rng.normal(size=80)
        runs.append((np.eye(80) / 0.3**2, seen / 0.3**2, group))
    assert np.sqrt(variances(runs, np.ones(2))) == pytest.approx(true, rel=3.0 / np.sqrt(2 * 120))


@pytest.mark.slow
def test_a_foreign_force_shows_on_the_axes_where_it_acts():
    none, some = found(), found(FOREIGN)
    assert list(none) == [*AXES, *(f"{axis} damping" for axis in AXES)]
    assert some["yaw"] > 10.0 * none["yaw"] and some["heave"] < 2.0 * none["heave"]


def test_of_a_vehicle_without_a_velocity_log_no_damping_is_known_along_its_axes():
    runs = [without(own((), seed, 100.0), "u", "v", "w") for seed in (1, 2)]
    some = discrepancy(runs, [merlin()] * 2, "fossen", 10.0)
    assert "surge damping" not in some and "yaw damping" in some
    assert all(np.isfinite(x) and x > 0.0 for x in some.values())


def test_a_run_that_cannot_be_used_says_nothing():
    assert discrepancy([own((), 1, 5.0)], [merlin()], "fossen", 10.0) == {}


def test_the_file_remembers_it_beside_the_tolerances_and_a_new_calibration_replaces_it():
    vehicle = with_tolerances(with_discrepancy(with_discrepancy(merlin(), {"sway": 0.1}), {"heave": 0.31234}), {"inflow_loss.loss": 0.2})
    written = parse(to_toml(vehicle), "calibrated")
    assert fitted_discrepancy(written) == {"heave": 0.3123} and fitted_tolerances(written) == {"inflow_loss.loss": 0.2}
    assert fitted_discrepancy(merlin()) == {}


@pytest.mark.slow
def test_what_the_calibration_had_is_no_evidence_of_something_else():
    run, worth = own(FOREIGN, 5, 100.0), list[float]()
    for vehicle in (merlin(), with_discrepancy(merlin(), found(FOREIGN))):
        windows, _ = cut([run], vehicle, "fossen", 10.0)
        problem = pose(windows, Columns(()), 0.05)
        worth.append(forces_beside(problem, healthy_fit(problem)).evidence)
    assert worth[0] > 6.0 and worth[1] < 0.0
