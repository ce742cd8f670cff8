"""Files appear whole or not at all, and a disk that is full is said so: never as an internal error, never as a log's fault."""

import errno
import os
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

import rovval.cli
from rovval.core.errors import Unwritable, UsageProblem
from rovval.pipeline import worker
from rovval.pipeline.hashes import code_of_this_process
from rovval.storage.atomic import LEFTOVER, drafts, refusal, refuse_unwritable, write_text


def full(*args: object, **kwargs: object) -> None:
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def test_a_failure_leaves_the_old_files_and_nothing_beside_them(tmp_path):
    (tmp_path / "a").write_text("old")

    def half(a: Path, b: Path) -> None:
        a.write_text("new")
        b.write_text("ne")
        full()

    with pytest.raises(Unwritable, match="No space left"), drafts(tmp_path / "a", tmp_path / "b") as [a, b]:
        half(a, b)
    assert [p.name for p in tmp_path.iterdir()] == ["a"]
    assert (tmp_path / "a").read_text() == "old"


def test_a_full_disk_is_named_with_what_to_do(tmp_path, monkeypatch):
    monkeypatch.setattr(Path, "write_text", full)
    with pytest.raises(Unwritable) as refused:
        write_text(tmp_path / "report.md", "text")
    assert str(tmp_path / "report.md") in refused.value.message
    assert "free space" in refused.value.hint
    assert refused.value.exit_code == 2


def test_a_folder_in_place_of_a_file_is_refused_by_its_own_name(tmp_path):
    """The message used to name the draft, which the user never saw."""
    with pytest.raises(UsageProblem, match=rf"^{tmp_path}: cannot be written: Is a directory"):
        write_text(tmp_path, "text")
    assert not list(tmp_path.parent.glob(LEFTOVER))


def test_places_are_checked_before_the_work(tmp_path):
    (tmp_path / "file").touch()
    refuse_unwritable(tmp_path / "deep" / "er" / "d.json", None)
    assert not (tmp_path / "deep").exists()
    for wrong in (tmp_path, tmp_path / "file" / "d.json"):
        with pytest.raises(UsageProblem, match="cannot be written"):
            refuse_unwritable(wrong)


def test_a_full_disk_stops_the_batch_and_sets_no_log_aside(tmp_path, monkeypatch):
    def steps(task: object) -> None:
        raise refusal(tmp_path / "record.json", OSError(errno.ENOSPC, os.strerror(errno.ENOSPC)))

    monkeypatch.setattr(worker, "_steps", steps)
    outcome = worker.work(SimpleNamespace(code=code_of_this_process()))  # type: ignore[arg-type]
    assert outcome["status"] == "stopped"
    assert "No space left" in outcome["record"]["reason"]


def test_a_result_that_cannot_be_printed_is_no_internal_error(monkeypatch, capsys):
    monkeypatch.setattr("rovval.cli.complete.known", full)
    monkeypatch.setattr(sys, "argv", ["rovval", "list", "vehicle"])
    with pytest.raises(SystemExit) as left:
        rovval.cli.main()
    assert left.value.code == 2
    assert "free space" in capsys.readouterr().err
