"""Each command on a short log, by what a script sees: exit code, stdout, stderr, files."""

import json
import re
import shutil
import sys
from pathlib import Path
from types import ModuleType, SimpleNamespace

import pytest
from command_case import SECONDS, run, write_dive

from rovval import demo, ingest
from rovval.core.errors import BadInput, UsageProblem
from rovval.storage.archive import run_ids
from rovval.vehicle import load


@pytest.fixture
def here(tmp_path, monkeypatch):
    """An empty working directory with the short dive in it."""
    monkeypatch.chdir(tmp_path)
    write_dive(tmp_path)
    return tmp_path


def test_ingest_then_use_the_id(here):
    done = run("ingest", "dive.csv")
    name = done.stdout.strip()
    assert run_ids(Path("archive")) == (name,)
    assert run("list", "run").stdout.split() == [name]
    assert name in run("show", "run", name).stdout
    shown = json.loads(run("show", "run", name, "--json").stdout)
    assert shown["seconds"] == pytest.approx(SECONDS - 0.1)
    by_id = json.loads(run("compare", name, "--json").stdout)
    by_file = json.loads(run("compare", "dive.csv", "--json").stdout)
    assert by_id["axes"] == by_file["axes"]
    assert not Path("reports").exists(), "--json without --out writes nothing"


def test_a_stretch_is_kept_as_a_run_of_its_own(here):
    name = run("ingest", "dive.csv", "--from", "3", "--to", "9").stdout.strip()
    assert name.endswith("-from3to9s") and run_ids(Path("archive")) == (name,)
    assert json.loads(run("show", "run", name, "--json").stdout)["seconds"] == pytest.approx(6.0)
    shown = json.loads(run("show", "run", "dive.csv", "--from", "3", "--to", "5", "--json").stdout)
    assert shown["seconds"] == pytest.approx(2.0) and any("from 3 to 5 s" in finding for finding in shown["findings"])
    with pytest.raises(UsageProblem, match="cut a run"):
        run("show", "vehicle", "merlin", "--from", "3")
    assert "beyond the log" in run("ingest", "dive.csv", "--from", "3000", code=3).stderr


def test_ingest_of_a_folder_names_the_logs_that_it_cannot_read(here):
    """Damaged HDF5, Matlab and PX4 logs beside a CSV: none is passed over at exit 0 without a word."""
    Path("logs").mkdir()
    Path("dive.csv").rename("logs/dive.csv")
    for name in ("a.h5", "b.MAT", "c.ulg"):
        Path("logs", name).write_bytes(b"\x89HDF\r\n\x1a\n\0\0")
    Path("logs/notes.md").write_text("not a log")
    done = run("ingest", "logs", code=3)
    assert done.stdout.startswith("dive-") and len(done.stdout.split()) == 1
    assert all(f"rovval: logs/{name}: " in done.stderr for name in ("a.h5", "b.MAT", "c.ulg")) and "notes.md" not in done.stderr


def test_ingest_of_a_folder_goes_on_after_a_bad_log(here):
    Path("logs/deep").mkdir(parents=True)
    shutil.move("dive.csv", "logs/deep/dive.csv")
    Path("logs/bad.csv").write_text("no log\n")
    Path("logs/notes.md").write_text("not looked at\n")
    done = run("ingest", "logs", "--profile", "merlin", "--json", code=3)
    rows = json.loads(done.stdout)["logs"]
    assert [(Path(r["log"]).name, r["run"] is None) for r in rows] == [("bad.csv", True), ("dive.csv", False)]
    assert "bad.csv" in done.stderr
    assert len(run_ids(Path("archive"))) == 1


def test_compare_prints_the_table_and_writes_the_report(here):
    done = run("compare", "dive.csv", "--out", "out")
    for word in ("surge", "m/s", "RMSE", "no motion", "report.html"):
        assert word in done.stdout
    assert {p.name for p in Path("out").iterdir()} == {"report.json", "report.md", "report.html", "run.rrd"}
    document = json.loads(Path("out/report.json").read_text())
    assert document["schema"] == "rovval.comparison/1"
    for axis in ("surge", "sway", "heave", "roll", "pitch", "yaw"):
        assert {"unit", "mean_error", "iae", "mae", "rmse", "n", "coverage"} <= set(document["axes"][axis])
        assert {"rms", "iae"} <= set(document["window"]["axes"][axis])
    assert document["window"]["seconds"] == 10


def test_out_leaves_what_else_stands_in_the_folder(here):
    Path("out").mkdir()
    Path("out/mine.txt").write_text("x")
    run("compare", "dive.csv", "--out", "out")
    assert Path("out/mine.txt").read_text() == "x"


def test_fail_above(here):
    kept = run("compare", "dive.csv", "--json", "--fail-above", "surge=10")
    done = run("compare", "dive.csv", "--json", "--fail-above", "surge=1e-6", "--fail-above", "sway=10", code=1)
    assert done.stdout == kept.stdout, "the result is printed whole before the tolerance speaks"
    assert "surge.rmse" in done.stderr
    assert "sway" not in done.stderr


def test_an_effect_moves_the_simulation_towards_the_log_that_has_it(here):
    nominal = json.loads(run("compare", "dive.csv", "--json").stdout)
    mended = json.loads(run("compare", "dive.csv", "--json", "--effect", demo.EFFECT).stdout)
    assert mended["window"]["axes"]["surge"]["rms"] < 0.5 * nominal["window"]["axes"]["surge"]["rms"]


def test_simulate_writes_what_it_says_and_compare_takes_it(here):
    summary = json.loads(
        run("simulate", "dive.csv", "--out", "deep/sim.parquet", "--effect", demo.EFFECT, "--json", "-q").stdout
    )
    assert summary["file"] == "deep/sim.parquet"
    assert summary["simulated"] == SECONDS * 10
    beside = json.loads(run("compare", "dive.csv", "--with", "deep/sim.parquet", "--json").stdout)
    assert beside["other"]["axes"]["surge"]["rmse"] < beside["axes"]["surge"]["rmse"]


def test_another_simulators_velocities_are_laid_on_our_grid_by_their_clock(here):
    """A file that begins 5 s later is compared on the rows that the two have in common, not from its own start."""
    lines = Path("dive.csv").read_text().splitlines(keepends=True)
    Path("other.csv").write_text("".join([lines[0], *lines[51:]]))
    beside = json.loads(run("compare", "dive.csv", "--with", "other.csv", "--with-profile", "merlin", "--json").stdout)
    assert beside["other"]["axes"]["surge"]["n"] == SECONDS * 10 - 50
    assert beside["other"]["axes"]["surge"]["rmse"] == pytest.approx(0.0, abs=1e-9)


def test_simulations_whose_clocks_cannot_be_related_are_refused(here):
    lines = [line.split(",", 4)[4] for line in Path("dive.csv").read_text().splitlines()]
    rows = ["t," + lines[0], *(f"{i / 10},{line}" for i, line in enumerate(lines[1:]))]
    profile = (ingest.profile.FOLDER / "merlin.toml").read_text().replace('"time_of_day"', '"elapsed"')
    Path("p.toml").write_text(
        re.sub(r'columns = \["Hour.*', 'columns = ["t"]', profile).replace('name = "merlin"', 'name = "p"')
    )
    Path("same.csv").write_text("\n".join(rows))
    Path("short.csv").write_text("\n".join(rows[:101]))
    same = json.loads(run("compare", "dive.csv", "--with", "same.csv", "--with-profile", "p.toml", "--json").stdout)
    assert same["other"]["axes"]["surge"]["rmse"] == pytest.approx(0.0, abs=1e-9)
    with pytest.raises(BadInput, match="no clock that both know"):
        run("compare", "dive.csv", "--with", "short.csv", "--with-profile", "p.toml", "--json")


def test_a_platform_without_added_mass_moves_otherwise(here):
    one, two = (json.loads(run("compare", "dive.csv", "--json", "--model", m).stdout) for m in ("fossen", "freefloating"))
    assert (one["model"], two["model"]) == ("fossen", "freefloating")
    assert abs(one["axes"]["surge"]["rmse"] - two["axes"]["surge"]["rmse"]) > 1e-3


def test_view_without_opening_writes_the_recording(here):
    done = run("view", "dive.csv", "--no-open", "--out", "v")
    assert Path(done.stdout.strip()) == Path("v/run.rrd")
    assert Path("v/run.rrd").stat().st_size > 10_000


def test_diagnose_writes_what_it_found_and_a_vehicle_that_has_it(here):
    """Diagnosed beside the vehicle that it wrote, nothing is left to add."""
    done = run("diagnose", "dive.csv", "--json", "d.json", "--write-vehicle", "mended.toml")
    document = json.loads(Path("d.json").read_text())
    assert document["schema"] == "rovval.diagnosis/1" and not Path("reports").exists()
    assert document["verdict"] == "explained" and done.stdout.startswith(f"{document['run']}: explained\n")
    assert [cause["effect"] for cause in document["causes"]] == ["inflow_loss"]
    assert load("mended.toml").effects["inflow_loss"]["loss"] == pytest.approx(document["causes"][0]["parameters"]["loss"]["value"])
    again = run("diagnose", "dive.csv", "--vehicle", "mended.toml", "--json", "again.json", "--write-vehicle", "more.toml")
    assert json.loads(Path("again.json").read_text())["verdict"] == "no_gap"
    assert "more.toml not written" in again.stderr and not Path("more.toml").exists()


@pytest.mark.parametrize(
    ("args", "kind", "words"),
    [
        (["compare", "nowhere.csv"], BadInput, "nowhere.csv"),
        (["compare", "dive.csv", "--profile", "nope"], UsageProblem, "merlin"),
        (["compare", "dive.csv", "--vehicle", "nope"], UsageProblem, "bluerov2_heavy"),
        (["compare", "dive.csv", "--effect", "nope:x=1"], UsageProblem, "nope"),
        (["compare", "dive.csv", "--with", "nowhere.parquet"], UsageProblem, "nowhere.parquet"),
        (["compare", "dive.csv", "--with", "empty.parquet"], BadInput, "empty.parquet"),
        (["compare", "empty.csv", "--profile", "merlin"], BadInput, "empty.csv"),
        (["compare", "narrow.csv", "--profile", "merlin"], BadInput, "LinVelX"),
        (["ingest", "nowhere"], BadInput, "nowhere"),
        (["show", "run", "nope"], BadInput, "nope"),
    ],
    ids=lambda a: " ".join(a) if isinstance(a, list) else "",
)
def test_bad_input_is_one_message_and_nothing_half_written(here, args, kind, words):
    Path("empty.csv").touch()
    Path("empty.parquet").touch()
    lines = [line.split(",") for line in Path("dive.csv").read_text().splitlines()]
    gone = lines[0].index("LinVelX")
    Path("narrow.csv").write_text("\n".join(",".join(c for i, c in enumerate(cells) if i != gone) for cells in lines))
    before = sorted(Path().rglob("*"))
    with pytest.raises(kind) as refused:
        run(*args)
    assert words in str(refused.value)
    assert sorted(Path().rglob("*")) == before


def test_fit_passes_on_what_was_asked_for(here, monkeypatch):
    """The command alone, with the fit itself replaced."""
    asked: dict[str, object] = {}

    def fit(runs, vehicle, parameters, **options):
        asked.update(runs=len(runs), vehicle=vehicle.name, parameters=list(parameters), **options)
        return SimpleNamespace(vehicle="name = 'tuned'\n", document={"schema": "rovval.fit/1"}, text="tuned")

    module = ModuleType("rovval.fit")
    monkeypatch.setattr(module, "fit", fit, raising=False)
    monkeypatch.setitem(sys.modules, "rovval.fit", module)
    done = run("fit", "dive.csv", "--parameters", "quadratic_drag[surge],linear_drag[yaw]", "--out", "tuned.toml", "--json")
    assert json.loads(done.stdout) == {"schema": "rovval.fit/1"}
    assert asked == {
        "runs": 1,
        "vehicle": "merlin",
        "parameters": ["quadratic_drag[surge]", "linear_drag[yaw]"],
        "model": "fossen",
        "window_s": 10.0,
    }
    assert Path("tuned.toml").read_text() == "name = 'tuned'\n"


def test_a_page_that_cannot_be_written_is_refused_before_the_fit(here):
    Path("taken").touch()
    with pytest.raises(UsageProblem, match="taken"):
        run("fit", "dive.csv", "--out", "v.toml", "--report", "taken")
    Path("bench.csv").write_text("1,2\n2,4\n")
    with pytest.raises(UsageProblem, match="has no page"):
        run("fit", "bench.csv", "--motor", "--report", "page")
    assert not Path("v.toml").exists()


def test_blind_make(here):
    Path("cases.json").write_text(
        '[{"mission": "rich", "effects": [{"name": "buoyancy_error", "severity": 1.0}], "duration_s": 30, "seed": 7}]'
    )
    done = run("blind", "make", "cases", "--cases", "cases.json", "--seed", "1", "--workers", "1")
    assert done.stdout.startswith("1 log in cases/logs; labels sealed, SHA-256 ")
    [log] = Path("cases/logs").iterdir()
    assert Path("cases.key").is_file()
    assert b"buoyancy_error" not in Path("cases/labels.sealed").read_bytes()
    run("compare", str(log), "--json", "--vehicle", "merlin")


def test_compare_between_two_platforms_and_two_files(tmp_path, monkeypatch):
    """Without a log both fly the movement protocol; a file beside itself is a tie; two files need no log."""
    monkeypatch.chdir(tmp_path)
    write_dive(tmp_path)
    done = json.loads(run("compare", "--between", "fossen", "freefloating", "--json").stdout)
    assert (done["schema"], done["a"], done["b"], done["tie"]) == ("rovval.between/1", "fossen", "freefloating", False)
    assert done["axes"]["surge"]["per_cent"] > 10 and done["axes"]["surge"]["mean"] != 0
    on_log = run("compare", "dive.csv", "--between", "fossen", "fossen", "--out", "between").stdout
    assert "A tie" in on_log and {p.name for p in (tmp_path / "between").iterdir()} == {"difference.json", "difference.md", "difference.html"}
    run("simulate", "dive.csv", "--out", "a.parquet")
    assert json.loads(run("compare", "--between", "a.parquet", "a.parquet", "--json").stdout)["tie"]
    with pytest.raises(UsageProblem, match="need no log"):
        run("compare", "dive.csv", "--between", "a.parquet", "a.parquet")
    with pytest.raises(UsageProblem, match="needs a log"):
        run("compare")


@pytest.mark.slow
def test_report_sets_models_side_by_side(here):
    done = run("report", "dive.csv", "--model", "fossen", "--model", "uuv", "--model", "fossen")
    assert {p.name for p in Path("reports/side_by_side").iterdir()} == {"side_by_side.json", "side_by_side.html"}
    assert "fossen" in done.stdout and "uuv" in done.stdout
    told = json.loads(run("report", "dive.csv", "--model", "fossen", "--model", "uuv", "--json").stdout)
    assert list(told["comparisons"]) == ["fossen", "uuv"]
    with pytest.raises(UsageProblem, match="nothing stands beside it"):
        run("report", "dive.csv")
