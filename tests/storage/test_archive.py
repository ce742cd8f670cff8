"""The archive: exact round trip, nothing overwritten, nothing half written."""

from __future__ import annotations

import json
from dataclasses import fields, replace

import merlin_case
import numpy as np
import pytest

from rovval.core.data import Run
from rovval.core.errors import BadInput, Finding
from rovval.storage.archive import load_run, open_run, run_ids, save_run


@pytest.fixture
def run(tmp_path) -> Run:
    def spoil(cells):
        cells["LinVelX"][40:60] = [""] * 20

    return open_run(merlin_case.write(tmp_path, edit=spoil))


def same(a: Run, b: Run) -> None:
    for field in fields(Run):
        if field.name in ("values", "reasons"):
            one, two = getattr(a, field.name), getattr(b, field.name)
            assert list(one) == list(two)
            for name in one:
                assert one[name].dtype == two[name].dtype
                assert np.array_equal(one[name], two[name], equal_nan=one[name].dtype == float), name
        else:
            assert getattr(a, field.name) == getattr(b, field.name), field.name


def test_round_trip_is_exact(run, tmp_path):
    place = save_run(run, tmp_path / "archive")
    same(load_run(run.id, tmp_path / "archive"), run)
    same(load_run(place), run)
    same(open_run(run.id, archive=tmp_path / "archive"), run)
    same(open_run(place), run)
    assert run_ids(tmp_path / "archive") == (run.id,)
    assert not run.ok("u").all()


def test_saving_the_same_run_again_changes_nothing(run, tmp_path):
    place = save_run(run, tmp_path)
    before = {p.name: (p.stat().st_mtime_ns, p.read_bytes()) for p in place.iterdir()}
    assert save_run(run, tmp_path) == place
    assert before == {p.name: (p.stat().st_mtime_ns, p.read_bytes()) for p in place.iterdir()}


def test_another_run_under_the_same_id_is_refused(run, tmp_path):
    save_run(run, tmp_path)
    other = replace(run, values={n: v + 1.0 for n, v in run.values.items()})
    with pytest.raises(BadInput, match="another run of the same id"):
        save_run(other, tmp_path)
    same(load_run(run.id, tmp_path), run)


def test_the_manifest_says_what_made_the_run(run, tmp_path):
    manifest = json.loads((save_run(run, tmp_path) / "manifest.json").read_text())
    assert manifest["schema"] == "rovval.run/1"
    assert manifest["sha256"] == run.sha256 and manifest["profile"] == "merlin"
    assert {"rovval", "numpy", "polars", "python"} <= set(manifest["versions"])
    assert manifest["clock"]["stamp"] == "row" and manifest["resampled"]["u"]["samples"] == 280
    assert any(f["code"] == "blank_cell" for f in manifest["findings"])


def test_damage_is_said(run, tmp_path):
    place = save_run(run, tmp_path)
    table = (place / "run.parquet").read_bytes()
    (place / "run.parquet").write_bytes(table[:-20])
    with pytest.raises(BadInput, match=r"not the table"):
        load_run(run.id, tmp_path)
    with pytest.raises(BadInput, match="damaged run"):
        save_run(run, tmp_path)
    (place / "run.parquet").write_bytes(table)
    (place / "manifest.json").write_text("{")
    with pytest.raises(BadInput, match="damaged"):
        load_run(run.id, tmp_path)


def test_a_failed_write_leaves_nothing(run, tmp_path, monkeypatch):
    def full(*_args):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("pathlib.Path.write_bytes", full)
    with pytest.raises(Exception, match="No space left"):
        save_run(run, tmp_path / "archive")
    assert [p.name for p in (tmp_path / "archive").iterdir()] == [".lock"]


def test_unknown_source_names_what_there_is(run, tmp_path):
    save_run(run, tmp_path / "archive")
    with pytest.raises(BadInput, match="no such log file, and no such run") as refused:
        open_run("dive_99", archive=tmp_path / "archive")
    assert run.id in refused.value.hint
    with pytest.raises(BadInput, match="no such run"):
        load_run("dive_99", tmp_path / "archive")
    assert run_ids(tmp_path / "nowhere") == ()


def test_the_id_follows_content_and_profile(run, tmp_path):
    path = merlin_case.write(tmp_path, n=301, name="dive.csv")
    assert open_run(path).id != run.id and open_run(path).id == open_run(path).id
    copy = tmp_path / "elsewhere"
    copy.mkdir()
    moved = copy / "dive.csv"
    moved.write_bytes(path.read_bytes())
    assert open_run(moved).id == open_run(path).id


def test_a_run_of_other_code_gives_way_in_the_archive(run, tmp_path):
    """It used to stand in the way: the log was set aside for holding another run of the same id."""
    save_run(replace(run, values={**run.values, "z": run.values["z"] + 1.0}, findings=(Finding("odd", "z", "deeper"),)), tmp_path / "archive")
    with pytest.raises(BadInput, match="another run of the same id"):
        save_run(run, tmp_path / "archive")
    save_run(run, tmp_path / "archive", overwrite=True)
    same(load_run(run.id, tmp_path / "archive"), run)
    assert {p.name for p in (tmp_path / "archive").iterdir()} == {run.id, ".lock"}, "nothing is left beside it"
