"""The page of a batch: what needs attention first, a row a run, light with thousands, and as new as its summary."""

import json
import re
from typing import Any

import batch_case
import pytest
from page_case import Balance, pages_led_to

from rovval.pipeline import batch
from rovval.pipeline.keeping import summary
from rovval.report.batch import html as batch_html
from rovval.report.batch import terminal
from rovval.report.batch.table import folders


def record(number: int = 0, **steps: Any) -> dict[str, Any]:
    axes = {"surge": {"rms": 0.01 * (number + 1), "unit": "m/s"}, "yaw": {"rms": 0.1, "unit": "rad/s"}}
    comparison = {"vehicle": "merlin", "stops": [], "window": {"seconds": 10, "axes": axes}, "axes": {}}
    cause = {"effect": "inflow_loss", "group": ["inflow_loss", "quadratic_drag"], "shrinkage": {"total": 0.66}}
    found = {
        "compare": {"comparison": comparison, "outputs": [f"d {number}#/comparison/report.html"]},
        "diagnose": {"vehicle": "merlin", "verdict": "explained", "causes": [cause], "outputs": [f"d{number}/diagnosis.html"]},
    }
    return {"log": f"/logs/d{number:04}.csv", "run": f"d{number:04}-ab", "duration_s": 90.0, "findings": 2, "steps": found | steps}


def said(records: list[dict[str, Any]], aside: Any = (), limits: Any = ("window.surge=0.015",)) -> str:
    document = summary.summarise("nightly", records[:1], records[1:], aside, (), limits, 3.0, {})
    text = batch_html.text(document, records)
    page = Balance()
    page.feed(text)
    assert page.open == [] and not [f for f in page.fetched if "//" in f]
    return text


def test_a_run_has_a_row_with_its_gap_its_cause_and_links_to_its_pages():
    text = said([record()])
    for cell in ('href="d%200%23/comparison/report.html">d0000-ab<', ">merlin<", ">90 s<", ">0.010<", ">5.7<", 'href="d0/diagnosis.html">explained<'):
        assert cell in text
    assert "inflow_loss or quadratic_drag</code> 66 %" in text and ">new<" in text
    assert "sway" not in text and "Nothing needs attention. 1 run in" in text


def test_a_long_list_leaves_room_for_the_table():
    """Ten of thirty are seen, twenty are opened, and none is missing."""
    text = said([record(i) for i in range(31)])
    listed = text[text.index("Tolerance exceeded (30)") : text.index("Runs (31)")]
    seen, _, opened = listed.partition("<details><summary>20 more</summary>")
    assert (seen.count("is above the limit"), opened.count("is above the limit")) == (10, 20)


def test_what_needs_attention_comes_first():
    aside = [
        {"log": "/logs/bad.csv", "kind": "refused", "reason": "/logs/bad.csv: no <rows>", "next": "look"},
        {"log": "/logs/died.csv", "kind": "crash", "reason": "out of memory", "next": ""},
    ]
    stopped = record(2)
    stopped["steps"]["compare"]["comparison"]["stops"] = ["stretch from 0.0 s stopped at 4.1 s"]
    text = said([record(0), record(1), stopped], aside)
    document = summary.summarise("nightly", [record(0), stopped], (), (), (), (), 3.0, {})
    assert document["left_sane_limits"] == [{"log": stopped["log"], "run": stopped["run"], "stops": ["stretch from 0.0 s stopped at 4.1 s"]}]
    assert f"left limits  {stopped['log']}: stretch from 0.0 s" in terminal.text(document)
    assert "2 beyond a tolerance, 1 failed, 1 quarantined and 1 left sane limits" in text
    order = [text.index(word) for word in ("Tolerance exceeded (2)", "Failed (1)", "Quarantined (1)", "left sane limits (1)", "Runs (3)")]
    assert order == sorted(order)
    assert "no &lt;rows&gt;" in text and "stretch from 0.0 s" in text


def test_thousands_of_runs_stay_light_and_the_largest_gaps_stand_out():
    text = said([record(n) for n in range(5000)])
    assert len(text) < 3_000_000
    assert "<b>50</b>" in text and "<b>44</b>" not in text
    assert "and 4799 more: see summary.json" in text


def test_the_page_is_made_in_pieces_in_the_order_of_the_logs():
    """However many runs there are, no piece is longer than a page without runs and some rows."""
    records = [record(n) for n in range(1000)]
    document = summary.summarise("nightly", records, (), (), (), (), 3.0, {})
    pieces = list(batch_html.pieces(document, records[::-1]))
    assert max(map(len, pieces[1:])) < 100_000 and len(pieces[0]) < 100_000
    assert re.findall(r">(d\d{4})-ab<", "".join(pieces)) == [f"d{n:04}" for n in range(1000)]


@pytest.mark.parametrize("steps", ['["ingest"]', '["ingest", "simulate", "compare"]'])
def test_a_batch_leaves_its_page_also_when_nothing_is_new(tmp_path, steps):
    batch_case.write_log(tmp_path / "logs" / "a.csv")
    path, page = batch_case.write_pipeline(tmp_path, steps=steps), tmp_path / "reports" / "index.html"
    batch.run(path, workers=1)
    assert ">new<" in page.read_text()
    done = batch.run(path, workers=1)
    text = page.read_text()
    run = json.loads(next((tmp_path / "reports").glob("*/record.json")).read_text())["run"]
    assert ">new<" not in text and done["ended"] in text and run in text
    assert ("comparison/report.html" in text) == ("compare" in steps)
    for report in (tmp_path / "reports").glob("*/comparison/report.html"):
        assert pages_led_to(page) >= {report} and page in pages_led_to(report)


def test_an_empty_batch_has_a_page():
    assert "0 runs" in said([])


def test_folders_are_told_from_where_all_logs_lie_unless_they_have_no_such_place():
    assert folders({"/logs/a", "/logs/b/c", "/logs"}) == {"/logs/a": "a", "/logs/b/c": "b/c", "/logs": ""}
    assert folders({"/logs/a", "s3://dives"}) == {"/logs/a": "/logs/a", "s3://dives": "s3://dives"}
    assert folders({"/logs"}) == {"/logs": ""} and folders(()) == {}
