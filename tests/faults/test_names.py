"""Names of logs as nobody would give them: each log is done or set aside with its reason, none is lost, and what is said of it is text."""

from __future__ import annotations

import json
import os
from pathlib import Path

import batch_case
import page_case
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rovval.pipeline import batch
from rovval.storage import catalogue
from rovval.storage.archive import run_ids

pytestmark = pytest.mark.slow

SPITE = [
    "-rf", "$(touch x)", "`id`", "a;b", "a b", "'", '"', "<script>alert(1)", "{{ 7*7 }}", "%2e%2e%2f", "x..csv",
    "*", "[a]", "?", "~", "#", "\n", "\t", "\\",
    "\u202etxt", "é", "e\u0301", "İ", "CON", "nul.csv.csv", "s3:", "a=b", "vehicle=x", "\x1b[31m", "n" * 251, "ü" * 125, ",", "|", "\x7f",
]  # fmt: skip
ANY = st.binary(min_size=1, max_size=251).filter(lambda name: not {0, ord("/")} & set(name) and not name.startswith(b"."))
NAMES = st.lists(st.one_of(st.sampled_from(SPITE).map(os.fsencode), ANY), min_size=4, max_size=12, unique=True)


@settings(max_examples=12, deadline=None, suppress_health_check=list(HealthCheck))
@given(names=NAMES)
def test_hostile_names(tmp_path_factory, names):
    site = tmp_path_factory.mktemp("site")
    (site / "logs").mkdir()
    for seed, name in enumerate(names):
        batch_case.write_log(Path(os.fsdecode(os.fsencode(site / "logs") + b"/" + name + b".csv")), seconds=3.0, seed=seed)
    path = batch_case.write_pipeline(site)
    done = batch.run(path, workers=1)
    assert done["counts"]["done"] + done["counts"]["quarantined"] == len(names), done["counts"]
    assert done["exit_code"] == (3 if done["counts"]["quarantined"] else 0)
    assert all("not UTF-8" in log["reason"] for log in done["quarantined"]), done["quarantined"]
    assert {log["log"] for log in done["done"]} <= {str(log) for log in (site / "logs").iterdir()}
    assert len(run_ids(site / "archive")) == len(catalogue.load(site / "archive")) == done["counts"]["done"]
    page_case.check_html((site / "reports" / "index.html").read_text())
    assert "<script>alert(1)" not in (site / "reports" / "index.html").read_text()
    assert {p.name for p in site.iterdir()} == {"logs", "archive", "reports", "nightly.toml"}, "nothing is written anywhere else"
    assert json.loads((site / "reports" / "summary.json").read_text()) == done
    again = batch.run(path, workers=1)
    assert again["counts"]["unchanged"] == done["counts"]["done"] and again["counts"]["done"] == 0
