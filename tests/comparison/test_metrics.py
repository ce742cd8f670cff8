"""The contract of every file in metrics/, and hand-worked values."""

import numpy as np
import pytest

from rovval.comparison import metrics
from rovval.core.data import Array
from rovval.core.errors import BadInput, UsageProblem

RNG = np.random.default_rng(3)
MEASURED = RNG.normal(0.2, 0.5, 400)
ERROR = RNG.normal(0.05, 0.1, 400)
OK = np.ones(400, bool)


@pytest.mark.parametrize("name", metrics.names())
class TestContract:
    def test_declares_itself(self, name: str) -> None:
        m = metrics.get(name)
        assert m.name == name and m.title and m.meaning
        assert m.unit_of("m/s") == {"same": "m/s", "times_s": "m", "s": "s", "1": "1"}[m.unit]

    def test_perfect_for_identical_input(self, name: str) -> None:
        m = metrics.get(name)
        assert m.compute(np.zeros(400), OK, 0.1, MEASURED) == m.perfect

    def test_scales_as_it_says(self, name: str) -> None:
        m = metrics.get(name)
        once, twice = m.compute(ERROR, OK, 0.1, MEASURED), m.compute(2 * ERROR, OK, 0.1, MEASURED)
        assert (twice == pytest.approx(2 * once)) is m.scales

    def test_turns_with_its_sign_or_does_not(self, name: str) -> None:
        m = metrics.get(name)
        here, there = m.compute(ERROR, OK, 0.1, MEASURED), m.compute(-ERROR, OK, 0.1, -MEASURED)
        assert abs(here) == pytest.approx(abs(there), rel=1e-9)

    def test_ignores_masked_samples(self, name: str) -> None:
        m = metrics.get(name)
        keep = OK.copy()
        keep[50:90] = False
        spoiled, truth = ERROR.copy(), MEASURED.copy()
        spoiled[~keep], truth[~keep] = np.nan, 1e9
        assert m.compute(spoiled, keep, 0.1, truth) == m.compute(ERROR, keep, 0.1, MEASURED)
        if m.unit != "s":  # of all others time is the samples that are there
            assert m.compute(spoiled, keep, 0.1, truth) == m.compute(ERROR[keep], OK[keep], 0.1, MEASURED[keep])

    def test_refuses_when_none_are_left(self, name: str) -> None:
        with pytest.raises(BadInput, match="no sample is left"):
            metrics.get(name).compute(ERROR, ~OK, 0.1, MEASURED)

    def test_refuses_nan_that_is_not_masked(self, name: str) -> None:
        with pytest.raises(BadInput, match="not a finite number"):
            metrics.get(name).compute(np.where(OK, np.nan, 0.0), OK, 0.1, MEASURED)

    def test_does_not_change_its_input(self, name: str) -> None:
        e, k, m = ERROR.copy(), OK.copy(), MEASURED.copy()
        metrics.get(name).compute(e, k, 0.1, m)
        assert (e == ERROR).all() and (k == OK).all() and (m == MEASURED).all()


def test_values_by_hand() -> None:
    e, ok = np.array([1.0, -3.0, 100.0]), np.array([True, True, False])
    got = {n: metrics.get(n).compute(e, ok, 0.1) for n in ("mean_error", "iae", "mae", "rmse", "max_error")}
    assert got == pytest.approx({"mean_error": -1.0, "iae": 0.4, "mae": 2.0, "rmse": np.sqrt(5.0), "max_error": 3.0})


def test_theil_shares_add_to_one() -> None:
    shares = [metrics.get(f"theil_{k}").compute(ERROR, OK, 0.1, MEASURED) for k in ("bias", "variance", "covariance")]
    assert sum(shares) == pytest.approx(1.0, abs=1e-12) and min(shares) >= 0


@pytest.mark.parametrize(
    ("simulated", "share"), [(MEASURED + 0.3, "bias"), (1.5 * MEASURED - 0.5 * MEASURED.mean(), "variance")]
)
def test_theil_names_offset_and_size(simulated: Array, share: str) -> None:
    error = simulated - MEASURED
    assert metrics.get(f"theil_{share}").compute(error, OK, 0.1, MEASURED) == pytest.approx(1.0, abs=1e-9)


def test_fit_is_zero_for_the_mean_and_refused_without_motion() -> None:
    fit = metrics.get("fit_percent").compute
    assert fit(MEASURED.mean() - MEASURED, OK, 0.1, MEASURED) == pytest.approx(0.0, abs=1e-9)
    with pytest.raises(BadInput, match="never moved"):
        fit(ERROR, OK, 0.1, np.full(400, 0.1))


@pytest.mark.parametrize("name", ["fit_percent", "theil_variance", "theil_covariance"])
def test_refuses_without_the_measured_values_it_needs(name: str) -> None:
    with pytest.raises(BadInput, match="needs the measured values"):
        metrics.get(name).compute(ERROR, OK, 0.1)


def test_units_and_unknown_names() -> None:
    assert [metrics.get("iae").unit_of(u) for u in ("m/s", "rad/s", "m")] == ["m", "rad", "m*s"]
    assert metrics.get("rmse").unit_of("m/s") == "m/s" and metrics.get("fit_percent").unit_of("m") == "1"
    with pytest.raises(UsageProblem, match="no metric named"):
        metrics.get("vibes")


def test_agreement_of_waves_by_analysis() -> None:
    """A sine of 1.2 times the size and a phase of 30 degrees late, over whole periods: magnitude 0.2, phase 1/6; of U1, VAF and NRMSE the closed forms."""
    t = np.arange(3600) * 2 * np.pi / 360
    measured, simulated = np.sin(t), 1.2 * np.sin(t - np.pi / 6)
    error, ok = simulated - measured, np.ones(3600, bool)
    squared = 1.2**2 + 1.0 - 2.0 * 1.2 * np.cos(np.pi / 6)  # twice the mean squared error (law of cosines)

    def value(name: str) -> float:
        return metrics.get(name).compute(error, ok, 0.1, measured)

    assert value("sprague_geers") == pytest.approx(np.hypot(0.2, 1 / 6))
    assert value("theil_u") == pytest.approx(np.sqrt(squared) / 2.2)
    assert value("vaf") == pytest.approx(100 * (1 - squared))
    assert value("nrmse") == pytest.approx(np.sqrt(squared / 2) / 2)
    assert metrics.get("vaf").compute(error + 5.0, ok, 0.1, measured) == pytest.approx(value("vaf")), "an offset does not count"


def test_a_simulation_that_is_late_has_its_delay_for_a_lag() -> None:
    """Of a smooth motion to a hundredth of a second, whichever way; a mask or a size that is wrong changes nothing."""
    t = np.arange(0.0, 60.0, 0.1)

    def motion(at: Array) -> Array:
        return np.asarray(np.sin(at) + 0.5 * np.sin(2.3 * at + 1.0))

    ok = (t < 20.0) | (t > 27.0)
    for late in (0.34, -0.86, 1.5):
        assert metrics.get("lag").compute(1.3 * motion(t - late) - motion(t), ok, 0.1, motion(t)) == pytest.approx(late, abs=0.02)


def test_a_lag_is_refused_where_nothing_moves_and_where_no_shift_is_best() -> None:
    t = np.arange(0.0, 60.0, 0.1)
    for measured in (np.zeros(600), t):
        with pytest.raises(BadInput, match="lag"):
            metrics.get("lag").compute(np.full(600, 0.1) + 0.001 * t**2, np.ones(600, bool), 0.1, measured)
