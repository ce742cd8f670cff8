"""Reliability, Brier score, calibration error, slope and log score on forecasts whose answers are known."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from scipy.stats import binom

from rovval.blind.scoring.calibration import calibration, skill_of_kinds
from rovval.blind.scoring.intervals import exact


def forecasts(slope: float, many: int = 20000, seed: int = 0) -> tuple[list[float], list[bool]]:
    """Forecasts that come true with a chance whose log odds are ``slope`` times the stated ones."""
    rng = np.random.default_rng(seed)
    odds = rng.normal(0.8, 1.5, many)
    return (1.0 / (1.0 + np.exp(-odds))).tolist(), (rng.random(many) < 1.0 / (1.0 + np.exp(-slope * odds))).tolist()


def test_probabilities_that_mean_what_they_say():
    found = calibration(*forecasts(1.0))
    assert found["calibration_error"] < 0.015
    assert found["slope"]["low"] < 1.0 < found["slope"]["high"]
    assert found["slope"]["value"] == pytest.approx(1.0, abs=0.05)
    assert all(row["right"]["low"] - 0.02 < row["stated"] < row["right"]["high"] + 0.02 for row in found["bins"])
    assert sum(row["n"] for row in found["bins"]) == found["n"] == 20000
    assert found["skill"] > 0.1


@pytest.mark.parametrize("true", [0.5, 2.0])
def test_too_sure_and_not_sure_enough_have_their_slope(true):
    found = calibration(*forecasts(true))
    assert found["slope"]["value"] == pytest.approx(true, rel=0.06)
    assert found["calibration_error"] > 0.04


def test_scores_by_hand():
    found = calibration([0.9, 0.8, 0.3, 0.6], [True, True, False, False])
    assert found["brier"] == pytest.approx((0.01 + 0.04 + 0.09 + 0.36) / 4)
    assert found["log_score"] == pytest.approx(np.mean(np.log([0.9, 0.8, 0.7, 0.4])))
    assert found["constant_log_score"] == pytest.approx(np.log(0.5))
    assert found["skill"] == pytest.approx(1.0 - found["log_score"] / np.log(0.5))
    assert found["calibration_error"] == pytest.approx((0.1 + 0.2 + 0.3 + 0.6) / 4)


def test_kinds_are_scored_by_the_probability_of_the_true_one():
    stated = [{"a": 0.9, "b": 0.1}, {"a": 0.8, "b": 0.2}, {"a": 0.3, "b": 0.7}, {"a": 0.5, "b": 0.5}]
    found = skill_of_kinds(stated, ["a", "a", "b", "b"])
    assert found is not None and found["log_score"] == pytest.approx(np.mean(np.log([0.9, 0.8, 0.7, 0.5])))
    assert found["constant_log_score"] == pytest.approx(np.log(0.5)) and found["skill"] == pytest.approx(1.0 - found["log_score"] / np.log(0.5))
    assert skill_of_kinds(stated, ["a"] * 4) is None


def test_the_best_constant_has_no_skill_and_no_error():
    found = calibration([0.75] * 4, [True, True, True, False])
    assert found["skill"] == pytest.approx(0.0) and found["calibration_error"] == pytest.approx(0.0)
    assert found["slope"] is None


def test_where_there_is_no_slope_none_is_stated():
    assert calibration([0.9, 0.8, 0.7], [True, True, True])["slope"] is None
    assert calibration([0.9, 0.8, 0.2, 0.1], [True, True, False, False])["slope"] is None
    assert calibration([], []) == {"n": 0}


def test_a_probability_of_none_that_comes_true_keeps_the_score_finite():
    found = calibration([0.0, 1.0, 1.0], [True, False, True])
    assert np.isfinite(found["log_score"]) and found["log_score"] < -4.0


def test_exact_intervals_hold_nine_in_ten_whatever_the_share():
    """Of all that a binomial of 30 may show, the interval holds the true share in 90 % or more, by summing over outcomes."""
    for n, share in product((5, 30), (0.02, 0.3, 0.85)):
        held = [exact([True] * k + [False] * (n - k)) for k in range(n + 1)]
        ends = [(number["low"] or 0.0, 1.0 if number["high"] is None else number["high"]) for number in held]
        inside = sum(binom.pmf(k, n, share) for k, (low, high) in enumerate(ends) if low <= share <= high)
        assert inside >= 0.9
    assert exact([]) == {"value": None, "low": None, "high": None, "n": 0}
    assert exact([False] * 100)["high"] == pytest.approx(1.0 - 0.05 ** (1.0 / 100.0))
