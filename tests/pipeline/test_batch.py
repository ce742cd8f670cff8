"""The batch: what is new is done, the rest skipped, a bad log set aside, and no kill loses what was finished."""

import gzip
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import batch_case
import pytest
from batch_case import counts, tasks_of

from rovval import demo
from rovval.core.errors import UsageProblem
from rovval.pipeline import batch
from rovval.storage import lock
from rovval.storage.archive import run_ids


def test_new_logs_are_done_and_unchanged_ones_skipped(site):
    path = batch_case.write_pipeline(site)
    first = batch.run(path, workers=2)
    assert counts(first) == {"done": 3}
    assert first["exit_code"] == 0
    assert len(run_ids(site / "archive")) == 3
    stamps = {p: p.stat().st_mtime_ns for p in (site / "archive").rglob("*") if p.is_file() and p.name != ".lock"}
    second = batch.run(path, workers=2)
    assert counts(second) == {"unchanged": 3}
    assert stamps == {p: p.stat().st_mtime_ns for p in (site / "archive").rglob("*") if p.is_file() and p.name != ".lock"}
    assert json.loads((site / "reports" / "summary.json").read_text()) == second


def test_a_changed_log_is_done_again_and_only_it(site):
    path = batch_case.write_pipeline(site)
    batch.run(path, workers=1)
    batch_case.write_log(site / "logs" / "b.csv", seed=99)
    again = batch.run(path, workers=1)
    assert counts(again) == {"done": 1, "unchanged": 2}
    assert again["done"][0]["log"].endswith("b.csv")


def test_a_touched_log_of_equal_content_is_not_done_again(site):
    path = batch_case.write_pipeline(site)
    batch.run(path, workers=1)
    os.utime(site / "logs" / "a.csv")
    assert counts(batch.run(path, workers=1)) == {"unchanged": 3}


def test_a_lost_output_is_made_again(site):
    path = batch_case.write_pipeline(site)
    batch.run(path, workers=1)
    run = run_ids(site / "archive")[0]
    for file in (site / "archive" / run).iterdir():
        file.unlink()
    (site / "archive" / run).rmdir()
    assert counts(batch.run(path, workers=1)) == {"done": 1, "unchanged": 2}
    assert len(run_ids(site / "archive")) == 3


def test_a_step_that_is_no_longer_asked_for_leaves_the_record_when_the_others_are_made_anew(site):
    """An old diagnosis stood beside new comparisons."""
    batch.run(batch_case.write_pipeline(site, steps='["ingest", "simulate"]'), workers=1)
    record = next((site / "reports").glob("*/record.json"))
    assert list(json.loads(record.read_text())["steps"]) == ["ingest", "simulate"]
    batch.run(batch_case.write_pipeline(site, steps='["ingest"]'), workers=1)
    assert list(json.loads(record.read_text())["steps"]) == ["ingest", "simulate"], "nothing is stale, nothing is lost"
    batch.run(batch_case.write_pipeline(site, "window_s = 4.0", steps='["simulate"]'), workers=1)
    assert list(json.loads(record.read_text())["steps"]) == ["simulate"]


@pytest.mark.slow
def test_a_tolerance_stands_on_the_page_of_each_run_and_an_edited_one_makes_that_page_anew(site):
    def pages(limit: str) -> list[str]:
        path = batch_case.write_pipeline(site, f'tolerances = ["{limit}"]', steps='["simulate", "compare"]')
        assert counts(batch.run(path, workers=1)) == {"done": 3} | ({"tolerances_exceeded": 3} if limit == "surge=0" else {})
        return [page.read_text() for page in sorted((site / "reports").glob("*/comparison/report.html"))]

    assert all('class="pass">kept<' in page and "--fail-above surge=9" in page for page in pages("surge=9"))
    simulations = {p: p.stat().st_mtime_ns for p in (site / "reports").glob("*/simulation.parquet")}
    assert all('class="neg">exceeded<' in page for page in pages("surge=0"))
    assert simulations == {p: p.stat().st_mtime_ns for p in (site / "reports").glob("*/simulation.parquet")}


@pytest.mark.slow
def test_a_diagnosis_shows_the_whole_run_before_and_after(tmp_path):
    """As that of a single log does."""
    (tmp_path / "logs").mkdir()
    (tmp_path / "logs" / "dive.csv").write_bytes(gzip.decompress(demo.SAMPLE.read_bytes()))
    batch.run(batch_case.write_pipeline(tmp_path, steps='["diagnose"]'), workers=1)
    [page] = (tmp_path / "reports").glob("*/diagnosis/diagnosis.html")
    assert "The whole run, before and after" in page.read_text() and 'id="w-surge"' in page.read_text()
    assert [p.name for p in page.parent.iterdir() if p.suffix == ".rrd"] == [], "recordings are asked for"


def test_a_bad_log_is_set_aside_with_its_reason_and_the_batch_goes_on(site):
    (site / "logs" / "bad.csv").write_text("this is,not a log\n1,2\n")
    (site / "logs" / "empty.csv").touch()
    path = batch_case.write_pipeline(site)
    done = batch.run(path, workers=2)
    assert counts(done) == {"done": 3, "quarantined": 2}
    assert done["exit_code"] == 3
    records = [json.loads(p.read_text()) for p in sorted((site / "reports" / "quarantine").iterdir())]
    assert [Path(r["log"]).name for r in records] == ["bad.csv", "empty.csv"]
    assert all(r["reason"] and r["kind"] == "refused" and r["exit_code"] == 3 for r in records)
    assert (site / "logs" / "bad.csv").exists()


def test_a_quarantined_log_is_not_tried_again_until_it_changes(site):
    bad = site / "logs" / "bad.csv"
    bad.write_text("this is,not a log\n1,2\n")
    path = batch_case.write_pipeline(site)
    batch.run(path, workers=1)
    assert not tasks_of(path)
    again = batch.run(path, workers=1)
    assert counts(again) == {"unchanged": 3, "quarantined": 1}
    assert again["exit_code"] == 3
    assert len(batch.dry_run(path, retry=True).todo) == 1
    batch_case.write_log(bad, seed=7)
    assert counts(batch.run(path, workers=1)) == {"done": 1, "unchanged": 3}


def test_a_log_that_is_done_is_not_set_aside_when_its_worker_is_killed_before_it_says_so(site, monkeypatch):
    """Nor does the record of an earlier night, in which it was, outlast a worker that was killed before it had removed it."""
    path = batch_case.write_pipeline(site)
    monkeypatch.setattr(batch, "work", batch_case.deadly_at_its_end)
    assert counts(batch.run(path, workers=1)) == {"done": 3}
    stale = site / "reports" / "quarantine" / next((site / "reports").glob("*/record.json")).parent.with_suffix(".json").name
    stale.parent.mkdir(exist_ok=True)
    stale.write_text("{}")
    assert len(batch.dry_run(path).done) == 3 and stale.exists()
    assert counts(batch.run(path, workers=1)) == {"unchanged": 3} and not stale.exists()


def test_kill_9_in_the_middle_and_start_again(site):
    """Nothing half-written is taken for a result, and what was finished is not done again."""
    for number in range(3):
        batch_case.write_log(site / "logs" / f"more{number}.csv", seed=100 + number)
    path = batch_case.write_pipeline(site)
    code_on_disk = f"import sys; sys.path.insert(0, {str(Path(batch_case.__file__).parent)!r})\nimport batch_case\nfrom rovval.pipeline import batch\n"
    code_on_disk += f"from pathlib import Path\nbatch.work = batch_case.paused\nbatch.run(Path({str(path)!r}), workers=1)\n"
    with subprocess.Popen([sys.executable, "-c", code_on_disk]) as process:
        deadline = time.monotonic() + 60
        while len(list((site / "reports").glob("*/record.json"))) < 2 and time.monotonic() < deadline:
            time.sleep(0.02)
        process.send_signal(signal.SIGKILL)
        process.wait()
    finished = len(list((site / "reports").glob("*/record.json")))
    assert 2 <= finished < 6
    again = batch.run(path, workers=2)
    assert again["exit_code"] == 0
    assert again["counts"]["unchanged"] >= finished
    assert again["counts"]["unchanged"] + again["counts"]["done"] == 6
    assert not list(site.rglob(".*.part"))


def test_leftovers_of_a_kill_are_swept(site):
    path = batch_case.write_pipeline(site)
    (site / "reports" / "x").mkdir(parents=True)
    (site / "reports" / "x" / ".report.html.123.part").touch()
    (site / "reports" / "archive" / ".run.123.part" / "half").mkdir(parents=True)
    (site / "archive" / ".run.123.part" / "half").mkdir(parents=True)
    catalogue = site / "archive" / "catalogue" / "vehicle=merlin" / ".runs.parquet.123.part"
    catalogue.parent.mkdir(parents=True)
    catalogue.touch()
    with lock.held(site / "archive", shared=True):  # another batch, or `rovval ingest`, writes a run just now
        batch.run(path, workers=1)
    assert [left.name for left in site.rglob(".*.part")] == [".run.123.part"]
    batch.run(path, workers=1)
    assert not list(site.rglob(".*.part"))


def test_two_runs_never_overlap(site):
    path = batch_case.write_pipeline(site)
    with lock.held(site / "reports"), pytest.raises(UsageProblem, match=f"another run is at work.*{os.getpid()}"):
        batch.run(path)
    assert counts(batch.run(path, workers=1)) == {"done": 3}


def test_equal_content_is_done_once_and_said(site):
    (site / "logs" / "copy.csv").write_bytes((site / "logs" / "a.csv").read_bytes())
    done = batch.run(batch_case.write_pipeline(site), workers=1)
    assert counts(done) == {"done": 3, "waiting": 1}
    assert "same content as" in done["waiting"][0]["why"]


def test_a_log_that_is_still_being_copied_waits(site):
    path = batch_case.write_pipeline(site, "settle_s = 3600.0")
    for name in ("a", "b"):
        os.utime(site / "logs" / f"{name}.csv", (0, 0))
    assert counts(batch.run(path, workers=1)) == {"done": 2, "waiting": 1}


def test_workers_and_scheduler_exclude_each_other(site):
    with pytest.raises(UsageProblem):
        batch.run(batch_case.write_pipeline(site), workers=2, scheduler="tcp://localhost:1")


def test_a_simulation_that_leaves_sane_limits_is_no_success(site):
    """Exit 4 as of `rovval compare`; a log in quarantine weighs more."""
    log = site / "logs" / "wild.csv"
    batch_case.write_log(log, seconds=20.0, rpm=3000.0)
    path = batch_case.write_pipeline(site, steps='["ingest", "simulate"]')
    done = batch.run(path, workers=1)
    assert done["exit_code"] == 4 and [Path(row["log"]) for row in done["left_sane_limits"]] == [log]
    assert batch.run(path, workers=1)["exit_code"] == 4, "unchanged is not well"
    (site / "logs" / "bad.csv").touch()
    assert batch.run(path, workers=1)["exit_code"] == 3


def test_what_stops_a_batch_stands_on_its_page(site, monkeypatch):
    """After a full disk the page was that of the night before."""
    path, page = batch_case.write_pipeline(site), site / "reports" / "index.html"
    batch.run(path, workers=1)
    batch_case.write_log(site / "logs" / "d.csv", seed=9)
    monkeypatch.setattr(batch, "execute", batch_case.no_space)
    with pytest.raises(UsageProblem, match="No space left"):
        batch.run(path, workers=1)
    assert "Stopped before its end (1)" in page.read_text() and "Runs (3)" in page.read_text()
    assert json.loads((site / "reports" / "summary.json").read_text())["exit_code"] == 2


def test_a_disk_too_full_for_a_page_does_not_leave_that_of_the_night_before(site, monkeypatch):
    path, page = batch_case.write_pipeline(site), site / "reports" / "index.html"
    batch.run(path, workers=1)
    size = page.stat().st_size
    monkeypatch.setattr("rovval.report.common.files.write_all", batch_case.no_space)
    with pytest.raises(UsageProblem, match="No space left"):
        batch.run(path, workers=1)
    text = page.read_text()
    assert "Stopped before its end (1)" in text and "Runs (" not in text and len(text) < size + 400
    assert json.loads((site / "reports" / "summary.json").read_text())["exit_code"] == 2
