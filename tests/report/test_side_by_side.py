"""Several comparisons side by side: what tells them apart, which is nearest, and that no line is too long."""

from __future__ import annotations

from dataclasses import replace

import pytest
from page_case import check_html, read
from report_cases import make_run, make_sim

from rovval.comparison import compare
from rovval.core.data import Comparison
from rovval.report import side_by_side


def case(run: str = "dive", model: str = "fossen", gap: float = 0.06, absent: tuple[str, ...] = ()) -> Comparison:
    made = replace(make_run(400, absent), id=run)
    return compare(made, replace(make_sim(made, gap=(gap, -0.02, 0.01, 0.002, 0.001, 0.03)), run_id=run, model=model))


def test_models_of_one_run_are_told_apart_by_model_and_the_nearer_is_counted():
    both = [case(), case(model="uuv", gap=0.01)]
    assert side_by_side.names(both) == ["fossen", "uuv"]
    assert "of 6 axes (rms in windows)" in side_by_side.said(both) and "uuv in 1" in side_by_side.said(both)
    page = side_by_side.html(both)
    check_html(page)
    assert f"<b>{both[1].windowed['surge'].rmse:.3g}"[:9] in page


def test_runs_by_one_model_have_the_span_of_their_errors_and_no_winner():
    runs = [case("a"), case("b", gap=0.12)]
    assert side_by_side.names(runs) == ["a", "b"] and "<td><b>" not in side_by_side.html(runs)
    assert side_by_side.said(runs).startswith("Over 2 runs, rms in windows: surge ")


def test_runs_and_models_together_fit_a_terminal():
    many = [case(f"a_dive_with_a_long_name_{k}", model) for k in range(2) for model in ("fossen", "uuv")]
    lines = side_by_side.text(many).splitlines()
    assert max(map(len, lines)) <= 80 and "a_dive_with_a_long_name_1, uuv" in lines
    assert list(side_by_side.document(many)["comparisons"]) == side_by_side.names(many)


def test_an_axis_that_one_lacks_is_a_dash_and_its_curve_is_left_out():
    two = [case("a"), case("b", absent=("q",))]
    row = side_by_side.text(two).splitlines()[-1].split()
    assert row[4] == "-" and len(row) == 6
    assert len(side_by_side.figures(two)) == 6 and "rms in windows" in read(side_by_side.html(two))


@pytest.mark.parametrize("n", [1, 9])
def test_of_many_the_first_eight_are_drawn(n: int):
    figure = side_by_side.figures([case(f"run{k}") for k in range(n)])[0]
    assert len({s.css for s in figure.shapes if s.css.startswith("c")}) == min(n, 8)
