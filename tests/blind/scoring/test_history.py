"""The history of unsealings is the repository's, found from the source tree, and no part of what is installed."""

from pathlib import Path

import rovval
from conftest import ROOT
from rovval.blind.scoring import history


def test_from_a_source_tree_the_repository_keeps_the_history(tmp_path):
    kept = history.default(tmp_path / "set")
    assert kept == ROOT / "reports" / "blind" / "history.jsonl"
    assert {"opened", "seed", "engine", "labels_sha256", "answers_sha256"} <= set(history.read(kept)[0])


def test_the_package_holds_no_history():
    assert not list(Path(rovval.__file__).parent.rglob("*.jsonl"))
