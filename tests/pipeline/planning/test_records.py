"""Of every record a batch holds what its summary and page say, and no more."""

from __future__ import annotations

import hashlib
import json
import tracemalloc
from typing import Any

import report_cases

from rovval.comparison import compare, metrics
from rovval.pipeline.keeping import summary
from rovval.pipeline.planning.packed import Packed
from rovval.pipeline.planning.records import RECORD, brief, judged, read_record, write_record
from rovval.report.batch import html
from rovval.report.comparison.json import document


def test_what_a_batch_holds_of_a_record_says_all_that_the_record_says():
    run = report_cases.make_run()
    comparison = document(compare(run, report_cases.make_sim(run)))
    steps = {"simulate": {"stops": [], "outputs": []}, "compare": {"comparison": comparison, "outputs": ["d/report.html"]}}
    record = {"log": "/logs/d.csv", "run": "d-ab", "duration_s": 90.0, "findings": 2, "steps": steps}
    limits = [f"{axis}.{metric}=0" for axis in comparison["axes"] for metric in ("rmse", "mae", "iae", "mean_error", "lag", "sprague_geers")]
    limits += [f"window.{axis}.{metric}=0" for axis in comparison["axes"] for metric in ("rms", "iae")]
    said = [summary.summarise("nightly", [r], [], [], [], limits, 1.0, {}) | {"ended": ""} for r in (record, brief(record, limits))]
    assert said[0] == said[1] and len(said[0]["tolerances_exceeded"]) == len(limits) > 0
    assert html.text(said[0], [record]) == html.text(said[1], [brief(record)])
    assert len(json.dumps(brief(record))) < len(json.dumps(record)) / 3


def test_what_is_written_of_a_comparison_judges_the_run_as_all_of_it_does():
    """A record had all of the document, which stands in the report beside it: three times what the batch reads of every log every night."""
    run = report_cases.make_run()
    comparison = document(compare(run, report_cases.make_sim(run)))
    limits = [f"{way}{axis}.{metric}=0" for axis in comparison["axes"] for metric in metrics.names() for way in ("", "window.")]

    def said(part: dict[str, Any]) -> dict[str, Any]:
        steps = {"compare": {"comparison": part, "outputs": ["d/report.html"]}}
        record = {"log": "/logs/d.csv", "run": "d-ab", "duration_s": 90.0, "findings": 2, "steps": steps}
        return summary.summarise("nightly", [record], [], [], [], limits, 1.0, {}) | {"ended": ""}

    assert said(judged(comparison)) == said(comparison)
    assert len(json.dumps(judged(comparison))) < 0.6 * len(json.dumps(comparison))


def test_a_batch_holds_records_packed_and_gives_them_back_as_they_are():
    """A thousand records as dicts took 5 MB, and the batch's memory grew by that for every thousand logs."""
    text = json.dumps({"log": "d.csv", "run": "d-ab", "steps": {"ingest": {"key": "k", "outputs": ["a", "r.html"], "code": "c", "files": {"a": {"bytes": 9}}}}})
    one = brief(json.loads(text))
    assert one == {"log": "d.csv", "run": "d-ab", "steps": {"ingest": {"outputs": ["r.html"], "code": "c"}}}
    other = {**one, "duration_s": 0.1 + 0.2, "vehicle": None, "findings": ["\u00e9\udcff"]}
    for many in (0, 1, 99, 100, 250):  # with and without records that are compressed together
        records = [{**other, "log": f"{number}.csv"} for number in range(many)]
        packed = Packed([one, *records])
        assert len(packed) == many + 1 and list(packed) == [one, *records] and list(packed) == [one, *records]
        assert packed[-1] == packed[many] == [one, *records][-1] and packed[1:] == records
        assert one in packed and {} not in packed


def test_ten_thousand_records_are_held_in_two_megabytes():
    """As bytes, one each, they took 7 MB."""
    tracemalloc.start()
    try:
        began = tracemalloc.get_traced_memory()[0]
        packed = Packed(comparison_of(number) for number in range(10_000))
        assert tracemalloc.get_traced_memory()[0] - began < 2e6 and packed[9_999] == comparison_of(9_999)
    finally:
        tracemalloc.stop()


def comparison_of(number: int) -> dict[str, Any]:
    """A record as `brief` leaves it, with digests and numbers that only it has."""
    sha = hashlib.sha256(str(number).encode()).hexdigest()
    axes = {axis: {"rms": int(sha[8 * k : 8 * k + 8], 16) / 2**34, "unit": "m/s"} for k, axis in enumerate(("surge", "sway", "heave", "yaw"))}
    compared = {"code": "c" * 12, "outputs": [f"{number}-{sha[:8]}/comparison/report.html"], "comparison": {"vehicle": "merlin", "window": {"axes": axes}}}
    return {"log": f"/data/logs/{number}.csv", "sha256": sha, "run": f"{number}-{sha[:10]}", "model": "fossen", "steps": {"compare": compared}}


def test_a_record_is_as_it_was_written_or_none(tmp_path):
    """Also one whose digest an older rovval took of its content, and one of before there were digests."""
    record = {"log": 'a "digest": "x', "run": "d-ab", "steps": {"ingest": {"key": "k", "outputs": []}}}
    write_record(tmp_path, record)
    file = tmp_path / RECORD
    text = file.read_text()
    assert read_record(tmp_path) == record
    for changed in (text.replace("d-ab", "d-ac"), text.replace('"steps"', ' "steps"'), text.replace('"k"', '"k", "l": 1'), text[:-2]):
        file.write_text(changed)
        assert changed != text and read_record(tmp_path) is None
    older = hashlib.sha256(json.dumps(record, sort_keys=True).encode()).hexdigest()
    for kept in ({"digest": older}, {}):
        file.write_text(json.dumps({**record, **kept}))
        assert read_record(tmp_path) == record
