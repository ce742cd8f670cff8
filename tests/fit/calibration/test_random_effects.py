"""`tolerances`: what a vehicle is off by from run to run is as large as its logs have it, each number and all together; and a diagnosis blames none of it."""

from __future__ import annotations

import functools

import numpy as np
import pytest
from diagnose_case import merlin, own
from scipy import stats

from rovval import effects
from rovval.core.data import Array
from rovval.core.errors import BadVehicle
from rovval.diagnose import diagnose
from rovval.fit.calibration.random_effects import covariance, tolerances
from rovval.simulation.fitted_tolerances import fitted_correlation, fitted_tolerances, with_tolerances
from rovval.vehicle import parse
from rovval.vehicle.write import to_toml

LOSS = "inflow_loss.loss"


@functools.cache
def found(loss: float, logs: int = 3) -> tuple[dict[str, float], Array]:
    """Of logs in which thrust is lost under way and the vehicle's file says nothing of it: standard deviations and correlations."""
    planted = (f"inflow_loss:loss={loss}",) if loss else ()
    return tolerances([own(planted, seed, 100.0) for seed in range(1, logs + 1)], merlin(), "fossen", 10.0)


def test_what_the_logs_have_is_found_in_its_size():
    """Three runs of 0.3 about the file's 0, whose squares count twice, since a calibration on three is so much nearer to them than to a fourth, beside one
    degree of freedom at the typical size of 0.15; of runs without any next to that alone is left. What is like it, weaker thrust say, has a part of it."""
    size = effects.load("inflow_loss").parameters[0].typical
    whole = np.sqrt((2 * 3 * 0.3**2 + size**2) / 4)
    lossy, sound = found(0.3)[0][LOSS], found(0.0)[0][LOSS]
    assert 0.7 * whole < lossy < 1.05 * whole
    assert sound < 0.6 * size
    assert sound == pytest.approx(size / 2.0, rel=0.2)


def test_they_are_of_the_vehicle_s_own_numbers_and_of_the_effects_of_which_every_vehicle_has_some():
    of = {key: effects.load(key.partition(".")[0].partition("[")[0]) for key in found(0.0)[0]}
    assert {LOSS, "quadratic_drag[surge].scale", "rpm_scale.scale"} <= set(of)
    assert all(one.place != "sensor" and (one.option or one.parameters[0].tolerance is not None) for one in of.values())


def test_more_runs_say_more_and_one_alone_says_nothing_of_the_next():
    sd, correlation = found(0.0, 1)
    assert sd[LOSS] == effects.load("inflow_loss").parameters[0].typical and not np.tril(correlation, -1).any()
    assert sd[LOSS] > found(0.0, 2)[0][LOSS] > found(0.0)[0][LOSS]


def test_a_run_that_cannot_be_used_says_nothing():
    assert tolerances([own((), 1, 5.0)], merlin(), "fossen", 10.0)[0] == {}


def test_what_runs_know_together_is_known_better_than_each_by_itself():
    """Drag on an axis as a whole, whether linear or quadratic."""
    sd, correlation = found(0.0)
    assert np.allclose(np.diag(correlation), 1.0) and np.linalg.eigvalsh(correlation).min() > 0.0
    for axis in ("surge", "heave"):
        linear, quadratic = (list(sd).index(f"{name}_drag[{axis}].scale") for name in ("linear", "quadratic"))
        assert correlation[linear, quadratic] < -0.2


def test_runs_that_agree_narrow_it_by_their_number_and_those_that_do_not_widen_it():
    """Three runs that all see a sum to be as it was, and nothing else; then three that each see it elsewhere."""
    way, across = np.full(4, 0.5), np.array([1.0, -1.0, 0.0, 0.0]) / np.sqrt(2.0)
    seen = 1e4 * np.outer(way, way)
    agree = covariance([(seen, np.zeros(4))] * 3)
    assert way @ agree @ way == pytest.approx(1.0 / 4.0, abs=0.01)
    assert across @ agree @ across == pytest.approx(1.0, abs=0.01)
    apart = (-2.0, 2.0, 1.5)
    wider = covariance([(seen, seen @ (way * far)) for far in apart])
    assert way @ wider @ way == pytest.approx((1.0 + 2.0 * sum(far**2 for far in apart)) / 4.0, rel=0.01)
    assert across @ wider @ across == pytest.approx(1.0, abs=0.01)


def test_the_next_run_is_off_by_as_much_as_is_said():
    """Coverage: of many vehicles, each calibrated on the mean of three runs that differ with variance one, as other vehicles do, how far a fourth is from that,
    over the standard deviation that is said: Student's t of three degrees of freedom."""
    rng, off = np.random.default_rng(3), list[float]()
    for _ in range(2000):
        runs = rng.normal(size=4)
        asked = [(np.full((1, 1), 1e4), np.full(1, 1e4 * (own - runs[:3].mean()))) for own in runs[:3]]
        off.append(float((runs[3] - runs[:3].mean()) ** 2 / covariance(asked)[0, 0]))
    within = np.mean(np.array(off) < stats.t.ppf(0.95, 3) ** 2)
    assert within == pytest.approx(0.90, abs=0.03)


def test_the_file_remembers_them_and_a_new_calibration_replaces_them():
    both = {"rpm_scale.scale": 0.01, LOSS: 0.31234}
    before = with_tolerances(merlin(), {"cross_drag.surge_to_yaw": 0.1})
    vehicle = parse(to_toml(with_tolerances(before, both, np.array([[1.0, -0.25], [-0.25, 1.0]]))), "calibrated")
    assert fitted_tolerances(vehicle) == {"rpm_scale.scale": 0.01, LOSS: 0.3123} and vehicle.hash == merlin().hash
    keys, correlation = fitted_correlation(vehicle)
    assert keys == tuple(both) and correlation.tolist() == [[1.0, -0.25], [-0.25, 1.0]]
    assert fitted_tolerances(merlin()) == {} and fitted_correlation(with_tolerances(vehicle, both))[0] == ()


def test_what_is_known_well_together_is_still_known_when_it_is_read_again():
    """Seventy numbers of which runs know some combinations far better than any by itself, as on tank runs: digits that the file leaves out do not blur them."""
    rng, count = np.random.default_rng(4), 70
    way = np.linalg.qr(rng.normal(size=(count, count)))[0]
    known = (way * np.geomspace(1e-4, 1.0, count)) @ way.T
    sd = np.sqrt(np.diag(known))
    correlation = known / np.outer(sd, sd)
    vehicle = with_tolerances(merlin(), {f"a{i}": 1.0 for i in range(count)}, correlation)
    again = fitted_correlation(parse(to_toml(vehicle), "again"))[1]
    assert np.linalg.inv(again).diagonal() == pytest.approx(np.linalg.inv(correlation).diagonal(), rel=1e-3)


@pytest.mark.parametrize(("rows", "said"), [((0.5, 0.2), "2 numbers, 1 expected"), ((1.5,), "not positive definite")])
def test_correlations_that_cannot_be_are_refused(rows: tuple[float, ...], said: str):
    text = to_toml(merlin().model_copy(update={"tolerance_correlation": {"rpm_scale.scale": (), LOSS: rows}}))
    with pytest.raises(BadVehicle, match=said):
        parse(text, "broken")


@pytest.mark.slow
def test_a_diagnosis_blames_nobody_for_what_the_calibration_s_own_logs_had():
    run = own(("inflow_loss:loss=0.3",), 5, 100.0)
    assert [c.effect for c in diagnose([run], merlin()).causes] == ["inflow_loss"]
    assert diagnose([run], with_tolerances(merlin(), {LOSS: 0.3})).causes == ()
