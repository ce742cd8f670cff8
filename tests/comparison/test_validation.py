"""The verdict of ASME V&V 20: worked by hand, and on a comparison of which the errors are known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from report_cases import make_run, make_sim

from rovval.comparison import compare
from rovval.comparison.between import RESOLUTION
from rovval.comparison.validation import DOUBTFUL, HIDDEN, SEEN, Validation, validation
from rovval.core.data import Comparison


@pytest.mark.parametrize(("error", "interval", "verdict"), [(6.9, (0.0, 20.9), HIDDEN), (10.0, (0.0, 24.0), DOUBTFUL), (20.0, (6.0, 34.0), SEEN)])
def test_a_worked_example(error: float, interval: tuple[float, float], verdict: str):
    """u_D = 6, u_num = 2, u_input = 3: u_val = sqrt(36 + 4 + 9) = 7, and the error of the model lies in E +- 14."""
    found = Validation("m/s", error, u_data=6.0, u_numerical=2.0, u_input=3.0)
    assert found.u_validation == pytest.approx(7.0)
    assert found.interval == pytest.approx(interval) and found.verdict == verdict


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
