"""Curves against time: what lies still is drawn as still."""

from __future__ import annotations

import numpy as np
import pytest

from rovval.report.drawings.chart import chart, path
from rovval.report.drawings.drawing import Curve, Line, Text


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


def test_a_path_that_closes_has_one_label_at_its_ends_and_numbers_at_its_way_points():
    turn = np.linspace(0.0, 2 * np.pi, 200)
    ring = np.column_stack([10.0 * np.cos(turn), 10.0 * np.sin(turn), np.full(200, 20.0)])
    words = [s.words for s in path("path", ring, ring[[50, 100]]).shapes if isinstance(s, Text)]
    assert {"start and end", "1", "2"} <= set(words) and "start" not in words
    half = [s.words for s in path("path", ring[:100]).shapes if isinstance(s, Text)]
    assert {"start", "end"} <= set(half)


def test_the_axes_of_a_path_lie_beside_it():
    """At the start they lay across the path and its labels."""
    way = np.column_stack([np.linspace(0.0, 30.0, 50), np.linspace(0.0, -12.0, 50), np.linspace(5.0, 9.0, 50)])
    shapes = path("path", way).shapes
    left = min(x for s in shapes if isinstance(s, Curve) for x, _ in s.points)
    axes = [s for s in shapes if isinstance(s, Line)]
    assert len(axes) == 3 and max(max(s.x1, s.x2) for s in axes) < left
