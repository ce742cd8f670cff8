"""The verdict of ASME V&V 20: worked by hand, against drawn errors (no published case with all its numbers was at hand), and on known errors."""

from __future__ import annotations

from dataclasses import replace
from math import sqrt
from statistics import NormalDist

import numpy as np
import pytest
from report_cases import make_run, make_sim, motion

from rovval.comparison import compare
from rovval.comparison.between import RESOLUTION
from rovval.comparison.validation import DOUBTFUL, HIDDEN, SEEN, Validation, validation
from rovval.core.data import Comparison

DRAWS = 20_000


@pytest.mark.parametrize(("error", "interval", "verdict"), [(6.9, (0.0, 20.9), HIDDEN), (10.0, (0.0, 24.0), DOUBTFUL), (20.0, (6.0, 34.0), SEEN)])
def test_a_worked_example(error: float, interval: tuple[float, float], verdict: str):
    """u_D = 6, u_num = 2, u_input = 3: u_val = sqrt(36 + 4 + 9) = 7, and the error of the model lies in E +- 14."""
    found = Validation("m/s", error, u_data=6.0, u_numerical=2.0, u_input=3.0)
    assert found.u_validation == pytest.approx(7.0)
    assert found.interval == pytest.approx(interval) and found.verdict == verdict


@pytest.mark.parametrize("model", [0.0, 3.0, 40.0])
def test_the_interval_holds_the_model_s_error_as_often_as_it_says(model: float):
    """S - D is the model's error with those of integration, inputs and data (V&V 20-2009, 1-5): drawn, the first lies in E +- 2 u_val 95.4 % of the time."""
    rng = np.random.default_rng(20)
    u_data, u_numerical, u_input = 6.0, 2.0, 3.0
    errors = model + rng.normal(0.0, u_numerical, DRAWS) + rng.normal(0.0, u_input, DRAWS) - rng.normal(0.0, u_data, DRAWS)
    drawn = [Validation("m/s", abs(e), u_data, u_numerical, u_input) for e in errors]
    if model == 40.0:  # far from 0, where an absolute value is the value
        assert np.mean([v.interval[0] <= model <= v.interval[1] for v in drawn]) == pytest.approx(0.9545, abs=0.005)
    spread = sqrt(u_data**2 + u_numerical**2 + u_input**2)
    beyond = {k: NormalDist().cdf((model - k * spread) / spread) + NormalDist().cdf((-model - k * spread) / spread) for k in (1.0, 2.0)}
    seen, hidden = (np.mean([v.verdict == verdict for v in drawn]) for verdict in (SEEN, HIDDEN))
    assert seen == pytest.approx(beyond[2.0], abs=0.005) and hidden == pytest.approx(1.0 - beyond[1.0], abs=0.01)


@pytest.mark.parametrize("gap", [0.02, 0.1])
def test_the_model_s_error_in_windows_lies_in_its_interval_for_any_draw_of_the_noise(gap: float):
    run, rng, held = make_run(600), np.random.default_rng(4), 0
    sim = make_sim(run, gap=(gap, 0.0, 0.0, 0.0, 0.0, 0.0))
    truth = motion(600)[0][:, 0]
    error = float(np.sqrt(np.mean((sim.windowed.nu[:, 0] - truth) ** 2)))
    for _ in range(20):
        noisy = replace(run, values={**run.values, "u": truth + rng.normal(0.0, 0.006, 600)})
        low, high = validation(compare(noisy, sim))["surge"].interval
        held += low <= error <= high
    assert held == 20, "E is of hundreds of rows, so that its own chance is small beside u_val"


def compared(gap: float) -> Comparison:
    """A minute of noise of 0.006 m/s, and a simulation that is right but for a ``gap`` in surge."""
    run = make_run(600)
    return compare(run, make_sim(run, gap=(gap, 0.0, 0.0, 0.0, 0.0, 0.0)))


def test_a_simulation_that_errs_by_the_noise_alone_is_not_found_wrong():
    found = validation(compared(0.0))
    assert len(found) == 6 and all(v.verdict == HIDDEN for v in found.values())
    assert found["surge"].u_data == found["surge"].u_input == pytest.approx(0.006, rel=0.15)


def test_an_error_beyond_what_is_unsure_is_seen_on_its_axis_alone():
    found = validation(compared(0.1))
    assert [axis for axis, v in found.items() if v.verdict == SEEN] == ["surge"]
    low, high = found["surge"].interval
    assert low < found["surge"].error < high


def test_the_integration_counts_by_the_fastest_motion_of_its_kind():
    c = compared(0.0)
    fastest = max(np.abs(c.run.get(name)).max() for name in "uvw")
    assert validation(c)["heave"].u_numerical == pytest.approx(RESOLUTION * fastest, rel=0.05)


def test_an_axis_without_a_known_noise_has_no_verdict():
    c = compared(0.1)
    unknown = replace(c, windowed={axis: replace(row, noise=0.0) for axis, row in c.windowed.items()})
    assert validation(unknown) == {}
