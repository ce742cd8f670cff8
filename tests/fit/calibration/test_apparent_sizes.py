"""`apparent_sizes`: effects of the library are as large as they seem to be in the logs of a calibration, and a diagnosis blames none that is no larger."""

from __future__ import annotations

import functools

import numpy as np
import pytest
from diagnose_case import merlin, own
from scipy import stats

from rovval import effects
from rovval.fit.calibration.apparent_sizes import apparent_sizes, pooled_variances
from rovval.simulation.fitted_tolerances import fitted_sizes, with_sizes
from rovval.vehicle import parse
from rovval.vehicle.write import to_toml

WEAK, DRAG = "thruster_degraded[VFP].loss", "quadratic_drag[surge].scale"


@functools.cache
def found(loss: float, logs: int = 3) -> dict[str, float]:
    """Of logs in which one thruster is weaker than the vehicle's file says."""
    planted = (f"thruster_degraded[VFP]:loss={loss}",) if loss else ()
    return apparent_sizes([own(planted, seed, 100.0) for seed in range(1, logs + 1)], [merlin()] * logs, "fossen", 10.0)


def test_what_the_logs_have_is_found_in_its_size():
    """Three runs of 0.6 about the file's 0, beside one degree of freedom of which all other parameters say that it is next to none; of runs without any next to
    nothing is left. The tolerance of the drag takes a part of none of it."""
    typical = next(p.typical for p in effects.load("thruster_degraded").parameters if p.name == "loss")
    assert found(0.6)[WEAK] == pytest.approx(np.sqrt(3 * 0.6**2 / 4), rel=0.1)
    assert found(0.0)[WEAK] < 0.2 * typical


def test_what_a_new_run_has_is_as_far_out_as_is_said():
    """Parameters of which the variance differs as the prior has it, each seen with an error in three runs: the sizes that a new run has are Student's t of four
    degrees of freedom."""
    rng, k, error = np.random.default_rng(2), 4000, 0.02
    true = 0.1 / np.sqrt(rng.chisquare(1.0, k))
    seen = rng.normal(size=(3, k)) * true + rng.normal(size=(3, k)) * error
    sd = np.sqrt(pooled_variances(np.full((3, k), error**-2), seen / error**2))
    new = np.abs(rng.normal(size=k) * true / sd)
    for beyond in (0.5, 0.2, 0.1, 0.05):
        assert np.mean(new > stats.t.isf(beyond / 2.0, 4.0)) == pytest.approx(beyond, rel=0.15)


@pytest.mark.parametrize("scale", [0.05, 0.3])
def test_a_parameter_that_no_run_shows_is_as_large_as_the_others_are(scale: float):
    rng, error = np.random.default_rng(4), 0.02
    seen = rng.normal(size=(2, 200)) * scale / np.sqrt(rng.chisquare(1.0, 200)) + rng.normal(size=(2, 200)) * error
    curvature = np.full((2, 200), error**-2)
    curvature[:, 0] = 0.0
    sd = np.sqrt(pooled_variances(curvature, seen * curvature))
    assert sd[0] == pytest.approx(scale * np.sqrt(stats.chi2.median(3) / 3 / stats.chi2.median(1)), rel=0.25)


def test_one_run_says_nothing_of_the_next():
    """However little it shows: a parameter that it does not show is as large as is typical, but for the prior's form."""
    curvature = np.full((1, 50), 1e4)
    curvature[0, 0] = 0.0
    assert np.sqrt(pooled_variances(curvature, np.zeros((1, 50)))[0]) == pytest.approx(np.sqrt(stats.chi2.median(2) / 2 / stats.chi2.median(1)), rel=0.01)


def test_a_number_that_has_a_tolerance_is_asked_beside_the_others_and_not_beside_itself():
    typical = effects.load("quadratic_drag").parameters[0].typical
    assert DRAG in found(0.0) and 0.0 < found(0.0)[DRAG] < typical


def test_what_only_places_an_effect_has_no_size():
    places = {f"{name}.{p.name}" for name in effects.names() for p in effects.load(name).parameters if p.places}
    assert places and not places & set(found(0.0))


def test_more_runs_say_more():
    assert found(0.0, 1)[WEAK] > found(0.0)[WEAK]


def test_a_run_that_cannot_be_used_says_nothing():
    assert apparent_sizes([own((), 1, 5.0)], [merlin()], "fossen", 10.0) == {}


def test_the_file_remembers_them_and_a_new_calibration_replaces_them():
    vehicle = with_sizes(with_sizes(merlin(), {DRAG: 0.1}), {WEAK: 0.31234})
    assert fitted_sizes(parse(to_toml(vehicle), "calibrated")) == {WEAK: 0.3123}
    assert fitted_sizes(merlin()) == {}
