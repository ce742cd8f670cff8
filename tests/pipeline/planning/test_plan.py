"""The plan: what makes a result new is what it depends on, and why it is new is said."""

import os
import time
from pathlib import Path

import batch_case
import pytest
from batch_case import counts, tasks_of

from rovval import vehicle
from rovval.core.errors import UsageProblem
from rovval.ingest import profile
from rovval.pipeline import batch
from rovval.pipeline.execution.worker import work
from rovval.pipeline.planning.hashes import code_on_disk
from rovval.pipeline.planning.plan import why
from rovval.storage.archive import run_ids


def test_keys_depend_on_what_a_step_depends_on(site):
    """A new window makes simulations new and leaves what was read alone."""
    before = tasks_of(batch_case.write_pipeline(site, steps='["ingest", "simulate"]'))
    after = tasks_of(batch_case.write_pipeline(site, "window_s = 5.0", steps='["ingest", "simulate"]'))
    for old, new in zip(before, after, strict=True):
        (a, b), (c, d) = dict(old.keys).values(), dict(new.keys).values()
        assert a == c
        assert b != d


def test_a_tolerance_makes_the_pages_that_show_it_new_and_no_result(site):
    steps = '["simulate", "compare", "diagnose"]'
    before = dict(tasks_of(batch_case.write_pipeline(site, steps=steps))[0].keys)
    [after, *_] = tasks_of(batch_case.write_pipeline(site, 'tolerances = ["surge=0.1", "trend.surge=3"]', steps=steps))
    assert {step for step, key in after.keys if before[step] != key} == {"compare"}
    assert after.tolerances == ("surge=0.1",), "one that holds over dives is none of a single run"
    assert after.method == tasks_of(batch_case.write_pipeline(site, steps=steps))[0].method


def test_the_vehicle_that_a_profile_names_lies_beside_it_and_counts(site, tmp_path, monkeypatch):
    """It was looked for in the working directory, where cron is somewhere else; and edited it left its logs unchanged."""
    text = (profile.FOLDER / "merlin.toml").read_text()
    (tmp_path / "mine.toml").write_text(text.replace('vehicle = "merlin"', 'vehicle = "my_vehicle.toml"'))
    mine = tmp_path / "my_vehicle.toml"
    mine.write_text((vehicle.LIBRARY / "merlin.toml").read_text())
    path = batch_case.write_pipeline(tmp_path, steps='["ingest", "simulate"]')
    path.write_text(path.read_text().replace('profile = "merlin"\nvehicle = "merlin"', 'profile = "mine.toml"'))
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    before = tasks_of(path)
    assert before and profile.load_profile(tmp_path / "mine.toml").vehicle_file == str(mine)
    mine.write_text(mine.read_text().replace("mass = 2936.0", "mass = 2930.0"))
    after = tasks_of(path)
    assert [dict(t.keys)["simulate"] for t in before] != [dict(t.keys)["simulate"] for t in after]
    assert [dict(t.keys)["ingest"] for t in before] == [dict(t.keys)["ingest"] for t in after]


def test_results_of_other_code_are_made_anew_and_it_is_said(site, monkeypatch):
    """The version's number stays the same while the code changes."""
    path = batch_case.write_pipeline(site)
    assert batch.run(path, workers=1)["why"] == {"new": 3}
    monkeypatch.setattr("rovval.pipeline.planning.plan.code_on_disk", lambda: "0123456789ab")
    monkeypatch.setattr("rovval.pipeline.execution.worker.code_of_this_process", lambda: "0123456789ab")
    reasons = {why(task) for task in batch.dry_run(path).todo}
    assert reasons == {f"made by other code of rovval ({code_on_disk()}; now 0123456789ab)"}
    assert {work(task)["status"] for task in tasks_of(path)} == {"done"}
    assert counts(batch.run(path, workers=1)) == {"unchanged": 3}


def test_hostile_names_and_links_cost_no_other_log_its_night(site):
    """Names of 255 bytes, names that are no UTF-8, links in a circle and to nowhere: done or set aside with the reason, and the rest goes on."""
    logs = site / "logs"
    long = logs / f"{'n' * 251}.csv"
    batch_case.write_log(long, seed=10)
    batch_case.write_log(logs / "deep" / "d.csv", seed=11)
    batch_case.write_log(Path(os.fsdecode(os.fsencode(logs) + b"/\xff.csv")), seed=12)
    for number in range(8):
        (logs / f"loop{number}").symlink_to("..")
        (logs / "deep" / f"loop{number}").symlink_to("..")
    (logs / "gone.csv").symlink_to("nowhere")
    path = batch_case.write_pipeline(site)
    path.write_text(path.read_text().replace("logs/*.csv", "logs/**/*.csv"))
    done = batch.run(path, workers=1)
    assert counts(done) == {"done": 5, "quarantined": 2} and done["exit_code"] == 3
    assert sorted(q["reason"].split(": ")[1] for q in done["quarantined"]) == ["a link that leads nowhere", "its name is not UTF-8"]
    assert r"/\xff.csv" in (site / "reports" / "index.html").read_text()
    assert counts(batch.run(path, workers=1)) == {"unchanged": 5, "quarantined": 2}


def test_a_log_that_cannot_be_read_is_set_aside(site, monkeypatch):
    closed = site / "logs" / "b.csv"
    honest = Path.open

    def denied(path, *args, **kwargs):
        if path == closed:
            raise PermissionError(13, "Permission denied", str(path))
        return honest(path, *args, **kwargs)

    monkeypatch.setattr(Path, "open", denied)
    done = batch.run(batch_case.write_pipeline(site), workers=1)
    assert counts(done) == {"done": 2, "quarantined": 1}
    assert done["quarantined"][0] == {
        "log": str(closed), "kind": "unreadable", "reason": f"{closed}: cannot be read: Permission denied", "next": "mend its name or its permissions"
    }  # fmt: skip


@pytest.mark.parametrize("rubbish", [b"[1]", b"\xff\xfe", b'{"steps": 3}', b'{"steps": {"ingest": []}}', b"", b"[" * 100_000])
def test_damaged_records_and_hashes_are_made_anew(site, rubbish):
    (site / "logs" / "bad.csv").write_text("this is,not a log\n1,2\n")
    path = batch_case.write_pipeline(site)
    batch.run(path, workers=1)
    for file in [*(site / "reports").rglob("*.json")]:
        file.write_bytes(rubbish)
    tasks = tasks_of(path)
    assert sorted(why(task) for task in tasks) == ["new"] + ["with a damaged record"] * 3
    assert {work(task)["status"] for task in tasks} == {"done", "quarantined"}
    assert counts(batch.run(path, workers=1)) == {"unchanged": 3, "quarantined": 1}


def test_a_record_in_which_a_number_was_changed_is_none(site):
    path = batch_case.write_pipeline(site)
    batch.run(path, workers=1)
    record = next((site / "reports").glob("a-*/record.json"))
    record.write_text(record.read_text().replace('"duration_s": ', '"duration_s": 1'))
    assert [why(task) for task in tasks_of(path)] == ["with a damaged record"]


def test_a_source_without_a_log_is_said_and_its_rows_stay(site):
    """An empty mount point after a good night was exit 0, and the page was empty."""
    path = batch_case.write_pipeline(site)
    batch.run(path, workers=1)
    (site / "logs").rename(site / "elsewhere")
    for there in (False, True):
        if there:
            (site / "logs").mkdir()
        done = batch.run(path, workers=1)
        assert done["exit_code"] == 3 and "3 logs were there before" in done["missing_sources"][0]["why"]
        page = (site / "reports" / "index.html").read_text()
        assert "No log there (1)" in page and "Runs (3)" in page
    (site / "logs").rmdir()
    (site / "elsewhere").rename(site / "logs")
    assert counts(batch.run(path, workers=1)) == {"unchanged": 3}


def test_a_time_in_the_future_is_not_waited_for(site):
    """It was, for ever."""
    for name, age in (("a", 3600), ("b", -1e8), ("c", -5)):
        os.utime(site / "logs" / f"{name}.csv", (time.time() - age,) * 2)
    assert counts(batch.run(batch_case.write_pipeline(site, "settle_s = 60.0"), workers=1)) == {"done": 2, "waiting": 1}


def test_a_changed_byte_is_seen_though_size_and_time_are_as_before(site):
    path, log = batch_case.write_pipeline(site), site / "logs" / "a.csv"
    batch.run(path, workers=1)
    was = log.stat()
    text = log.read_bytes()
    log.write_bytes(text[:-3] + (b"1" if text[-3:-2] != b"1" else b"2") + text[-2:])
    os.utime(log, ns=(was.st_atime_ns, was.st_mtime_ns))
    assert log.stat().st_size == was.st_size
    assert [task.log for task in tasks_of(path)] == [log]


def test_what_was_read_is_what_was_planned(site):
    """A log that was cut in between and put back with its old time stayed as it was read, for ever."""
    path, log = batch_case.write_pipeline(site), site / "logs" / "a.csv"
    was, whole, [task, *_] = log.stat(), log.read_bytes(), tasks_of(path)
    log.write_bytes(whole[: len(whole) // 2])
    outcome = work(task)
    assert outcome["status"] == "quarantined" and outcome["record"]["kind"] == "changed"
    assert not run_ids(site / "archive")
    log.write_bytes(whole)
    os.utime(log, ns=(was.st_atime_ns, was.st_mtime_ns))
    assert counts(batch.run(path, workers=1)) == {"done": 3}


def test_damaged_outputs_are_made_anew(site):
    """A cut table, a broken manifest and an empty report were `unchanged`, exit 0; a changed byte is found with `verify`."""
    path = batch_case.write_pipeline(site)
    batch.run(path, workers=1)
    a, b, c = (site / "archive" / run for run in run_ids(site / "archive"))
    whole = (a / "run.parquet").read_bytes()
    (a / "run.parquet").write_bytes(whole[:100])
    (b / "manifest.json").write_text("{")
    (c / "manifest.json").write_text("[1]")
    done = batch.run(path, workers=1)
    assert counts(done) == {"done": 3} and done["why"] == {"with an output gone or damaged": 3}
    assert (a / "run.parquet").read_bytes() == whole
    (a / "run.parquet").write_bytes(whole[:-9] + bytes(9))
    manifest = (b / "manifest.json").read_text()
    (b / "manifest.json").write_text(manifest.replace('"longest_gap_s": 0', '"longest_gap_s": 9').replace('"samples": 5', '"samples": 6'))
    assert manifest != (b / "manifest.json").read_text()
    assert counts(batch.run(path, workers=1)) == {"unchanged": 3}
    assert counts(batch.run(path, workers=1, verify=True)) == {"done": 2, "unchanged": 1}
    assert (a / "run.parquet").read_bytes() == whole and (b / "manifest.json").read_text() == manifest


@pytest.mark.parametrize("key", ["archive", "reports"])
def test_an_address_that_is_neither_a_folder_nor_s3_is_refused(site, key):
    """It was taken for a local folder of that name, and what was written there went with the machine."""
    path = batch_case.write_pipeline(site)
    path.write_text(path.read_text().replace(f'{key} = "{key}"', f'{key} = "gs://bucket/dives"'))
    with pytest.raises(UsageProblem, match="gs://bucket/dives: gs:// is no place"):
        batch.run(path)
    assert not (site / "s3:").exists()
