"""`apparent_sizes`: effects of the library are as large as they seem to be in the logs of a calibration, and a diagnosis blames none that is no larger."""

from __future__ import annotations

import functools

import numpy as np
import pytest
from diagnose_case import merlin, own

from rovval import effects
from rovval.fit.calibration.apparent_sizes import apparent_sizes
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
    """Three runs of 0.6 about the file's 0, beside one degree of freedom at the typical size; of runs without any next to that alone is left. The tolerance of
    the drag takes a part of none of it."""
    typical = next(p.typical for p in effects.load("thruster_degraded").parameters if p.name == "loss")
    assert found(0.6)[WEAK] == pytest.approx(np.sqrt((3 * 0.6**2 + typical**2) / 4), rel=0.25)
    assert found(0.0)[WEAK] == pytest.approx(typical / 2.0, rel=0.25)


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
