"""`tolerances`: what every vehicle has to some degree, and no file states, is as large as the logs have it; and a diagnosis blames none of that."""

from __future__ import annotations

import functools

import numpy as np
import pytest
from diagnose_case import merlin, own

from rovval import effects
from rovval.diagnose import diagnose
from rovval.fit.random_effects import tolerances
from rovval.simulation.fitted_tolerances import fitted_tolerances, with_tolerances
from rovval.vehicle import parse
from rovval.vehicle.write import to_toml

LOSS = "inflow_loss.loss"


@functools.cache
def found(loss: float, logs: int = 3) -> dict[str, float]:
    """Of logs in which thrust is lost under way and the vehicle's file says nothing of it."""
    planted = (f"inflow_loss:loss={loss}",) if loss else ()
    return tolerances([own(planted, seed, 100.0) for seed in range(1, logs + 1)], [merlin()] * logs, "fossen", 10.0)


def test_what_the_logs_have_is_found_in_its_size():
    """Three runs of 0.3 about the file's 0, beside one degree of freedom at the typical size of 0.15; of runs without any next to that alone is left. What is
    like it, weaker thrust say, has a part of it."""
    size = effects.load("inflow_loss").parameters[0].typical
    whole = np.sqrt((3 * 0.3**2 + size**2) / 4)
    assert 0.7 * whole < found(0.3)[LOSS] < 1.05 * whole
    assert found(0.0)[LOSS] < 0.6 * size
    assert found(0.0)[LOSS] == pytest.approx(size / 2.0, rel=0.2)


def test_they_are_of_the_effects_of_which_every_vehicle_has_some():
    of = {key.partition(".")[0].partition("[")[0] for key in found(0.0)}
    assert LOSS in found(0.0) and all(effects.load(name).option for name in of)


def test_more_runs_say_more():
    assert found(0.0, 1)[LOSS] > found(0.0)[LOSS]


def test_a_run_that_cannot_be_used_says_nothing():
    assert tolerances([own((), 1, 5.0)], [merlin()], "fossen", 10.0) == {}


def test_the_file_remembers_them_and_a_new_calibration_replaces_them():
    vehicle = with_tolerances(with_tolerances(merlin(), {"cross_drag.surge_to_yaw": 0.1}), {LOSS: 0.31234})
    assert fitted_tolerances(parse(to_toml(vehicle), "calibrated")) == {LOSS: 0.3123}
    assert fitted_tolerances(merlin()) == {}


@pytest.mark.slow
def test_a_diagnosis_blames_nobody_for_what_the_calibration_s_own_logs_had():
    run = own(("inflow_loss:loss=0.3",), 5, 100.0)
    assert [c.effect for c in diagnose([run], merlin()).causes] == ["inflow_loss"]
    assert diagnose([run], with_tolerances(merlin(), {LOSS: 0.3})).causes == ()
