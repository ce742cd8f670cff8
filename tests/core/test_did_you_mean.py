"""Names that somebody meant."""

from __future__ import annotations

from pathlib import Path

import pytest

from rovval import effects, vehicle
from rovval.comparison import metrics
from rovval.core.did_you_mean import near, suggestion
from rovval.core.errors import RovvalError
from rovval.fly import mission
from rovval.ingest.profile import load_profile
from rovval.plant import platforms
from rovval.storage.archive import open_run


def test_the_nearest_comes_first_whatever_its_case():
    assert near("Merlinn", ["minerva", "merlin", "bluerov2"])[0] == "merlin"
    assert near("HFP", ["hfp", "VAC"]) == ["hfp"]
    assert near("xyz", ["merlin"]) == []


def test_without_a_near_one_all_are_named():
    assert suggestion("xyz", ["a", "b"], "`list`") == "use one of: a, b"
    assert suggestion("merln", ["merlin", "b"], "`list`") == "did you mean merlin? `list` has all"


@pytest.mark.parametrize(
    ("ask", "name", "meant"),
    [
        (effects.load, "inflow_los", "inflow_loss"),
        (vehicle.load, "merlinn", "merlin"),
        (load_profile, "ros_odom", "ros_odometry"),
        (platforms.load, "fosen", "fossen"),
        (metrics.get, "rsme", "rmse"),
        (mission.load, "survy", "survey"),
    ],
)
def test_every_kind_of_name_that_is_not_there_is_answered_by_the_nearest(ask, name, meant):
    with pytest.raises(RovvalError) as refused:
        ask(name)
    assert f"did you mean {meant}" in refused.value.hint


def test_a_log_or_run_that_is_not_there(tmp_path: Path):
    (tmp_path / "dive.csv").touch()
    archive = tmp_path / "archive"
    (archive / "dive_42-abc").mkdir(parents=True)
    (archive / "dive_42-abc" / "manifest.json").touch()
    for asked, meant in ((tmp_path / "dvie.csv", str(tmp_path / "dive.csv")), (Path("dive_42-ab"), "dive_42-abc")):
        with pytest.raises(RovvalError) as refused:
            open_run(asked, archive=archive)
        assert f"did you mean {meant}?" in refused.value.hint
