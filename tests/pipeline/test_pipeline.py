"""The batch: what is new is done, the rest skipped, a bad log set aside, and no kill loses what was finished."""

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import batch_case
import pytest

from rovval.core.code_version import source_hash
from rovval.core.errors import BadInput, Finding, UsageProblem
from rovval.pipeline import batch, cluster, config, lock
from rovval.pipeline.hashes import NO_RESULT, code_on_disk
from rovval.pipeline.plan import plan, why
from rovval.pipeline.processes import execute
from rovval.pipeline.worker import work
from rovval.storage.archive import load_run, run_ids, save_run

CASES = Path(__file__).parents[1] / "cases"


@pytest.fixture
def site(tmp_path):
    """Three logs and a pipeline that ingests them."""
    for number, name in enumerate(("a", "b", "c")):
        batch_case.write_log(tmp_path / "logs" / f"{name}.csv", seed=number)
    return tmp_path


def counts(document):
    return {k: v for k, v in document["counts"].items() if v}


def tasks_of(path):
    return plan(config.load(path), path.parent).todo


def test_new_logs_are_done_and_unchanged_ones_skipped(site):
    path = batch_case.write_pipeline(site)
    first = batch.run(path, workers=2)
    assert counts(first) == {"done": 3}
    assert first["exit_code"] == 0
    assert len(run_ids(site / "archive")) == 3
    stamps = {p: p.stat().st_mtime_ns for p in (site / "archive").rglob("*") if p.is_file()}
    second = batch.run(path, workers=2)
    assert counts(second) == {"unchanged": 3}
    assert stamps == {p: p.stat().st_mtime_ns for p in (site / "archive").rglob("*") if p.is_file()}
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


def test_keys_depend_on_what_a_step_depends_on(site):
    """A new window makes simulations new and leaves what was read alone."""
    before = tasks_of(batch_case.write_pipeline(site, steps='["ingest", "simulate"]'))
    after = tasks_of(batch_case.write_pipeline(site, "window_s = 5.0", steps='["ingest", "simulate"]'))
    for old, new in zip(before, after, strict=True):
        (a, b), (c, d) = dict(old.keys).values(), dict(new.keys).values()
        assert a == c
        assert b != d


def test_a_step_that_is_no_longer_asked_for_leaves_the_record_when_the_others_are_made_anew(site):
    """An old diagnosis stood beside new comparisons."""
    batch.run(batch_case.write_pipeline(site, steps='["ingest", "simulate"]'), workers=1)
    record = next((site / "reports").glob("*/record.json"))
    assert list(json.loads(record.read_text())["steps"]) == ["ingest", "simulate"]
    batch.run(batch_case.write_pipeline(site, steps='["ingest"]'), workers=1)
    assert list(json.loads(record.read_text())["steps"]) == ["ingest", "simulate"], "nothing is stale, nothing is lost"
    batch.run(batch_case.write_pipeline(site, "window_s = 4.0", steps='["simulate"]'), workers=1)
    assert list(json.loads(record.read_text())["steps"]) == ["simulate"]


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


def test_a_worker_that_dies_takes_only_its_own_log_with_it(site):
    for number, name in enumerate(("killer", "leaver", "z1", "z2")):
        batch_case.write_log(site / "logs" / f"{name}.csv", seed=50 + number)
    tasks = tasks_of(batch_case.write_pipeline(site))
    ended = {task.log.stem: outcome for task, outcome in execute(tasks, batch_case.deadly, batch.died, workers=2)}
    assert len(ended) == len(tasks) == 7
    assert sorted(n for n, o in ended.items() if o["status"] != "done") == ["killer", "leaver"]
    assert "SIGKILL" in ended["killer"]["record"]["reason"]
    assert "code 9" in ended["leaver"]["record"]["reason"]


def test_a_log_whose_worker_died_is_tried_again_by_the_next_run(site):
    """It may have lacked memory that is there now."""
    batch_case.write_log(site / "logs" / "killer.csv", seed=50)
    path = batch_case.write_pipeline(site)
    list(execute(tasks_of(path), batch_case.deadly, batch.died, workers=1))
    assert [t.log.stem for t in tasks_of(path)] == ["killer"]
    assert counts(batch.run(path, workers=1)) == {"done": 1, "unchanged": 3}
    assert not list((site / "reports" / "quarantine").iterdir())


def test_a_log_that_takes_too_long_is_set_aside(site):
    batch_case.write_log(site / "logs" / "hanger.csv", seed=50)
    tasks = [t for t in tasks_of(batch_case.write_pipeline(site)) if t.log.stem == "hanger"]
    began = time.monotonic()
    [(_, outcome)] = execute(tasks, batch_case.slow, batch.died, workers=2, timeout_s=1.0)
    assert time.monotonic() - began < 30
    assert "timeout_s = 1 s" in outcome["record"]["reason"]


def test_kill_9_in_the_middle_and_start_again(site):
    """Nothing half-written is taken for a result, and what was finished is not done again."""
    for number in range(3):
        batch_case.write_log(site / "logs" / f"more{number}.csv", seed=100 + number)
    path = batch_case.write_pipeline(site)
    code_on_disk = f"import sys; sys.path.insert(0, {str(CASES)!r})\nimport batch_case\nfrom rovval.pipeline import batch\n"
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
    batch.run(path, workers=1)
    assert not list((site / "reports").rglob(".*.part"))


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


def test_every_problem_of_a_pipeline_file_is_named_at_once(tmp_path):
    path = tmp_path / "p.toml"
    path.write_text('steps = ["fly"]\nwindow_s = "x"\ntolerances = ["bow=1"]\nspeed = 3\n[[source]]\nlogs = []\n')
    with pytest.raises(UsageProblem) as refused:
        config.load(path)
    for word in ("name", "steps.0", "window_s", "tolerances", "speed", "source.0.logs"):
        assert word in refused.value.message
    assert "problems" in refused.value.message


def test_vehicles_and_profiles_are_looked_up_before_the_first_log(tmp_path):
    path = tmp_path / "p.toml"
    path.write_text('name = "p"\n[[source]]\nlogs = ["*.csv"]\nprofile = "nope"\nvehicle = "nada"\n')
    with pytest.raises(UsageProblem) as refused:
        config.load(path)
    assert "nope" in refused.value.message
    assert "nada" in refused.value.message


def test_a_pattern_in_a_folder_that_is_not_there_is_a_mistake(tmp_path):
    path = batch_case.write_pipeline(tmp_path)
    with pytest.raises(UsageProblem, match=r"logs/\*.csv"):
        batch.run(path)
    (tmp_path / "logs").mkdir()
    assert counts(batch.run(path)) == {}


def test_a_cluster_without_dask_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(UsageProblem) as refused:
        list(cluster.execute((), batch_case.paused, batch.died, "tcp://localhost:1"))
    assert "rovval[cluster]" in refused.value.hint


def test_workers_and_scheduler_exclude_each_other(site):
    with pytest.raises(UsageProblem):
        batch.run(batch_case.write_pipeline(site), workers=2, scheduler="tcp://localhost:1")


@pytest.mark.slow
def test_a_dask_cluster_gives_the_same_outcomes(site):
    """With real worker processes; needs the extra `cluster`."""
    distributed = pytest.importorskip("distributed", reason="pip install 'rovval[cluster]'")
    (site / "logs" / "bad.csv").write_text("this is,not a log\n1,2\n")
    path = batch_case.write_pipeline(site)
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as dask:
        done = batch.run(path, scheduler=dask.scheduler_address)
    assert counts(done) == {"done": 3, "quarantined": 1}
    assert counts(batch.run(path, workers=1)) == {"unchanged": 3, "quarantined": 1}


def test_the_vehicle_that_a_profile_names_lies_beside_it_and_counts(site, tmp_path, monkeypatch):
    """It was looked for in the working directory, where cron is somewhere else; and edited it left its logs unchanged."""
    from rovval import vehicle
    from rovval.ingest import profile

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
    monkeypatch.setattr("rovval.pipeline.plan.code_on_disk", lambda: "0123456789ab")
    monkeypatch.setattr("rovval.pipeline.worker.code_of_this_process", lambda: "0123456789ab")
    reasons = {why(task) for task in batch.dry_run(path).todo}
    assert reasons == {f"made by other code of rovval ({code_on_disk()}; now 0123456789ab)"}
    assert {work(task)["status"] for task in tasks_of(path)} == {"done"}
    assert counts(batch.run(path, workers=1)) == {"unchanged": 3}


def test_a_run_of_other_code_gives_way_in_the_archive(site):
    """It used to stand in the way: the log was set aside for holding another run of the same id."""
    path = batch_case.write_pipeline(site)
    batch.run(path, workers=1)
    old = load_run(run_ids(site / "archive")[0], site / "archive")
    shutil.rmtree(site / "archive" / old.id)
    other = replace(old, values={**old.values, "z": old.values["z"] + 1.0}, findings=(Finding("odd", "z", "deeper"),))
    save_run(other, site / "archive")
    with pytest.raises(BadInput, match="another run of the same id"):
        save_run(old, site / "archive")
    save_run(old, site / "archive", overwrite=True)
    found = load_run(old.id, site / "archive")
    assert found.findings == old.findings and (found.values["z"] == old.values["z"]).all()
    assert [p.name for p in (site / "archive").iterdir() if p.name.startswith(".")] == []


def test_a_worker_of_other_code_stops_the_batch_and_sets_no_log_aside(site):
    [task, *_] = tasks_of(batch_case.write_pipeline(site))
    outcome = work(replace(task, code="0123456789ab"))
    assert outcome["status"] == "stopped" and "restart the workers" in outcome["record"]["next"]
    assert not (site / "reports" / "quarantine").exists()


def test_the_code_of_results_is_what_computes_them():
    """Not the tests, the blind check or the command line; vehicles and profiles count by their own content."""
    assert code_on_disk() == source_hash(NO_RESULT, (".py",)) != source_hash((), (".py",))
    assert re.fullmatch("[0-9a-f]{12}", code_on_disk())
