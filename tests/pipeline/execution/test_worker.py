"""A worker: what is no log's fault stops the batch and sets no log aside."""

import errno
import os
from dataclasses import replace
from pathlib import Path

import batch_case
from batch_case import tasks_of

from rovval.pipeline.execution.worker import work


def test_a_worker_of_other_code_stops_the_batch_and_sets_no_log_aside(site):
    [task, *_] = tasks_of(batch_case.write_pipeline(site))
    outcome = work(replace(task, code="0123456789ab"))
    assert outcome["status"] == "stopped" and "restart the workers" in outcome["record"]["next"]
    assert not (site / "reports" / "quarantine").exists()


def test_a_full_disk_stops_the_batch_and_sets_no_log_aside(site, monkeypatch):
    [task, *_] = tasks_of(batch_case.write_pipeline(site))

    def full(*_: object, **__: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with monkeypatch.context() as disk:
        disk.setattr(Path, "write_text", full)
        outcome = work(task)
    assert outcome["status"] == "stopped" and "No space left" in outcome["record"]["reason"]
    assert not (site / "reports" / "quarantine").exists()
    assert work(task)["status"] == "done", "once there is space"
