"""A clock that is set back and forward, between nights and in the middle of one: nothing is lost, made twice or waited for."""

from __future__ import annotations

import json
import os
import time

import batch_case
import fault_case
import pytest

pytestmark = pytest.mark.slow

INGEST = '["ingest"]'
YEAR_S = 365 * 86400.0
SHIFTED = """
import os, random, time
real, shifts = time.time, [float(s) for s in os.environ["ROVVAL_TEST_CLOCK"].split()]
time.time = lambda: real() + random.choice(shifts)
time.time_ns = lambda: int(time.time() * 1e9)
gmtime = time.gmtime
time.gmtime = lambda seconds=None: gmtime(time.time() if seconds is None else seconds)
"""
CLOCKS = {"set back": (-10 * YEAR_S,), "set forward": (10 * YEAR_S,), "jumps while it runs": (-10 * YEAR_S, -3600.0, 0.0, 3600.0, 10 * YEAR_S)}


@pytest.fixture
def clock(tmp_path, monkeypatch):
    """Sets the clock of every process that is started from now on; to several times at once, it has another whenever it is asked."""
    (tmp_path / "clock").mkdir()
    (tmp_path / "clock" / "sitecustomize.py").write_text(SHIFTED)
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(tmp_path / "clock"), *filter(None, [os.environ.get("PYTHONPATH")])]))

    def to(*shifts: float) -> None:
        monkeypatch.setenv("ROVVAL_TEST_CLOCK", " ".join(map(str, shifts)))

    return to


@pytest.mark.parametrize("shifts", CLOCKS.values(), ids=CLOCKS.keys())
def test_the_clock(tmp_path, logs, undisturbed, clock, shifts):
    whole, night = undisturbed(INGEST), fault_case.Night(tmp_path / "night", logs, INGEST, "settle_s = 60.0")
    clock(*shifts)
    assert night.whole() == 0
    fault_case.check_all(night, whole)
    ended = json.loads((night.folder / "reports" / "summary.json").read_text())["ended"]
    assert abs(int(ended[:4]) - time.gmtime().tm_year) in ({0, 10} if len(shifts) > 1 else {10}), "the clock was not set"
    for backwards in ((0.0,), shifts):  # the clock is put right, and goes wrong again
        clock(*backwards)
        assert night.whole() == 0
        fault_case.check_all(night, whole)
        assert json.loads((night.folder / "reports" / "summary.json").read_text())["counts"]["unchanged"] == fault_case.LOGS


def test_a_log_of_a_wrong_clock_is_taken_when_it_no_longer_changes(tmp_path, clock):
    """Its time of change is ten years ahead of the batch's clock; one that is being written has the batch's time, whatever that is."""
    logs = fault_case.logs_in(tmp_path / "logs")
    for log in logs.iterdir():
        os.utime(log)
    night = fault_case.Night(tmp_path / "night", logs, INGEST, "settle_s = 3600.0")
    for clocked in ((0.0,), (-10 * YEAR_S,)):
        clock(*clocked)
        assert night.whole() == 0
        counts = batch_case.counts(json.loads((night.folder / "reports" / "summary.json").read_text()))
        assert counts == ({"waiting": fault_case.LOGS} if clocked == (0.0,) else {"done": fault_case.LOGS})
