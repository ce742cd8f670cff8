"""The plan: what makes a result new is what it depends on, and why it is new is said."""

import batch_case
from batch_case import counts, tasks_of

from rovval import vehicle
from rovval.ingest import profile
from rovval.pipeline import batch
from rovval.pipeline.hashes import code_on_disk
from rovval.pipeline.plan import why
from rovval.pipeline.worker import work


def test_keys_depend_on_what_a_step_depends_on(site):
    """A new window makes simulations new and leaves what was read alone."""
    before = tasks_of(batch_case.write_pipeline(site, steps='["ingest", "simulate"]'))
    after = tasks_of(batch_case.write_pipeline(site, "window_s = 5.0", steps='["ingest", "simulate"]'))
    for old, new in zip(before, after, strict=True):
        (a, b), (c, d) = dict(old.keys).values(), dict(new.keys).values()
        assert a == c
        assert b != d


def test_the_vehicle_that_a_profile_names_lies_beside_it_and_counts(site, tmp_path, monkeypatch):
    """It was looked for in the working directory, where cron is somewhere else; and edited it left its logs unchanged."""
    text = (profile.FOLDER / "merlin.toml").read_text()
    (tmp_path / "mine.toml").write_text(text.replace('vehicle = "merlin"', 'vehicle = "my_vehicle.toml"'))
    mine = tmp_path / "my_vehicle.toml"
    mine.write_text((vehicle.LIBRARY / "merlin.toml").read_text())
    path = batch_case.write_pipeline(tmp_path, steps='["ingest", "simulate"]')
    path.write_text(path.read_text().replace('profile = "merlin"\nvehicle = "merlin"', 'profile = "mine.toml"'))
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    before = tasks_of(path)
    assert before and profile.load_profile(tmp_path / "mine.toml").vehicle_file == str(mine)
    mine.write_text(mine.read_text().replace("mass = 2936.0", "mass = 2930.0"))
    after = tasks_of(path)
    assert [dict(t.keys)["simulate"] for t in before] != [dict(t.keys)["simulate"] for t in after]
    assert [dict(t.keys)["ingest"] for t in before] == [dict(t.keys)["ingest"] for t in after]


def test_results_of_other_code_are_made_anew_and_it_is_said(site, monkeypatch):
    """The version's number stays the same while the code changes."""
    path = batch_case.write_pipeline(site)
    assert batch.run(path, workers=1)["why"] == {"new": 3}
    monkeypatch.setattr("rovval.pipeline.plan.code_on_disk", lambda: "0123456789ab")
    monkeypatch.setattr("rovval.pipeline.worker.code_of_this_process", lambda: "0123456789ab")
    reasons = {why(task) for task in batch.dry_run(path).todo}
    assert reasons == {f"made by other code of rovval ({code_on_disk()}; now 0123456789ab)"}
    assert {work(task)["status"] for task in tasks_of(path)} == {"done"}
    assert counts(batch.run(path, workers=1)) == {"unchanged": 3}
