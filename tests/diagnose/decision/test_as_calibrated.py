"""A vehicle as it was calibrated: what the calibration left of its own logs is no cause, and a gap that has grown since then is one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from diagnose_case import merlin, posed
from scipy import integrate, stats

from rovval.diagnose.criteria import (
    CALIBRATED_SPREAD,
    FORCE_ALIKE,
    FORCE_RIGHT,
    PRIOR_CAUSES,
    PRIOR_HEALTHY,
    PRIOR_SOMETHING_ELSE,
)
from rovval.diagnose.decision.as_calibrated import odds_as_calibrated, sizes_as_they_were
from rovval.diagnose.decision.open_gap import open_gap
from rovval.diagnose.decision.posterior import probabilities
from rovval.diagnose.decision.resemblance import Left, gap_left, unlogged_where_they_act
from rovval.diagnose.hypotheses.hypothesis import Hypothesis
from rovval.diagnose.inference.gap import calibrated_by_part, errors_by_part, noise_by_part, spread_as_calibrated
from rovval.diagnose.inference.hypothesis_fit import fit_hypothesis
from rovval.diagnose.inference.map_fit import healthy_fit
from rovval.diagnose.problem.problem import Problem, corrected_residuals
from rovval.diagnose.search.model import Model, ModelPrior
from rovval.fit.calibration.record import rms
from rovval.plant import Plant
from rovval.simulation.fitted_errors import fitted_errors, kept

LOSS = frozenset({"inflow_loss"})


def remembering(problem: Problem, error: dict[str, float]) -> Problem:
    """The problem of a vehicle whose file has the ``error`` of its calibration by channel."""
    vehicle = merlin().model_copy(update={"calibration": {f"error.{channel}": x for channel, x in error.items()}})
    return replace(problem, runs=tuple(replace(windows, plant=Plant(vehicle, "fossen")) for windows in problem.runs))


def test_without_a_calibration_nothing_is_as_it_was():
    assert odds_as_calibrated((), PRIOR_CAUSES, 0.7) == odds_as_calibrated((), PRIOR_SOMETHING_ELSE, 0.7) == 0.0
    problem, _ = posed(("inflow_loss:loss=0.3",))
    assert not any(calibrated_by_part(problem).values()) and gap_left(problem, []).grown == {}


@pytest.mark.parametrize("spread", [0.2, 0.7, 1.7])
def test_the_odds_are_a_ratio_of_two_distributions(spread: float):
    """Of the logarithm of the gap: normal, over that and an exponential one together."""
    for size in (-2.0, -0.3, 0.0, 1.0, 3.0):
        found = odds_as_calibrated((float(np.exp(size)),), PRIOR_CAUSES, spread) * PRIOR_CAUSES / PRIOR_HEALTHY
        assert found == pytest.approx(stats.norm.pdf(size, scale=spread) / stats.exponnorm.pdf(size, 1.0 / spread, scale=spread), rel=1e-6, abs=2e-9)


def test_a_gap_as_large_as_it_was_is_the_vehicle_and_a_larger_one_is_not():
    odds = [odds_as_calibrated((grown,), PRIOR_CAUSES, 0.7) for grown in (0.3, 1.0, 2.0, 8.0, 30.0)]
    assert odds[0] > odds[1] > 1.0 > odds[3] > odds[4] and odds[3] < 0.2 and odds[4] < 1e-3
    assert odds_as_calibrated((1.0,), PRIOR_SOMETHING_ELSE, 0.7) > 5.0 * odds[1]  # of which there was less beforehand


@pytest.mark.parametrize("freedom", [2.0, 4.0])
def test_what_sizes_say_is_a_ratio_of_two_distributions(freedom: float):
    """Student's t, over the same scaled by the root of a growth whose logarithm is exponential."""
    for size in (0.0, 0.7, 3.0, 20.0):
        wider, _ = integrate.quad(lambda y, x=size: np.exp(-1.5 * y) * stats.t.pdf(x * np.exp(-0.5 * y), freedom), 0.0, 60.0)
        assert sizes_as_they_were((size,), freedom) == pytest.approx(stats.t.pdf(size, freedom) / wider, rel=1e-3)


def test_a_cause_as_large_as_it_seemed_to_be_is_the_vehicle_and_a_larger_one_is_not():
    """The sooner, the more runs say how large it seemed; and it may have come in any one of several."""
    ratio = [sizes_as_they_were((size,), 4.0) for size in (0.0, 1.0, 3.0, 6.0, 12.0)]
    assert ratio[0] > ratio[1] > 1.0 > ratio[2] > ratio[3] > ratio[4] and ratio[4] < 0.06
    assert sizes_as_they_were((6.0,), 2.0) > ratio[3] > sizes_as_they_were((6.0,), 8.0)
    assert ratio[3] < sizes_as_they_were((0.0, 6.0), 4.0) < 1.0
    assert sizes_as_they_were((), 4.0) == 1.0


@pytest.mark.parametrize("size", [0.5, 12.0])
def test_causes_are_believed_where_they_are_larger_than_they_seemed(size: float):
    prior = ModelPrior.of([Hypothesis(n, n, (), (), ()) for n in ("inflow_loss", "dvl_scale")])
    causes = (Hypothesis("inflow_loss", "inflow_loss", (), (), ()),)
    models = [Model((), None, 0.0, prior.log_mass(())), Model(causes, None, 80.0, prior.log_mass(causes))]
    left = Left({LOSS: np.full(2, 0.2)}, {LOSS: (0.2, 1e-6)}, {LOSS: 1.0}, {"surge": 1.0}, sizes={LOSS: (size,)}, freedom=4.0)
    found = probabilities(models, {}, 0.0, {}, {}, left=left)
    assert found.healthy > found.causes if size < 1.0 else found.said == "causes"


def test_something_else_is_at_work_on_one_axis_though_the_others_are_as_they_were():
    still, one, more = (odds_as_calibrated((1.0, 1.0, size, 1.0), PRIOR_SOMETHING_ELSE, 0.7) for size in (1.0, 8.0, 50.0))
    assert still > one > 1.0 > 0.1 > more


@pytest.mark.parametrize("grown", [1.0, 20.0])
def test_causes_of_a_vehicle_as_it_was_calibrated_are_not_believed(grown: float):
    prior = ModelPrior.of([Hypothesis(n, n, (), (), ()) for n in ("inflow_loss", "dvl_scale")])
    causes = (Hypothesis("inflow_loss", "inflow_loss", (), (), ()),)
    models = [Model((), None, 0.0, prior.log_mass(())), Model(causes, None, 80.0, prior.log_mass(causes))]
    left = Left({LOSS: np.full(2, 0.5)}, {LOSS: (0.5, 1e-6)}, {LOSS: grown}, {"surge": grown})
    found = probabilities(models, {}, 60.0, {}, {}, left=left)
    assert found.healthy + found.causes + found.unexplained == pytest.approx(1.0)
    assert (found.said == "healthy") == (grown < 2.0)
    assert found.causes < 0.3 if grown < 2.0 else found.causes > 0.6


def test_a_force_is_as_calibrated_where_it_acts():
    """A gap that has grown on another axis says nothing of it; of what acts nowhere in particular any axis does."""
    axes = {"surge": 20.0, "yaw": 1.0}
    ahead, turning, anywhere = (Left({}, {}, {}, axes, forced).grown_since(frozenset()) for forced in (("surge",), ("yaw",), ()))
    assert (ahead, turning, anywhere) == ((20.0,), (1.0,), (20.0, 1.0))
    healthy = [Model((), None, 0.0, ModelPrior.of([Hypothesis("inflow_loss", "inflow_loss", (), (), ())]).log_mass(()))]
    found = [probabilities(healthy, {}, 60.0, {}, {}, left=Left({}, {}, {}, axes, (axis,))).said for axis in axes]
    assert found == [None, "healthy"]


def test_causes_that_close_nothing_have_no_probability_and_none_below_it():
    """-0.0 had been printed: what is left of them is a difference of two numbers that are the same but for rounding."""
    prior = ModelPrior.of([Hypothesis(n, n, (), (), ()) for n in ("inflow_loss", "dvl_scale")])
    causes = (Hypothesis("inflow_loss", "inflow_loss", (), (), ()),)
    models = [Model((), None, 0.0, prior.log_mass(())), Model(causes, None, 80.0, prior.log_mass(causes))]
    for grown in np.geomspace(0.3, 30.0, 40):
        found = probabilities(models, {}, 60.0, {}, {}, left=Left({LOSS: np.ones(2)}, {LOSS: (1.0, 1e-6)}, {LOSS: float(grown)}, {"surge": float(grown)}))
        assert found.causes == 0.0 and str(found.causes) == "0.0"


def test_what_a_calibration_left_is_in_the_metric_of_the_gap():
    """A vehicle that left just the errors of this log has a gap that is once what it was, wherever a cause acts; one that left half of them, four times."""
    problem, _ = posed(("inflow_loss:loss=0.3",))
    nominal, noise = errors_by_part(problem, corrected_residuals(problem), problem.origin), noise_by_part(problem)
    [windows] = problem.runs
    [residual] = corrected_residuals(problem)
    error = {c: float(np.sqrt(np.mean(residual[..., i][windows.ok[..., i]] ** 2))) for i, c in enumerate(windows.channels)}
    whole = calibrated_by_part(remembering(problem, error))
    for axis in ("surge", "sway", "heave"):
        assert whole[axis] == pytest.approx(nominal[axis] - noise[axis], rel=0.5)
    slots = tuple(i for i, s in enumerate(problem.plant.slots) if s.hypothesis == "inflow_loss")
    fit = fit_hypothesis(problem, problem.origin, slots)
    models = [Model((Hypothesis("inflow_loss", "inflow_loss", slots, (), ()),), fit, fit.evidence, 0.0)]
    once, twice = (remembering(problem, {c: x / by for c, x in error.items()}) for by in (1.0, 2.0))
    [grown], [more] = (gap_left(one, models).grown_since(LOSS) for one in (once, twice))
    assert grown == pytest.approx(1.0, rel=0.35) and more > 3.0 * grown


def test_sizes_are_beside_those_that_the_calibration_s_logs_seemed_to_have():
    """In standard deviations of these and of the fit's own error; of a vehicle without them nothing is known."""
    problem, _ = posed(("inflow_loss:loss=0.3",))
    slots = tuple(i for i, s in enumerate(problem.plant.slots) if s.hypothesis == "inflow_loss")
    fit = fit_hypothesis(problem, problem.origin, slots)
    models = [Model((Hypothesis("inflow_loss", "inflow_loss", slots, (), ()),), fit, fit.evidence, 0.0)]
    known = merlin().model_copy(update={"calibration": {"error.u": 0.01, "apparent.inflow_loss.loss": 0.1, "error_runs": 3.0}})
    calibrated = replace(problem, runs=tuple(replace(windows, plant=Plant(known, "fossen")) for windows in problem.runs))
    left = gap_left(calibrated, models)
    [size] = left.sizes_since(LOSS)
    assert 0.8 * fit.beta[slots[0]] / 0.1 < size < fit.beta[slots[0]] / 0.1 and left.freedom == 4.0
    assert gap_left(problem, models).sizes_since(LOSS) == gap_left(remembering(problem, {"u": 0.1}), models).sizes_since(LOSS) == ()


def test_an_unlogged_force_as_large_as_the_calibration_left_is_expected():
    """Where all of the gap on an axis was there when the vehicle was calibrated, so was the force that it takes."""
    problem, _ = posed(("inflow_loss:loss=0.3",))
    nominal = dict.fromkeys(("surge", "sway", "heave", "roll", "pitch", "yaw"), 0.5)
    known = remembering(problem, {"u": 10.0})
    ahead, down = (unlogged_where_they_act(known, nominal | {axis: 0.1}, nominal, wanders=False) for axis in ("surge", "heave"))
    assert ahead == pytest.approx((0.1, FORCE_RIGHT + 0.5, FORCE_ALIKE + 0.5)) and down == pytest.approx((0.1, FORCE_RIGHT, FORCE_ALIKE))


def test_what_a_calibration_left_is_no_open_gap():
    problem, _ = posed(("inflow_loss:loss=0.3",))
    healthy = healthy_fit(problem)
    assert open_gap(remembering(problem, {"u": 0.1, "r": 0.05}), [healthy]) < 0.7 * open_gap(problem, [healthy])


def test_errors_are_kept_by_channel_and_read_again():
    residuals = [np.zeros((2, 3, 10)), np.zeros((1, 3, 10))]
    residuals[0][..., 0], residuals[1][..., 0], residuals[0][..., 7] = 0.1, 0.3, 0.2
    ok = [np.ones((2, 3, 10), dtype=bool), np.ones((1, 3, 10), dtype=bool)]
    ok[1][..., 7] = False
    found = fitted_errors(merlin().model_copy(update={"calibration": kept(rms(residuals, ok), []) | {"thrust.gain": 0.1}}))
    assert found["u"] == pytest.approx(np.sqrt((2 * 0.1**2 + 0.3**2) / 3), rel=1e-3) and found["phi"] == pytest.approx(0.2)
    assert found["w"] == 0.0 and "thrust.gain" not in found


def test_runs_that_differ_little_among_themselves_say_that_one_more_differs_little():
    """Of two runs whose squared errors differ by a factor of e squared in every channel, and of four that hardly do, beside one that says nothing of it."""
    more = float(np.exp(1.0))
    two = kept({"u": 0.1, "r": 0.2}, [{"u": 0.1, "r": 0.2}, {"u": 0.1 * more, "r": 0.2 * more}])
    alike = kept({"u": 0.1}, [{"u": 0.1}, {"u": 0.101}, {"u": 0.1}, {"u": 0.099}])
    one, wide, narrow = (spread_as_calibrated(merlin().model_copy(update={"calibration": c})) for c in (kept({"u": 0.1}, [{"u": 0.1}]), two, alike))
    assert one == CALIBRATED_SPREAD and set(fitted_errors(merlin().model_copy(update={"calibration": two}))) == {"u", "r"}
    assert wide == pytest.approx(np.sqrt((CALIBRATED_SPREAD**2 + 1.5 * 2.0) / 2.0), rel=1e-3)
    assert narrow == pytest.approx(CALIBRATED_SPREAD / 2.0, rel=0.01)
