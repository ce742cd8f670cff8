"""What stays when logs change and rovval is updated: by the rule of the pipeline file, and nothing else goes."""

import os
import time

import batch_case
from batch_case import counts

from rovval.pipeline import batch
from rovval.pipeline.planning import records
from rovval.storage import catalogue


def folders(site):
    return {folder.name for folder in (site / "reports").glob("?-*")}


def test_reports_on_former_content_go_when_their_time_is_over(site):
    path = batch_case.write_pipeline(site, "keep_replaced_days = 30")
    batch.run(path, workers=1)
    before = folders(site)
    log = batch_case.write_log(site / "logs" / "a.csv", seed=50)
    (site / "logs" / "b.csv").unlink()  # gone is not replaced
    assert batch.run(path, workers=1)["removed"] == [] and before < folders(site)
    month = time.time() - 31 * 86400
    os.utime(log, (month, month))
    done = batch.run(path, workers=1)
    [gone] = done["removed"]
    assert gone.startswith("a-") and gone in before and folders(site) >= before - {gone} and len(folders(site)) == 3
    table = catalogue.load(site / "archive")
    assert len(table) == 4 and table["current"].sum() == 3  # its row and its run stay


def test_without_the_rule_everything_stays(site):
    path = batch_case.write_pipeline(site)
    batch.run(path, workers=1)
    before = folders(site)
    os.utime(batch_case.write_log(site / "logs" / "a.csv", seed=50), (0, 0))
    assert batch.run(path, workers=1)["removed"] == [] and folders(site) > before


def test_an_update_is_taken_up_over_several_nights_the_newest_dives_first(site):
    for age, name in ((300, "a"), (100, "b"), (200, "c")):
        os.utime(site / "logs" / f"{name}.csv", (age * 1e6, 1e9 - age * 1e6))
    path = batch_case.write_pipeline(site, "most_redone = 1")
    assert counts(batch.run(path, workers=1)) == {"done": 3}  # new ones are not limited
    for folder in (site / "reports").glob("?-*"):
        record = records.read_record(folder)
        assert record is not None
        for step in record["steps"].values():
            step["key"], step["code"] = "of other code", "other"
        records.write_record(folder, record)
    batch_case.write_log(site / "logs" / "new.csv", seed=70)
    assert len(batch.dry_run(path).postponed) == 2
    first = batch.run(path, workers=1)
    assert counts(first) == {"done": 2, "postponed": 2}
    assert [row["log"].rpartition("/")[2] for row in first["done"]] == ["new.csv", "b.csv"]
    assert len(catalogue.load(site / "archive")) == 4 and "c.csv" not in str(first["waiting"])
    assert "c-" in (site / "reports" / "index.html").read_text()  # as it was judged before
    assert [counts(batch.run(path, workers=1)) for _ in range(3)] == [
        {"done": 1, "unchanged": 2, "postponed": 1}, {"done": 1, "unchanged": 3}, {"unchanged": 4},
    ]  # fmt: skip
