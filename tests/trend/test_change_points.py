"""Change points: planted ones are found where and as large as they are, healthy series are left alone, at the rate that is promised."""

import tracemalloc

import numpy as np
import pytest

from rovval.core.data import Array
from rovval.trend.change_points import changes

DAY = 86400.0
DAYS: Array = np.arange(100.0) * DAY
ODDS = 0.01 / 20


def scatter(rng, n, size=0.15) -> Array:
    """What healthy dives differ by: heavy tails."""
    errors: Array = size * rng.standard_t(4, n)
    return errors


def weekly(rng, n):
    """Times of n dives over as many days, not evenly."""
    return np.sort(rng.uniform(0, n * DAY, n))


@pytest.mark.parametrize(("kind", "size"), [("step", 0.5), ("step", -0.5), ("ramp", 0.9), ("ramp", -0.9)])
def test_a_planted_change_is_found_with_its_kind_time_and_size(kind, size):
    rng = np.random.default_rng(5)
    t = weekly(rng, 80)
    shape = (t >= t[45]) if kind == "step" else np.maximum(t - t[45], 0) / (t[-1] - t[45])
    [found] = changes(t, -3 + size * shape + scatter(rng, 80), 0.01, ODDS)
    assert found.kind == kind and found.places[0] <= 46 and found.places[1] >= 44
    assert abs(found.size[0] - size) < 3 * found.size[1] and found.size[1] < 0.2
    assert found.places[1] - found.places[0] < (10 if kind == "step" else 40)


def test_growth_that_is_cleaned_off_is_a_ramp_and_a_step():
    rng = np.random.default_rng(6)
    t = DAYS[:90]
    found = changes(t, -3 + np.maximum(t - t[20], 0) / t[40] - 1.0 * (t >= t[60]) + scatter(rng, 90, 0.1), 0.01, ODDS)
    assert [c.kind for c in found] == ["ramp", "step"]
    assert abs(found[1].place - 60) <= 2 and found[1].size[0] < -0.6 and abs(found[0].place - 20) < 12


def test_the_interval_of_a_size_holds_it_as_often_as_it_says():
    rng = np.random.default_rng(7)
    t, held = DAYS[:30], 0
    for _ in range(20):
        [found] = changes(t, 1.0 * (t >= t[12]) + scatter(rng, 30, 0.1), 0.01, ODDS)
        held += abs(found.size[0] - 1.0) < 1.645 * found.size[1]
    assert held >= 14  # 18 are meant; fewer than 14 come once in 90


def test_single_outliers_short_and_constant_series_are_no_change():
    rng = np.random.default_rng(8)
    t = DAYS[:40]
    spiked = scatter(rng, 40)
    spiked[[9, 24, 39]] += 3.0
    assert changes(t, spiked, 0.01, ODDS) == ()
    assert changes(t, np.zeros(40), 0.01, ODDS) == ()
    assert changes(np.zeros(40), spiked, 0.01, ODDS) == ()  # all of one day
    for n in range(1, 4):
        assert changes(t[:n], DAYS[:n], 0.01, ODDS) == ()


def test_values_that_differ_by_less_than_two_values_do_for_no_reason_are_no_change():
    t = DAYS[:40]
    step = 0.005 * (t >= t[20])
    assert changes(t, step, 0.05, ODDS) == () != changes(t, step, 0.0005, ODDS)


def test_the_bayes_factor_of_a_constant_series_exceeds_a_number_as_rarely_as_theory_says():
    """Ville's bound: K with a probability of 1 / K at most, whatever the scatter. 100 series, K = 10: 10 are allowed, 18 would come once in 100."""
    rng = np.random.default_rng(9)
    alarms = sum(bool(changes(weekly(rng, 12), scatter(rng, 12, 10.0 ** rng.uniform(-1, 1)), 1e-6, 0.1)) for _ in range(100))
    assert alarms <= 18


def test_memory_grows_with_the_dives_and_not_with_their_square():
    """Some 3,000 dives took 290 MB of the batch, 10,000 more than a pod has."""
    rng = np.random.default_rng(8)
    peaks = []
    for n in (1000, 3000):
        tracemalloc.start()
        changes(weekly(rng, n), -3 + scatter(rng, n), 0.01, ODDS)
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    assert peaks[1] < 3.5 * peaks[0] and peaks[1] < 40e6
