"""Tasks one by one, as an outer scheduler starts them: the same records, quarantine and results as a batch's."""

import json
from concurrent.futures import ThreadPoolExecutor

import batch_case
import pytest
from batch_case import counts
from typer.testing import CliRunner

from rovval.cli.app import app
from rovval.core.errors import UsageProblem
from rovval.pipeline import batch
from rovval.storage import lock
from rovval.storage.archive import run_ids


def command(*args):
    done = CliRunner().invoke(app, ["run", *map(str, args)])
    return done.exit_code, done.stdout


def ids(path):
    code, said = command(path, "--list", "--json")
    assert code == 0
    return {log["log"].rpartition("/")[2]: log["id"] for log in json.loads(said)["logs"] if log["state"] == "do"}


def test_tasks_done_one_by_one_are_those_of_a_batch(site):
    path = batch_case.write_pipeline(site)
    (site / "logs" / "bad.csv").write_text("no log\n")
    tasks = ids(path)
    assert set(tasks) == {"a.csv", "b.csv", "c.csv", "bad.csv"}
    with ThreadPoolExecutor(2) as pool:
        outcomes = dict(zip(tasks, pool.map(lambda identity: batch.run_only(path, identity), tasks.values()), strict=True))
    status = {name: outcome and outcome["status"] for name, outcome in outcomes.items()}
    assert status == {"a.csv": "done", "b.csv": "done", "c.csv": "done", "bad.csv": "quarantined"}
    assert len(run_ids(site / "archive")) == 3 and not (site / "reports" / "summary.json").exists()
    assert counts(batch.run(path, workers=1)) == {"unchanged": 3, "quarantined": 1}
    assert ids(path) == {}


def test_the_exit_code_is_the_tasks_own(site):
    path = batch_case.write_pipeline(site)
    (site / "logs" / "bad.csv").write_text("no log\n")
    tasks = ids(path)
    code, said = command(path, "--only", tasks["a.csv"], "--json")
    assert code == 0 and json.loads(said)["record"]["log"].endswith("a.csv")
    assert command(path, "--only", tasks["bad.csv"])[0] == 3
    assert command(path, "--only", "nothing-00000000") == (0, "")


def test_a_batch_and_a_task_of_it_do_not_run_at_once(site):
    path = batch_case.write_pipeline(site)
    identity = ids(path)["a.csv"]
    with lock.held(site / "reports"), pytest.raises(UsageProblem, match="another run is at work"):
        batch.run_only(path, identity)
    with lock.held(site / "reports", shared=True), pytest.raises(UsageProblem, match="another run is at work"):
        batch.run(path)
    with lock.held(site / "reports" / ".locks" / identity), pytest.raises(UsageProblem, match="another run is at work"):
        batch.run_only(path, identity)
