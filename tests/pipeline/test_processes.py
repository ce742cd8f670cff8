"""Workers of this machine: one that dies or hangs costs its own log and no other."""

import time

import batch_case
from batch_case import counts, tasks_of

from rovval.pipeline import batch
from rovval.pipeline.processes import execute


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
