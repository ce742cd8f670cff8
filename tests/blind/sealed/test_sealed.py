"""A sealed set: its folder tells nothing, it is answered and scored once, and what was changed is not scored."""

import json
import shutil
from pathlib import Path

import pytest

from rovval import vehicle
from rovval.blind.cases.grid import Case
from rovval.blind.cases.questions import Question
from rovval.blind.plant.spec import Planted
from rovval.blind.scoring import history
from rovval.blind.scoring.score import score_set
from rovval.blind.sealed import sealing
from rovval.blind.sealed.answer import answer_set
from rovval.blind.sealed.folder import Folder
from rovval.blind.sealed.make import make_set
from rovval.core.errors import BadInput, UsageProblem

MERLIN = vehicle.LIBRARY / "merlin.toml"


QUESTIONS = (
    Question(Case("rich", (Planted("buoyancy_error", None, 2.0),), 5, 60.0)),
    Question(Case("rich", (), 6, 60.0), without=("waves",)),
)


@pytest.fixture(scope="module")
def sealed(tmp_path_factory) -> Folder:
    root = tmp_path_factory.mktemp("blind") / "set"
    return make_set(root, MERLIN, 3, asked=QUESTIONS)


@pytest.fixture(scope="module")
def committed(sealed: Folder) -> Folder:
    answer_set(sealed.root, baselines=False)
    return sealed


@pytest.fixture
def copy(committed: Folder, tmp_path: Path) -> Folder:
    """A set of its own, answered and committed, to do harm to."""
    shutil.copytree(committed.root, tmp_path / "set")
    shutil.copy(committed.key, tmp_path / "set.key")
    return Folder(tmp_path / "set")


def test_the_folder_tells_nothing(sealed: Folder):
    logs = sorted(sealed.logs.iterdir())
    assert len({p.stat().st_size for p in logs}) == 1
    assert len({p.stat().st_mtime_ns for p in logs}) == 1
    texts = [p.read_text().rstrip("\n").split("\n") for p in logs]
    assert len({t[0] for t in texts}) == 1
    assert len({len(t) for t in texts}) == 1
    assert sealed.key.parent == sealed.root.parent
    for path in sealed.root.rglob("*"):
        assert path.is_dir() or b"buoyancy_error" not in path.read_bytes()


def test_a_set_holds_its_vehicle(copy: Folder):
    """It can be answered and scored where the file that it was made with is not."""
    assert copy.vehicle().parent == copy.root and copy.vehicle().read_bytes() == MERLIN.read_bytes()


def test_a_set_is_never_made_over_another(sealed: Folder, tmp_path: Path):
    with pytest.raises(UsageProblem, match="is not empty"):
        make_set(sealed.root, MERLIN, 3, asked=QUESTIONS)
    (tmp_path / "set.key").write_text("a key of something else\n")
    with pytest.raises(UsageProblem, match="may open another set"):
        make_set(tmp_path / "set", MERLIN, 3, asked=QUESTIONS)


def test_answers_are_made_once(copy: Folder):
    before = {p: p.stat().st_mtime_ns for p in copy.answer_files()}
    assert answer_set(copy.root)["sha256"] == copy.committed()["sha256"]
    assert {p: p.stat().st_mtime_ns for p in copy.answer_files()} == before


@pytest.mark.slow
def test_an_interrupted_run_goes_on_where_it_stopped(copy: Folder):
    kept, lost = copy.answer_files()
    before, text = kept.stat().st_mtime_ns, json.loads(lost.read_text())
    lost.unlink()
    copy.commit.unlink()
    answer_set(copy.root, baselines=False)
    assert kept.stat().st_mtime_ns == before
    again = json.loads(lost.read_text())
    assert again | {"cpu_s": 0} == text | {"cpu_s": 0}


def test_answers_of_two_engines_are_not_mixed(copy: Folder):
    copy.commit.unlink()
    path = copy.answer_files()[0]
    path.write_text(path.read_text().replace('"engine": "', '"engine": "0'))
    with pytest.raises(UsageProblem, match="--fresh"):
        answer_set(copy.root)


def test_what_is_not_committed_is_not_scored(copy: Folder, tmp_path: Path):
    copy.commit.unlink()
    with pytest.raises(UsageProblem, match="not committed"):
        score_set(copy.root, kept=tmp_path / "history.jsonl")
    assert not copy.opened.exists()


@pytest.mark.parametrize("what", ["answer", "log", "labels", "extra"])
def test_what_was_changed_is_not_scored(copy: Folder, tmp_path: Path, what: str):
    first = {"answer": copy.answer_files()[0], "log": next(copy.logs.iterdir()), "labels": copy.labels}
    if what == "extra":
        (copy.answers / "zz.json").write_text("{}")
    else:
        first[what].write_bytes(first[what].read_bytes() + b"\n")
    with pytest.raises(BadInput):
        score_set(copy.root, kept=tmp_path / "history.jsonl")
    assert not copy.opened.exists()


def test_another_set_s_key_opens_nothing(copy: Folder, tmp_path: Path):
    sealing.new_key(tmp_path / "other.key")
    with pytest.raises(BadInput, match="does not fit this key"):
        score_set(copy.root, key=tmp_path / "other.key", kept=tmp_path / "history.jsonl")
    with pytest.raises(UsageProblem, match="no key there"):
        score_set(copy.root, key=tmp_path / "none.key", kept=tmp_path / "history.jsonl")


def test_after_the_unsealing_nothing_new_is_scored(copy: Folder, tmp_path: Path):
    kept = tmp_path / "history.jsonl"
    first = score_set(copy.root, kept=kept)
    assert first["seed"] == 3
    again = score_set(copy.root, kept=kept)
    assert again["strata"] == first["strata"]
    assert len(history.read(kept)) == 1
    for fresh in (False, True):
        with pytest.raises(UsageProblem, match="seal was opened"):
            answer_set(copy.root, fresh=fresh)
    forge(copy)
    with pytest.raises(UsageProblem, match="made or changed"):
        score_set(copy.root, kept=tmp_path / "elsewhere.jsonl")
    copy.opened.unlink()
    with pytest.raises(UsageProblem, match=r"opened at .* to score other answers"):
        score_set(copy.root, kept=kept)
    assert len(history.read(kept)) == 1


def forge(place: Folder) -> None:
    """Change an answer and commit it as if it were new."""
    path = place.answer_files()[0]
    path.write_text(path.read_text() + "\n")
    commit = json.loads(place.commit.read_text())
    place.commit.write_text(json.dumps(commit | {"sha256": sealing.digest_of_files(place.answer_files())}))
