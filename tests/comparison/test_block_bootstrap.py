"""Intervals of errors: how often they hold the truth, and blocks as long as published theory has them."""

from __future__ import annotations

import numpy as np
import pytest
from report_cases import make_run, make_sim
from scipy.signal import lfilter

from rovval.comparison import compare
from rovval.comparison.block_bootstrap import CONFIDENCE, FEWEST_BLOCKS, block_length, intervals
from rovval.core.data import Array


def autoregressive(memory: float, n: int, seed: int) -> Array:
    """A stationary series of variance 1 of which each value keeps ``memory`` of the one before (AR(1)); it has settled for 400 values."""
    steps = np.random.default_rng(seed).normal(0.0, np.sqrt(1.0 - memory**2), n + 400)
    return np.asarray(lfilter([1.0], [1.0, -memory], steps)[400:])


@pytest.mark.slow
@pytest.mark.parametrize(("memory", "n"), [(0.0, 600), (0.7, 1800), (0.9, 1800)])
def test_nine_of_ten_intervals_hold_the_truth(memory: float, n: int):
    """Of errors with mean 0.3 and standard deviation 1: mean error 0.3, rmse sqrt(1.09). Of 1000 series each 0.87 to 0.92; of 400 chance moves that by
    0.03. Rows drawn one by one hold it in a third of the cases where the memory is 0.9."""
    found = [intervals(0.3 + autoregressive(memory, n, seed), np.ones(n), 0.1) for seed in range(400)]
    for name, truth in (("mean_error", 0.3), ("rmse", np.sqrt(1.09))):
        held = np.mean([span[name][0] <= truth <= span[name][1] for span in found])
        assert CONFIDENCE - 0.06 <= held <= CONFIDENCE + 0.05, (name, held)


def test_few_blocks_do_not_make_an_interval_too_narrow():
    """Six windows that differ from one another alone, each with one error: an interval of the plain percentiles held the truth in 8 of 10."""
    held = []
    for seed in range(300):
        windows = np.random.default_rng(seed).normal(0.3, 1.0, FEWEST_BLOCKS)
        low, high = intervals(np.repeat(windows, 100), np.ones(600), 0.1, 100)["mean_error"]
        held.append(low <= 0.3 <= high)
    assert 0.84 <= np.mean(held) <= 0.97


@pytest.mark.parametrize("memory", [0.3, 0.7])
def test_a_block_is_as_long_as_theory_has_it(memory: float):
    """Politis and White 2004, equation 14, of an AR(1): G = 2 rho / (1 - rho)^2, g(0) = (1 + rho) / (1 - rho), each times the variance."""
    n = 2000
    best = (1.5 * (2.0 * memory / (1.0 - memory**2)) ** 2 * n) ** (1.0 / 3.0)
    assert np.median([block_length(autoregressive(memory, n, seed)) for seed in range(60)]) == pytest.approx(best, rel=0.2)


def test_a_constant_has_no_spread():
    assert block_length(np.full(100, 0.2)) == 1
    found = intervals(np.full(100, -0.2), np.zeros(100), 0.1)
    assert found["mean_error"] == pytest.approx((-0.2, -0.2)) and found["iae"] == pytest.approx((2.0, 2.0))
    assert "skill" not in found, "the trivial predictor makes no error"


def test_a_log_of_few_windows_has_no_interval():
    assert intervals(np.arange(599.0), np.ones(599), 0.1, 100) == {}
    assert set(intervals(np.arange(600.0), np.ones(600), 0.1, 100)) == {"mean_error", "mae", "iae", "rmse", "skill"}


def test_every_error_of_a_comparison_lies_in_its_interval():
    run = make_run(1200)
    c = compare(run, make_sim(run))
    rows = [*c.free.values(), *c.windowed.values(), *c.pose.values()]
    assert len(rows) == 16
    for row in rows:
        assert {"mean_error", "mae", "iae", "rmse"} <= set(row.intervals)
        for name, (low, high) in row.intervals.items():
            assert low <= getattr(row, name) <= high, (row.channel, name)
    assert compare(run, make_sim(run)).free["surge"].intervals == c.free["surge"].intervals, "the same log, the same interval"
