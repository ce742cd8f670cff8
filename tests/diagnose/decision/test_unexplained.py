"""What needs no cause, and a gap that stays open."""

from __future__ import annotations

import numpy as np
import pytest
from diagnose_case import posed

from rovval.diagnose.decision.unexplained import Accounted, open_gap
from rovval.diagnose.problem.problem import corrected_residuals


@pytest.mark.parametrize(("departure", "share"), [(0.0, 0.3), (4.9, 0.3), (6.6, 0.04)])
def test_tolerance_accounts_for_a_gap_only_at_its_stated_size(departure: float, share: float):
    assert Accounted(noise=0.04, tolerance=0.26, departure=departure).share == pytest.approx(share)


def test_a_gap_for_which_too_little_accounts_is_open_on_its_largest_axis():
    problem, _ = posed(seconds=100.0)
    residuals = [np.zeros_like(one) for one in corrected_residuals(problem)]
    residuals[0][..., 2] = 1.0  # w
    left = open_gap(problem, Accounted(0.04, 0.26, 0.0), residuals)
    assert left is not None and left.axes == ("heave",) and left.accounted == pytest.approx(0.3) and left.share == 0.0
    assert open_gap(problem, Accounted(0.04, 0.36, 0.0), residuals) is None
