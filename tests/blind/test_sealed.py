"""The seal of the blind check: labels that nobody reads by chance, logs that tell nothing by their looks, and no second try."""

import json
import shutil
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rovval import vehicle
from rovval.blind.cases.grid import Case
from rovval.blind.cases.questions import DECOYS, Question, questions, same_law
from rovval.blind.plant.spec import Planted
from rovval.blind.scoring import ground_truth, history
from rovval.blind.scoring.score import score_set
from rovval.blind.sealed import sealing
from rovval.blind.sealed.answer import answer_set
from rovval.blind.sealed.folder import Folder
from rovval.blind.sealed.make import make_set
from rovval.core.errors import BadInput, UsageProblem
from rovval.plant import Plant

MERLIN = vehicle.LIBRARY / "merlin.toml"
QUESTIONS = (
    Question(Case("rich", (Planted("buoyancy_error", None, 2.0),), 5, 60.0)),
    Question(Case("rich", (), 6, 60.0), without=("waves",)),
)


@settings(deadline=None, max_examples=20)  # scrypt is slow on purpose
@given(st.binary(max_size=300))
def test_what_is_sealed_comes_out_again(text):
    key = b"k" * 64
    assert sealing.unseal(sealing.seal(text, key), key) == text


def test_a_seal_shows_nothing_and_is_another_each_time():
    text = b'{"effects": ["buoyancy_error"]}' * 50
    one, two = sealing.seal(text, b"key"), sealing.seal(text, b"key")
    assert one != two
    assert b"buoyancy" not in one


@pytest.mark.parametrize("place", [0, 25, 60, -1])
def test_a_damaged_seal_is_refused(place):
    sealed = bytearray(sealing.seal(b"labels", b"key"))
    sealed[place] ^= 1
    with pytest.raises(BadInput):
        sealing.unseal(bytes(sealed), b"key")


def test_another_key_is_refused():
    with pytest.raises(BadInput, match="does not fit this key"):
        sealing.unseal(sealing.seal(b"labels", b"key"), b"other")


def test_full_set_asks_about_every_stratum():
    asked = questions(MERLIN, 1, "full")
    assert len(asked) > 300
    left = [q for q in asked if q.left_out]
    assert all(q.case.effects[0].name in q.without for q in left)
    for one in {q.case.effects[0].name for q in left}:
        on = [q.case.effects[0].target for q in left if q.case.effects[0].name == one]
        assert len(on) == 2 and (on[0] != on[1] or on == [None, None])
    decoys = [q for q in asked if q.without and not q.left_out]
    assert 0.5 * DECOYS < len(decoys) / (len(asked) - len(left)) < 1.5 * DECOYS
    for q in decoys:
        assert not set(q.without) & {law for e in q.case.effects for law in same_law(e.name)}


def test_what_is_left_out_is_gone_under_every_name_that_would_be_right():
    library = Plant(vehicle.load("merlin")).hypotheses
    for q in questions(MERLIN, 1, "full"):
        if q.left_out:
            [e] = q.case.effects
            planted = {"name": e.name, "target": e.target, "place": ""}
            right = {h for h in library if ground_truth.accepts(planted, {"effect": h, "onset_s": 0.0})}
            assert right and {h.partition("[")[0] for h in right} <= set(q.without), e


@pytest.mark.parametrize("size", ["some", "0", "-3"])
def test_size_is_checked(size):
    with pytest.raises(UsageProblem, match="use full, small, or a number"):
        questions(MERLIN, 1, size)


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
