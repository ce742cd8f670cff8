"""Folders and prefixes of an object store are used alike, and a record names what lies in either so that it is found again."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from rovval.core.errors import UsageProblem
from rovval.storage.places import below, is_remote, name_from, named, place

DISK, STORE, OTHER = "/data/reports", "s3://dives/reports", "s3://elsewhere/archive"


@pytest.mark.parametrize("base", [DISK, STORE])
@pytest.mark.parametrize("kept", ["/data/reports/a/r.html", "/data/archive/run", "s3://dives/reports/a/r.html", "s3://dives/archive/run", OTHER])
def test_what_a_record_names_is_found_again(base, kept):
    pytest.importorskip("upath", reason="pip install 'rovval[object-store]'")
    name = name_from(place(base), place(kept))
    assert str(named(place(base), name)) == kept
    assert name.startswith("..") or name == "a/r.html" or name == kept


def test_only_folders_and_s3_are_places(monkeypatch):
    for address in ("gs://b/x", "http://h/x", "file:///x", "S3A://b"):
        with pytest.raises(UsageProblem, match="is no place that rovval reads or writes"):
            place(address)
    monkeypatch.setitem(sys.modules, "upath", None)
    with pytest.raises(UsageProblem) as refused:
        place(STORE)
    assert "rovval[object-store]" in refused.value.hint
    assert place(DISK) == Path(DISK) and not is_remote(Path(DISK))


def test_an_address_is_not_relative_to_a_pipelines_file():
    pytest.importorskip("upath", reason="pip install 'rovval[object-store]'")
    assert str(below(Path("/p"), place(STORE))) == STORE and below(Path("/p"), Path("a")) == Path("/p/a")
