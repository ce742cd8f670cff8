"""rovval in Prefect: each log is a task of its own, then one closes the night. `python prefect_flow.py` serves it; docs/schedulers/prefect.md."""

from __future__ import annotations

import json
import os
import subprocess

from prefect import flow, task
from prefect.futures import wait
from prefect.states import Completed, State
from prefect.task_runners import ThreadPoolTaskRunner

PIPELINE = os.environ.get("ROVVAL_PIPELINE", "/srv/rovval/pipelines/nightly.toml")
AT_ONCE = 4  # logs at a time, one core each
SET_ASIDE = 3


@task(task_run_name="{identity}")
def log(pipeline: str, identity: str) -> State:
    """One log through its steps."""
    code = subprocess.run(["rovval", "run", pipeline, "--only", identity], check=False).returncode
    if code == SET_ASIDE:
        return Completed(name="SetAside", message="the reason is in the quarantine of the reports")
    if code:
        raise RuntimeError(f"rovval ended with {code}")
    return Completed()


@flow(name="rovval-nightly", task_runner=ThreadPoolTaskRunner(max_workers=AT_ONCE))
def nightly(pipeline: str = PIPELINE) -> None:
    """One task a log, then the batch that finds them done and writes catalogue, summary and page; fails as `rovval run` does."""
    said = subprocess.run(["rovval", "run", pipeline, "--list", "--json"], check=True, stdout=subprocess.PIPE).stdout
    wait([log.submit(pipeline, found["id"]) for found in json.loads(said)["logs"] if found["state"] == "do"])
    subprocess.run(["rovval", "run", pipeline, "--quiet"], check=True)


if __name__ == "__main__":
    nightly.serve(name="every-night", cron="30 2 * * *")
