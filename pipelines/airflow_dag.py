"""rovval in Airflow: each log is a task of its own, then one closes the night. Copy it into the folder of DAGs; docs/schedulers/airflow.md."""

from __future__ import annotations

import json
import os
import subprocess
from datetime import datetime

from airflow.sdk import dag, task
from airflow.sdk.exceptions import AirflowSkipException

PIPELINE = os.environ.get("ROVVAL_PIPELINE", "/srv/rovval/pipelines/nightly.toml")
AT_ONCE = 4  # logs at a time, one core each
MOST = 1000  # tasks a night: Airflow maps to at most 1024 (core.max_map_length); the last task does whatever is left
SET_ASIDE = 3


@dag(schedule="30 2 * * *", start_date=datetime(2026, 1, 1), catchup=False, max_active_runs=1)
def rovval_nightly() -> None:
    """Every log that is new or changed, then what closes the night."""

    @task
    def logs() -> list[str]:
        said = subprocess.run(["rovval", "run", PIPELINE, "--list", "--json"], check=True, stdout=subprocess.PIPE).stdout
        return [log["id"] for log in json.loads(said)["logs"] if log["state"] == "do"][:MOST]

    @task(max_active_tis_per_dagrun=AT_ONCE, map_index_template="{{ log_id }}")
    def log(identity: str) -> None:
        from airflow.sdk import get_current_context

        get_current_context()["log_id"] = identity
        code = subprocess.run(["rovval", "run", PIPELINE, "--only", identity], check=False).returncode
        if code == SET_ASIDE:
            raise AirflowSkipException("set aside; the task's log has the reason")
        if code:
            raise RuntimeError(f"rovval ended with {code}")

    @task(trigger_rule="all_done")
    def night() -> None:
        """Finds the logs done, writes catalogue, summary and page; fails as `rovval run` does, for the alert."""
        subprocess.run(["rovval", "run", PIPELINE, "--quiet"], check=True)

    log.expand(identity=logs()) >> night()


rovval_nightly()
