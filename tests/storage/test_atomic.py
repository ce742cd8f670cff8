"""Files appear whole or not at all, and a disk that is full is said so with what to do."""

import errno
import json
import os
from pathlib import Path

import pytest

from rovval.core.errors import Unwritable, UsageProblem
from rovval.storage.atomic import LEFTOVER, drafts, read_json, refuse_unwritable, write_json, write_text


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


def test_a_document_is_read_as_it_was_written_or_not_at_all(tmp_path):
    """Also one with the name of a file that is not UTF-8, which the fast reader refuses."""
    document = {"name": "dive \udcff \u00e9", "numbers": [0.1 + 0.2, -0.0, 1e-320, 2**70, True, None], "": {}}
    write_json(place := tmp_path / "d.json", document)
    assert read_json(place) == document
    whole = place.read_bytes()
    for damaged in (b"", whole[:-3], b"[1]", whole.replace(b"dive", b"d\xffve"), whole + b"}", b"[" * 100_000):
        place.write_bytes(damaged)
        assert read_json(place) is None
    assert json.loads(whole) == document and read_json(tmp_path / "none.json") is None
