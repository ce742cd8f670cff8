"""The pipeline's file: all its mistakes are named at once, before the first log is read."""

import batch_case
import pytest
from batch_case import counts

from rovval.core.errors import UsageProblem
from rovval.pipeline import batch
from rovval.pipeline.planning import config


def test_every_problem_of_a_pipeline_file_is_named_at_once(tmp_path):
    path = tmp_path / "p.toml"
    path.write_text('steps = ["fly"]\nwindow_s = "x"\ntolerances = ["bow=1"]\nspeed = 3\n[[source]]\nlogs = []\n')
    with pytest.raises(UsageProblem) as refused:
        config.load(path)
    for word in ("name", "steps.0", "window_s", "tolerances", "speed", "source.0.logs"):
        assert word in refused.value.message
    assert "problems" in refused.value.message


def test_vehicles_and_profiles_are_looked_up_before_the_first_log(tmp_path):
    path = tmp_path / "p.toml"
    path.write_text('name = "p"\n[[source]]\nlogs = ["*.csv"]\nprofile = "nope"\nvehicle = "nada"\n')
    with pytest.raises(UsageProblem) as refused:
        config.load(path)
    assert "nope" in refused.value.message
    assert "nada" in refused.value.message


def test_a_pattern_in_a_folder_that_is_not_there_is_a_mistake(tmp_path):
    path = batch_case.write_pipeline(tmp_path)
    with pytest.raises(UsageProblem, match=r"logs/\*.csv"):
        batch.run(path)
    (tmp_path / "logs").mkdir()
    assert counts(batch.run(path)) == {"missing_sources": 1}
