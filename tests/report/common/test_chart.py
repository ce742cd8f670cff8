"""Curves against time: what lies still is drawn as still."""

from __future__ import annotations

import numpy as np
import pytest

from rovval.report.common.chart import chart
from rovval.report.common.drawing import Curve, Text


@pytest.mark.parametrize("size", [0.0, 1e-14])
def test_a_curve_that_is_zero_but_for_rounding_is_a_line_at_zero(size):
    drawing = chart("thrust", "N", 0.1, {"VFP": size * np.sin(np.arange(100.0))})
    levels = [s.words for s in drawing.shapes if isinstance(s, Text) and s.anchor == "end" and s.css == "m"]
    assert levels == ["0", "0.25"]
    [curve] = (s for s in drawing.shapes if isinstance(s, Curve))
    assert len({y for _, y in curve.points}) == 1


def test_a_thinned_curve_keeps_its_peak():
    values = np.zeros(20_000)
    values[12_345] = 3.0
    [curve] = (s for s in chart("speed", "m/s", 0.1, {"u": values}).shapes if isinstance(s, Curve))
    assert len(curve.points) < 1500 and min(y for _, y in curve.points) < max(y for _, y in curve.points) - 100
