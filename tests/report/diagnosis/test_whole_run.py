"""The whole run before and after: curves of every axis, the regime that holds most of the gap shaded, onsets marked."""

from __future__ import annotations

import numpy as np
import pytest
from page_case import check_html, read
from report_cases import diagnosis, make_diagnosis, make_run, make_sim

from rovval.comparison import compare
from rovval.core.channels import AXES
from rovval.diagnose.result.diagnosis import Diagnosis
from rovval.report.diagnosis import html, whole_run

RUN = make_run(600)
COMPARISON, MENDED = compare(RUN, make_sim(RUN)), make_sim(RUN, gap=(0.0,) * 6)


def found(regime: str, onset: float | None = None) -> Diagnosis:
    """A diagnosis whose gap lies in surge, in a regime, with one cause."""
    document = make_diagnosis()
    document["gap"]["where"] = [{"axis": "surge", "regime": regime, "share": 0.6, "time_share": 0.2, "lift": 3.0}]
    document["causes"][0]["onset_s"] = onset
    return Diagnosis.read(document)


def test_every_axis_is_drawn_whole_with_what_the_causes_make_of_it():
    axes, pictures, places = whole_run.drawn(diagnosis(), COMPARISON, MENDED)
    assert axes["run"]["n"] == 600 and [p.identity for p in places] == [f"w-{axis}" for axis in AXES]
    surge, error = pictures[:2]
    assert [s["key"] for s in surge["series"]] == ["measured", "nominal", "corrected"]
    assert [(s["of"], s["index"]) for s in error["series"]] == [("w-surge", 1), ("w-surge", 2)]
    assert [s["key"] for s in whole_run.drawn(diagnosis(), COMPARISON, None)[1][0]["series"]] == ["measured", "nominal"]


def test_the_regime_is_shaded_on_its_axis_while_it_holds():
    _, pictures, places = whole_run.drawn(found("u > 0.6 m/s"), COMPARISON, MENDED)
    by_id = {p["id"]: p for p in pictures}
    fast = np.zeros(600, bool)
    for start, end, key in by_id["w-surge"]["bands"]:
        assert key == "shade"
        fast |= (RUN.t >= start - 1e-6) & (RUN.t < end - 1e-6)
    measured = RUN.get("u") > 0.6
    assert (fast >= measured).all() and np.mean(fast != measured) < 0.1, "short breaks are drawn over"
    assert by_id["w-surge-error"]["bands"] == by_id["w-surge"]["bands"] and "bands" not in by_id["w-sway"]
    assert [p.note for p in places][:2] == ["shaded: moving ahead faster than 0.6 m/s", ""]


@pytest.mark.parametrize("regime", ["HFP forward", "u > 99 m/s"])
def test_what_cannot_be_told_or_never_holds_is_not_shaded(regime: str):
    assert not any("bands" in p for p in whole_run.drawn(found(regime), COMPARISON, MENDED)[1])


def test_an_onset_is_a_line_on_every_axis():
    _, pictures, places = whole_run.drawn(found("HFP forward", 31.5), COMPARISON, MENDED)
    assert all(p["bands"] == [[31.5, 31.5, "onset"]] for p in pictures)
    assert all(p.note == "line: Axial inflow loss (inflow_loss) begins" for p in places)


def test_the_page_has_it_where_there_is_a_run():
    page = html.text(diagnosis(), COMPARISON, MENDED)
    check_html(page)
    assert "The whole run, before and after" in page and f"Run {RUN.id}, in windows" in read(page)
    assert "The whole run" not in html.text(diagnosis())
