"""The page of a batch beside the night before, with the trend of each vehicle, and its table in a real browser."""

from __future__ import annotations

import json
import re
from typing import Any

import numpy as np
import pytest
from browser_case import found, in_browser
from catalogue_case import row
from page_case import check_html

from rovval.pipeline.keeping import summary
from rovval.report.batch import html as batch_html
from rovval.trend import trends


def record(number: int, vehicle: str = "merlin", surge: float = 0.05) -> dict[str, Any]:
    comparison = {"vehicle": vehicle, "stops": [], "axes": {}, "window": {"seconds": 10, "axes": {"surge": {"rms": surge, "unit": "m/s"}}}}
    steps = {"compare": {"comparison": comparison, "outputs": []}}
    return {"log": f"/logs/d{number:04}.csv", "run": f"d{number:04}-ab", "duration_s": 90.0 + number, "findings": 0, "steps": steps}


def document(done=(), unchanged=(), aside=(), limits=()):
    return summary.summarise("nightly", done, unchanged, aside, (), limits, 3.0, {})


def test_this_night_stands_beside_the_one_before():
    bad = {"log": "/logs/bad.csv", "kind": "refused", "reason": "no", "next": "look"}
    first = document([record(0), record(1, surge=0.3)], limits=["window.surge=0.1"])
    second = document([record(2)], [record(0), record(1)], [bad], ["window.surge=0.1"])
    second["night_before"] = summary.night_before(json.loads(json.dumps(first)))
    page = batch_html.text(second, [record(n) for n in range(3)])
    check_html(page)
    assert "Needs attention since this night: /logs/bad.csv." in page and "No longer: /logs/d0001.csv." in page
    cells = re.search(r"done</th><td><b>1</b></td><td>2</td>", page)
    assert cells and first["ended"] in page
    assert "night before" not in batch_html.text(first, [record(0)])
    assert summary.night_before({"schema": "of an older rovval"}) is None


def test_each_vehicle_has_a_curve_an_axis_and_a_sentence_for_what_changes():
    rng = np.random.default_rng(1)
    rows = []
    for vehicle in ("merlin", "minerva"):
        for n in range(60):
            surge = 0.05 * np.exp(0.1 * rng.standard_normal()) * (1 + (vehicle == "minerva" and n >= 30))
            rows.append(row(n, vehicle=vehicle, current=True, causes=[], sway=None, surge=float(surge)))
    page = batch_html.text(document([record(0)]), [record(0)], trends(rows))
    check_html(page)
    assert page.count('class="spark"') == 2 * 5 and page.count('class="mark"') == 1
    [said] = re.findall(r"<li>(minerva, gap in surge: rose by .*? on \d+ \w+ 2026 .*?)</li>", page)
    assert re.search(r"rose by (9\d|10\d|11\d) %", said)
    assert "sway" not in page.partition("Trend over dives")[2].partition("</thead>")[0]


@pytest.mark.slow
@in_browser
def test_a_browser_searches_filters_orders_and_hides_columns(tmp_path):
    records = [record(n, ("merlin", "minerva")[n % 2], 0.001 * (n % 100 + 1)) for n in range(300)]
    page = batch_html.text(document(records[:3], records[3:]), records)
    script = """
    for (let k = 0; k < 50 && !document.querySelector("table.runs.whole"); k++) await pause(100);
    const table = document.querySelector("table.runs"), column = [...table.tHead.rows[0].cells].findIndex((th) => th.dataset.title === "length");
    const shown = [...table.tBodies[0].rows].filter((row) => !row.hidden);
    const names = shown.map((row) => row.cells[0].textContent.trim().slice(0, 5)), drawn = shown.filter((row) => row.getClientRects().length);
    return { names, drawn: drawn.length, hides: window.getComputedStyle(table.tHead.rows[0].cells[column]).display === "none" };
    """

    def rows(view: str) -> list[str]:
        seen = found(page, script, tmp_path, view=view)
        assert seen["drawn"] == len(seen["names"]), "rows below the first screens are drawn once those stand"
        assert seen["hides"] == ("hide=length" in view)
        return list(seen["names"])

    assert len(rows("")) == 300
    assert set(rows("q=d0007+merlin")) == set() and set(rows("q=D0007+minerva")) == {"d0007"}
    assert len(rows("vehicle=minerva")) == 150 and rows("state=new") == ["d0000", "d0001", "d0002"]
    assert rows("sort=surge:down&vehicle=minerva&hide=length")[:3] == ["d0099", "d0199", "d0299"]
    assert rows("sort=length:down")[0] == "d0299"
