"""The catalogue: read by other libraries as it is by ours, a row a log, nothing lost that is not replaced, asked in SQL."""

from __future__ import annotations

import time
from datetime import datetime

import duckdb
import pandas as pd
import polars as pl
import pytest
from catalogue_case import BEGAN, NOW, row

from rovval.core.errors import BadInput, UsageProblem
from rovval.storage import catalogue


def files(archive):
    return {p.relative_to(archive).as_posix(): (p.stat().st_ino, p.read_bytes()) for p in archive.rglob("*.parquet")}


def test_polars_duckdb_and_pandas_read_the_same_table(tmp_path):
    """The oracles are three readers of hive-partitioned Parquet that know nothing of ours."""
    rows = [row(n, vehicle=("merlin", "my vehicle=2/ä")[n % 2], surge=None if n == 4 else 0.01 * n) for n in range(400)]
    catalogue.update(tmp_path, rows, NOW)
    place = tmp_path / "catalogue"
    ours = catalogue.load(tmp_path)
    assert len(ours) == 400 and ours["year"].unique().sort().to_list() == [2026, 2027]
    by_polars = pl.read_parquet(place / "**/*.parquet", hive_partitioning=True).sort("date")
    assert by_polars.select("vehicle", "year", "surge", "causes").rows() == ours.select("vehicle", "year", "surge", "causes").rows()
    sums = "vehicle, count(*), sum(surge), sum(causes[1].parameters[1].high)"
    asked = duckdb.sql(f"select {sums} from read_parquet('{place}/**/*.parquet', hive_partitioning=true) group by 1")
    assert asked is not None
    by_duckdb = {name: tuple(numbers) for name, *numbers in asked.fetchall()}
    for vehicle, part in ours.group_by("vehicle"):
        assert by_duckdb[vehicle[0]] == pytest.approx((len(part), part["surge"].sum(), 0.4 * len(part)))
    by_pandas = pd.read_parquet(place)
    assert by_pandas["surge"].sum() == pytest.approx(ours["surge"].sum()) and set(by_pandas["run"]) == set(ours["run"])


def test_a_log_has_one_row_and_its_earlier_content_stays(tmp_path):
    later = datetime(2026, 11, 2, tzinfo=NOW.tzinfo)
    catalogue.update(tmp_path, [row(n) for n in range(3)], NOW)
    same_log_other_content = row(0, sha256="f" * 64, run="d00000-cd")
    moved = row(1, log="/logs/old/d00001.csv")
    judged_anew = row(2, method="n", surge=0.07)
    catalogue.update(tmp_path, [same_log_other_content, moved, judged_anew], later)
    table = catalogue.load(tmp_path).select("run", "log", "surge", "current", "evaluated").sort("run").rows()
    assert table == [
        ("d00000-ab", "/logs/d00000.csv", 0.05, False, NOW),
        ("d00000-cd", "/logs/d00000.csv", 0.05, True, later),
        ("d00001-ab", "/logs/old/d00001.csv", 0.05, True, NOW),
        ("d00002-ab", "/logs/d00002.csv", 0.07, True, later),
    ]
    catalogue.update(tmp_path, [row(0)], later)  # the log is put back
    assert dict(catalogue.load(tmp_path).filter(log="/logs/d00000.csv").select("run", "current").rows()) == {"d00000-ab": True, "d00000-cd": False}


def test_other_pipelines_and_logs_that_a_batch_did_not_see_are_left_alone(tmp_path):
    catalogue.update(tmp_path, [row(0), row(1)], NOW)
    catalogue.update(tmp_path, [row(0, pipeline="weekly", vehicle="minerva")], NOW)
    assert catalogue.load(tmp_path)["current"].to_list() == [True, True, True]
    catalogue.update(tmp_path, [row(0, vehicle="minerva")], NOW)  # the vehicle of the pipeline file was wrong
    assert sorted(catalogue.load(tmp_path).select("pipeline", "vehicle", "run").rows()) == [
        ("nightly", "merlin", "d00001-ab"), ("nightly", "minerva", "d00000-ab"), ("weekly", "minerva", "d00000-ab"),
    ]  # fmt: skip
    catalogue.update(tmp_path, [row(1, vehicle="minerva")], NOW)
    assert set(files(tmp_path)) == {"catalogue/vehicle=minerva/year=2026/runs.parquet"}


def test_only_files_whose_rows_change_are_written(tmp_path):
    rows = [row(n) for n in range(400)]
    catalogue.update(tmp_path, rows, NOW)
    before = files(tmp_path)
    catalogue.update(tmp_path, rows, datetime(2027, 1, 1, tzinfo=NOW.tzinfo))
    assert files(tmp_path) == before
    catalogue.update(tmp_path, [row(399, surge=1.0)], NOW)
    assert {name for name, file in files(tmp_path).items() if file != before[name]} == {"catalogue/vehicle=merlin/year=2027/runs.parquet"}


def test_a_damaged_file_is_refused_by_name_and_set_aside_by_the_next_batch(tmp_path):
    rows = [row(n) for n in range(400)]
    catalogue.update(tmp_path, rows, NOW)
    place = tmp_path / "catalogue/vehicle=merlin/year=2026/runs.parquet"
    place.write_bytes(place.read_bytes()[:1000])
    with pytest.raises(BadInput, match=r"year=2026/runs.parquet: damaged"):
        catalogue.find(tmp_path)
    assert catalogue.update(tmp_path, rows, NOW) == [f"{place}: damaged, set aside as .runs.parquet.damaged"]
    assert len(catalogue.load(tmp_path)) == 400 and len(pl.read_parquet(tmp_path / "catalogue/**/*.parquet")) == 400


def test_where_is_sql_and_since_is_a_date(tmp_path):
    catalogue.update(tmp_path, [row(n, surge=0.01 * n, vehicle="merlin" if n % 2 else "minerva") for n in range(20)], NOW)
    found = catalogue.find(tmp_path, "vehicle = 'merlin' and surge > 0.1 or verdict = 'unknown'", BEGAN.replace(tzinfo=None))
    assert [r["surge"] for r in found] == pytest.approx([0.11, 0.13, 0.15, 0.17, 0.19])
    assert found[0]["causes"][0]["parameters"][0]["value"] == 0.3
    assert len(catalogue.find(tmp_path, since=datetime(2026, 3, 20))) == 2
    assert catalogue.find(tmp_path / "nothing there", "surge > 0") == []


@pytest.mark.parametrize("where", ["depth > 3", "surge >", "1 = 1); DROP TABLE runs; --", "surge = 'fast'", "run"])
def test_what_is_no_condition_is_refused_with_the_columns_there_are(tmp_path, where):
    catalogue.update(tmp_path, [row()], NOW)
    with pytest.raises(UsageProblem) as refused:
        catalogue.find(tmp_path, where)
    assert "surge, sway" in refused.value.hint and where in refused.value.message


def test_ten_thousand_runs_are_answered_in_under_a_second(tmp_path):
    catalogue.update(tmp_path, [row(n, vehicle=f"v{n % 5}", surge=0.00002 * n) for n in range(10_000)], NOW)
    began = time.process_time()
    found = catalogue.find(tmp_path, "vehicle = 'v3' and surge > 0.1", datetime(2030, 1, 1))
    assert len(found) == 1000 and time.process_time() - began < 1.0


def test_a_disk_that_takes_no_more_is_a_refusal_and_the_table_of_before_stays(tmp_path, no_more_than):
    catalogue.update(tmp_path, [row(1)], NOW)
    before = files(tmp_path)
    with no_more_than(4096), pytest.raises(UsageProblem, match=r"runs\.parquet: cannot be written"):
        catalogue.update(tmp_path, [row(n) for n in range(400)], NOW)
    assert files(tmp_path) == before
