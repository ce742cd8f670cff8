"""Workers of a Dask cluster: the same outcomes, whatever dies meanwhile, and a missing library is said with how to get it."""

import sys
import threading
import time
from pathlib import Path

import batch_case
import dask_case
import pytest
from batch_case import counts, tasks_of

from rovval.core.errors import UsageProblem
from rovval.pipeline import batch
from rovval.pipeline.execution import cluster
from rovval.pipeline.execution.worker import work


@pytest.fixture
def dask():
    return pytest.importorskip("distributed", reason="pip install 'rovval[cluster]'")


def stems(ended):
    return {task.log.stem: outcome for task, outcome in ended}


def test_a_cluster_without_dask_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(UsageProblem) as refused:
        list(cluster.execute((), batch_case.paused, batch.died, "tcp://localhost:1"))
    assert "rovval[cluster]" in refused.value.hint


@pytest.mark.slow
def test_a_dask_cluster_gives_the_same_outcomes(site, dask):
    (site / "logs" / "bad.csv").write_text("this is,not a log\n1,2\n")
    path = batch_case.write_pipeline(site)
    with dask_case.cluster(2) as made:
        done = batch.run(path, scheduler=made.address)
    assert counts(done) == {"done": 3, "quarantined": 1}
    assert counts(batch.run(path, workers=1)) == {"unchanged": 3, "quarantined": 1}


@pytest.mark.slow
def test_a_scheduler_without_workers_is_not_waited_for(site, dask, monkeypatch):
    """The batch waited in silence, for ever."""
    monkeypatch.setattr(cluster, "PATIENCE_S", 1.0)
    with dask_case.cluster(0) as made, pytest.raises(UsageProblem, match="no worker for 1 s"):
        batch.run(batch_case.write_pipeline(site), scheduler=made.address)
    assert "Stopped before its end (1)" in (site / "reports" / "index.html").read_text()


@pytest.mark.slow
@pytest.mark.parametrize("nanny", ["--nanny", "--no-nanny"])
def test_a_log_that_takes_too_long_is_set_aside(site, dask, nanny):
    """``timeout_s`` counted on one machine only. A worker without a nanny is not started again: the other goes on."""
    batch_case.write_log(site / "logs" / "hanger.csv", seed=50)
    tasks = tasks_of(batch_case.write_pipeline(site))
    with dask_case.cluster(2, nanny) as made:
        ended = stems(cluster.execute(tasks, batch_case.slow, batch.died, made.address, timeout_s=20.0))
    assert {name for name, outcome in ended.items() if outcome["status"] == "done"} == {"a", "b", "c"}
    assert "timeout_s = 20 s" in ended["hanger"]["record"]["reason"]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("deadly", "environment"),
    [
        (batch_case.deadly, {}),
        # Dask holds every task of a worker that died for suspicious, also those that it had not begun.
        (batch_case.deadly_after_a_while, {"DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": "0"}),
    ],
    ids=["at_once", "while_others_wait"],
)
def test_a_worker_that_dies_of_a_log_takes_only_it_with_it(site, dask, monkeypatch, deadly, environment):
    for name, value in environment.items():
        monkeypatch.setenv(name, value)
    for number, name in enumerate(("killer", "z1", "z2")):
        batch_case.write_log(site / "logs" / f"{name}.csv", seed=50 + number)
    tasks = tasks_of(batch_case.write_pipeline(site))
    with dask_case.cluster(1) as made:
        ended = stems(cluster.execute(tasks, deadly, batch.died, made.address))
    assert {name for name, outcome in ended.items() if outcome["status"] == "done"} == {"a", "b", "c", "z1", "z2"}
    assert "worker process died" in ended["killer"]["record"]["reason"]


@pytest.mark.slow
def test_a_lost_scheduler_stops_the_batch_and_says_so(site, dask, monkeypatch):
    """It was an internal error."""
    monkeypatch.setattr(batch, "work", batch_case.paused)
    path = batch_case.write_pipeline(site)
    with dask_case.cluster(1) as made:
        killer = threading.Thread(target=kill_when_one_is_done, args=(made, site / "reports"))
        killer.start()
        with pytest.raises(UsageProblem, match="was lost"):
            batch.run(path, scheduler=made.address)
        killer.join()
    assert "Stopped before its end (1)" in (site / "reports" / "index.html").read_text()
    assert sum(counts(batch.run(path, workers=1)).values()) == 3


def kill_when_one_is_done(made: dask_case.Cluster, reports: Path) -> None:
    while not list(reports.glob("*/record.json")):
        time.sleep(0.02)
    assert made.scheduler
    dask_case.kill(made.scheduler)


@pytest.mark.slow
def test_no_more_tasks_are_with_the_scheduler_than_two_for_each_thread(site, dask):
    """All tasks and all results of a night were."""
    for number in range(6):
        batch_case.write_log(site / "logs" / f"more{number}.csv", seed=50 + number)
    tasks, most = tasks_of(batch_case.write_pipeline(site)), 0
    with dask_case.cluster(2) as made, dask.Client(made.address, set_as_default=False) as onlooker:
        for _ in cluster.execute(tasks, work, batch.died, made.address):
            most = max(most, onlooker.run_on_scheduler(lambda dask_scheduler: len(dask_scheduler.tasks)))
    assert len(tasks) == 9 and 1 <= most <= 4
