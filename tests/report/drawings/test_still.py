"""Pictures without a script: the curves that the script draws, as drawings."""

from __future__ import annotations

import re

import numpy as np
import pytest
from report_cases import diagnosis, make_run, make_sim

from rovval.comparison import compare
from rovval.report.comparison import html as comparison_page
from rovval.report.diagnosis import html as diagnosis_page
from rovval.report.drawings import curves
from rovval.report.drawings.drawing import Box, Curve, Drawing, Text
from rovval.report.drawings.still import WIDTH, still

T = np.arange(0.0, 100.0, 0.1)
AXES = {"run": curves.times(1000, 0.1), "frequency": curves.steps(100, 0.05, "Hz", 0.05, log=True)}


def drawn(*plots: dict[str, object]) -> Drawing:
    return still("p", plots, AXES)


def test_a_peak_a_hole_and_a_curve_s_colour_stay():
    values = np.sin(T)
    values[400:500], values[700] = np.nan, 9.0
    picture = drawn(curves.plot("p", [curves.series("windowed", "windows", values), curves.series("measured", "measured", np.cos(T))]))
    pieces = [s for s in picture.shapes if isinstance(s, Curve) and s.css == "k-windowed"]
    assert len(pieces) == 2 and sum(len(p.points) for p in pieces) < 400
    top = min(y for p in pieces for _, y in p.points)
    assert top < min(y for s in picture.shapes if isinstance(s, Curve) and s.css == "k-measured" for _, y in s.points) - 50
    assert picture.label == "windows, measured"


def test_a_difference_is_what_the_script_takes():
    ramp = 0.01 * T
    run = curves.plot("run", [curves.series("measured", "measured", np.sin(T)), curves.series("free", "free run", np.sin(T) + ramp)])
    taken, given = (curves.plot("p", [c], error=True) for c in (curves.difference("free", "free run", ramp, "run", 1), curves.series("free", "free run", ramp)))
    ends = [[s.points[k] for s in drawn(run, p).shapes if isinstance(s, Curve) for k in (0, -1)] for p in (taken, given)]
    np.testing.assert_allclose(ends[0], ends[1], atol=0.2)
    long = curves.difference("free", "free run", np.zeros(100_000), "run", 1)
    assert "of" not in long, "of a run that is thinned two curves have their points at different rows"


def test_what_is_shaded_lies_at_its_time_and_an_onset_is_a_line():
    picture = drawn(curves.plot("p", [curves.series("measured", "measured", T)], bands=[(20.0, 40.0, "shade"), (50.0, 50.0, "onset")]))
    shade, onset = (next(s for s in picture.shapes if isinstance(s, Box) and s.css == css) for css in ("s-shade", "s-onset"))
    assert shade.width == pytest.approx(0.2 * (WIDTH - 58), rel=0.01) and shade.x < onset.x and onset.width < 3


def test_a_tube_has_two_edges_round_the_first_curve():
    picture = drawn(curves.plot("p", [curves.series("measured", "measured", np.zeros(1000)), curves.series("free", "free run", np.sin(T))], tube=0.5))
    high, low = (s.points[0][1] for s in picture.shapes if isinstance(s, Curve) and s.css == "tube")
    [middle] = (s for s in picture.shapes if isinstance(s, Curve) and s.css == "k-measured")
    assert middle.points[0][1] == pytest.approx(0.5 * (high + low), abs=0.2) and high < low


def test_an_axis_of_frequency_is_logarithmic_and_has_its_unit():
    picture = drawn(curves.plot("p", [curves.series("windowed", "spectrum", np.arange(100.0))], "frequency"))
    [line] = (s for s in picture.shapes if isinstance(s, Curve))
    xs = [x for x, _ in line.points]
    assert xs[len(xs) // 2] > 0.8 * WIDTH, "half of the values lie in the last 0.3 decades"
    assert [s.words for s in picture.shapes if isinstance(s, Text) and "Hz" in s.words] == ["1 Hz"]


@pytest.mark.parametrize("page", ["comparison", "diagnosis"])
def test_every_place_of_a_picture_has_one_without_a_script(page: str):
    run = make_run(300)
    html = comparison_page.text(compare(run, make_sim(run))) if page == "comparison" else diagnosis_page.text(diagnosis())
    places = re.findall(r'<div class="canvas[^>]*>(<noscript><svg.*?</svg>\s*</noscript>)?</div>', html, re.DOTALL)
    assert len(places) > 0 and all("<polyline" in place for place in places)
