"""The prediction limit of a dive from those before it."""

import numpy as np
import pytest
from catalogue_case import row
from scipy import stats

from rovval.trend import recent
from rovval.trend.series import all_series


def series(gaps):
    [found] = [s for s in all_series([row(n, surge=float(g), current=True, causes=[]) for n, g in enumerate(gaps)]) if s.name == "surge"]
    return found


def test_the_limit_is_that_of_the_textbook():
    """Hahn and Meeker 1991, 4.8, by SciPy's distributions, of the logarithms of the twenty dives before."""
    gaps = 0.05 * np.exp(np.random.default_rng(1).normal(0, 0.2, 30))
    limits, sample = recent.limits(series(gaps), 3.0), np.log(gaps[9:29])
    quantile = stats.t.ppf(stats.norm.cdf(3.0), 19)
    assert np.log(limits["d00029-ab"]) == pytest.approx(sample.mean() + quantile * sample.std(ddof=1) * np.sqrt(1 + 1 / 20))
    assert "d00000-ab" not in limits and "d00001-ab" not in limits


@pytest.mark.parametrize("before", [2, 5, 20])
def test_as_few_healthy_dives_exceed_it_as_it_says_however_few_there_are(before):
    rng = np.random.default_rng(before)
    above = sum(
        gaps[before] > recent.limits(series(gaps), 1.645)[f"d{before:05}-ab"]
        for gaps in (np.exp(rng.normal(0, 0.3, before + 1)) for _ in range(400))
    )
    assert 8 <= above <= 36  # 20 are meant; outside once in 2000
