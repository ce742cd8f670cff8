"""Several batches at once: of one pipeline one works and the others leave; of two pipelines on one archive both work."""

from __future__ import annotations

import json
import random
import subprocess
import sys
import time

import fault_case
import pytest

from rovval.storage import catalogue

pytestmark = pytest.mark.slow

INGEST = '["ingest"]'
ROUNDS = 5


def test_of_one_pipeline_one_works_and_the_others_leave(tmp_path, logs, undisturbed):
    night, whole, chance, refused = fault_case.Night(tmp_path / "night", logs), undisturbed(INGEST), random.Random(1), 0
    for _ in range(ROUNDS):
        night.wipe()
        started = []
        for _ in range(3):
            started.append(night.start("--workers", "1"))
            time.sleep(chance.uniform(0, 0.5))
        ends = [(process.communicate(timeout=fault_case.PATIENCE_S)[1].decode(), process.returncode) for process in started]
        assert {code for _, code in ends} <= {0, 2} and any(code == 0 for _, code in ends)
        assert all("another run is at work" in said for said, code in ends if code == 2)
        refused += sum(code == 2 for _, code in ends)
        fault_case.check_all(night, whole)
    print(f"\n{ROUNDS} times three at once: {refused} were refused, all equal")
    assert refused >= ROUNDS


def test_two_pipelines_share_an_archive(tmp_path, logs):
    nights = [fault_case.Night(tmp_path / name, logs) for name in ("first", "second")]
    shared = tmp_path / "archive"
    for night in nights:
        text = night.path.read_text().replace('"nightly"', f'"{night.folder.name}"').replace('archive = "archive"', f'archive = "{shared}"')
        night.path.write_text(text)
    for process in [night.start() for night in nights]:
        said = process.communicate(timeout=fault_case.PATIENCE_S)[1]
        assert process.returncode == 0, said.decode()
    rows = [(row["pipeline"], row["log"]) for row in catalogue.find(shared)]
    assert len(rows) == len(set(rows)) == 2 * fault_case.LOGS and len(list(shared.glob("*/manifest.json"))) == fault_case.LOGS
    for night in nights:
        assert json.loads((night.folder / "reports" / "summary.json").read_text())["counts"]["done"] == fault_case.LOGS
        checked = [sys.executable, "-m", "rovval", "archive", "check", "--archive", str(shared), "--reports", str(night.folder / "reports")]
        assert subprocess.run(checked, check=False, capture_output=True).returncode == 0
