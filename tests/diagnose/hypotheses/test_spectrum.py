"""Periods of the residual: of waves, met under way and standing still; none in a healthy log."""

from __future__ import annotations

from dataclasses import replace

import pytest
from diagnose_case import posed, without

from rovval.diagnose.hypotheses.spectrum import oscillation, spectral_lines, wave_periods
from rovval.diagnose.inference.map_fit import map_fit


@pytest.mark.parametrize("period", [7.7, pytest.param(12.4, marks=pytest.mark.slow)])
def test_the_period_of_waves_is_the_strongest_line(period):
    p, _ = posed((f"waves:cosine=-0.42,sine=0.91,period={period},direction=2.6",))
    (best, share), *others = spectral_lines(p, map_fit(p, p.origin, ()))
    assert best == pytest.approx(period, rel=0.02)
    assert share > 0.3 and all(share > 2 * other for _, other in others)


@pytest.mark.parametrize(
    ("period", "direction", "amplitude"),
    [(5.0, 0.8, 2.0), *(pytest.param(*sea, marks=pytest.mark.slow) for sea in ((4.0, -2.4, 3.0), (6.0, 2.6, 1.5)))],
)
def test_a_vehicle_under_way_meets_waves_at_another_period_than_theirs(period, direction, amplitude):
    """Whose direction is right finds their own; without a position none is looked for."""
    p, _ = posed((f"waves:cosine={0.54 * amplitude},sine={-0.84 * amplitude},period={period},direction={direction}",))
    point = map_fit(p, p.origin, ())
    met = [one for one, _ in spectral_lines(p, point)]
    found, *others = wave_periods(p, point, met, (2.0, 20.0), (direction,), 3)[direction]
    assert all(abs(1.0 / found - 1.0 / other) > 1.0 / 200.0 for other in others), "no nearer than a log of that length can tell"
    assert abs(found - period) < 0.4 * abs(met[0] - period)
    lost = replace(p, runs=tuple(replace(part, run=without(part.run, "x")) for part in p.runs))
    assert wave_periods(lost, point, met, (2.0, 20.0), (direction,), 3) == wave_periods(p, point, [70.0], (2.0, 20.0), (direction,), 3) == {}


def test_a_sea_is_taken_apart_into_its_trains():
    """Three lines two resolutions apart before any that is not in the sea, a side lobe say, and one with a seventh of the largest one's energy."""
    sizes = {9.4: 0.8, 8.6: 0.7, 7.6: 0.6, 6.4: 0.3}
    further = "".join(f",sine_{i}={size},period_{i}={period}" for i, (period, size) in enumerate(sizes.items(), 2))
    p, _ = posed((f"waves:direction=1.0{further}",))
    point = map_fit(p, p.origin, ())
    found = wave_periods(p, point, [one for one, _ in spectral_lines(p, point)], (2.0, 20.0), (1.0,), 8)[1.0]
    *strong, weak = sizes
    assert sorted(found[:3]) == pytest.approx(sorted(strong), rel=0.02)
    assert weak == pytest.approx(min(found, key=lambda period: abs(period - weak)), rel=0.02)


def test_a_healthy_log_has_no_line():
    p, _ = posed()
    point = map_fit(p, p.origin, ())
    assert max((share for _, share in spectral_lines(p, point)), default=0.0) < 0.1
    assert oscillation(p, point) is None


@pytest.mark.slow
def test_a_sea_of_several_trains_is_a_narrow_band_and_a_drag_is_none():
    sea = "waves:cosine=0.7,period=6.0,direction=1.0,cosine_2=0.5,period_2=6.6,sine_3=0.5,period_3=5.4"
    p, _ = posed((sea,))
    found = oscillation(p, map_fit(p, p.origin, ()))
    assert found is not None and found.period == pytest.approx(6.0, rel=0.15) and found.share > 0.6
    p, _ = posed(("quadratic_drag[surge]:scale=1.5",))
    assert oscillation(p, map_fit(p, p.origin, ())) is None
