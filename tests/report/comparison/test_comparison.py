"""The reports of a comparison: json, md, html, the terminal's table, and how they are written."""

import json
import math
import re
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from page_case import check_html, read
from report_cases import make_run, make_sim, motion

from rovval import report, vehicle
from rovval.comparison import compare
from rovval.comparison.tolerance import Tolerance
from rovval.core.channels import AXES
from rovval.core.data import Array, Comparison
from rovval.core.errors import Finding, UsageProblem
from rovval.report.common.files import write_all
from rovval.report.comparison import html, markdown, residuals, terminal, tolerances, track, uncertainty, words
from rovval.report.comparison import json as report_json
from rovval.report.drawings import curves
from rovval.report.drawings.drawing import Text

MERLIN = vehicle.load("merlin")


def case(n: int = 600, stop: int | None = None, **more: Any) -> Comparison:
    run = make_run(n, **more)
    return compare(run, make_sim(run, stop=stop), motion(n)[0] * 0.7, "unity")


def leaves(value: Any) -> Iterator[Any]:
    for item in value.values() if isinstance(value, dict) else value if isinstance(value, list) else ():
        yield from leaves(item)
    yield value


def test_json_is_the_contract_of_the_design() -> None:
    c = case(absent=("q",))
    d = json.loads(report_json.text(report_json.document(c)))
    assert (d["schema"], d["run"], d["vehicle"], d["model"]) == ("rovval.comparison/1", "dive-0007", "merlin", "fossen")
    assert list(d["axes"]) == ["surge", "sway", "heave", "roll", "yaw"] and d["not_measured"] == ["pitch"]
    surge = d["axes"]["surge"]
    assert {"unit", "mean_error", "iae", "mae", "rmse", "n", "coverage"} <= set(surge) and surge["unit"] == "m/s"
    assert d["window"]["seconds"] == 10 and {"rms", "iae"} <= set(d["window"]["axes"]["yaw"])
    assert surge["rmse"] == c.free["surge"].rmse and d["window"]["axes"]["surge"]["rms"] == c.windowed["surge"].rmse
    yaw = d["axes"]["yaw"]
    assert yaw["unit_deg"] == "deg/s" and yaw["iae_deg"] == pytest.approx(math.degrees(yaw["iae"])) and yaw["iae_unit"] == "rad"
    assert "iae_deg" not in surge and "fit_percent_deg" not in yaw and surge["iae_unit"] == "m"
    assert d["other"]["name"] == "unity" and d["other"]["axes"]["yaw"]["ours_mae_deg"] == pytest.approx(math.degrees(yaw["mae"]))
    assert d["window"]["horizon"]["surge"]["seconds"] == pytest.approx([1, 2, 5, 9.9])
    assert d["versions"]["rovval"] and d["clock"]["offset_s"] == 0.12 and d["vehicle_hash"] == MERLIN.hash
    assert all(math.isfinite(v) for v in leaves(d) if isinstance(v, float))


def test_all_four_files_are_written_and_nothing_else(tmp_path: Path) -> None:
    files = report.write(case(), tmp_path / "deep" / "out", MERLIN)
    assert set(files) == {"report.json", "report.md", "report.html", "run.rrd"}
    assert {p.name for p in (tmp_path / "deep" / "out").iterdir()} == set(files)
    assert all(p.stat().st_size > 1000 for p in files.values())


def test_a_failure_leaves_the_old_report_alone(tmp_path: Path) -> None:
    (tmp_path / "report.md").write_text("old")

    def fails(path: Path) -> None:
        path.write_text("half")
        raise OSError("disk full")

    with pytest.raises(UsageProblem, match="disk full"):
        write_all(tmp_path, {"report.md": "new", "run.rrd": fails})
    assert [p.name for p in tmp_path.iterdir()] == ["report.md"] and (tmp_path / "report.md").read_text() == "old"


@pytest.mark.parametrize("absent", [(), ("q",), ("q", "theta", "z", "x", "y"), ("u", "v", "w"), ("p", "q", "r", "phi", "theta", "psi", "z")])
def test_every_format_says_what_was_not_measured(absent: tuple[str, ...]) -> None:
    c = case(absent=absent)
    page = html.text(c)
    check_html(page)
    for text in (page, markdown.text(c), terminal.text(c)):
        assert "nan" not in re.sub(r"[A-Za-z0-9+/]{60,}={0,2}|<script>.*?</script>", "", text, flags=re.S).lower().split()
        for axis in c.not_measured:
            assert axis in text
    assert ("Not measured in this log" in page) == bool(c.not_measured)


def test_synthetic_data_is_said_so_in_every_format() -> None:
    c = case(synthetic="made by a test <b>")
    assert "SYNTHETIC DATA: made by a test &lt;b&gt;" in html.text(c)
    assert "SYNTHETIC DATA: made by a test" in markdown.text(c) and "SYNTHETIC DATA: made by a test" in terminal.text(c)
    assert report_json.document(c)["synthetic"] == "made by a test <b>"
    assert "SYNTHETIC" not in html.text(case())


def test_the_page_cannot_be_broken_by_what_a_log_is_called() -> None:
    run = make_run(200)
    c = compare(run, make_sim(run), motion(200)[0], "</script><img src=x>")
    check_html(html.text(c))


def test_the_page_of_ten_minutes_is_below_a_megabyte() -> None:
    page = html.text(case(6001))
    assert len(page) < 1_000_000 and "lowest and highest" not in page


def test_half_an_hour_is_drawn_whole_so_that_a_zoom_shows_every_sample() -> None:
    """It was drawn as two points of every 0.6 s."""
    assert len(curves.thin(np.zeros(18001))) == curves.times(18001, 0.1)["n"] == 18001
    assert curves.times(18001, 0.1)["dt"] == 0.1


def test_thinned_curves_keep_peaks_and_holes() -> None:
    values = np.zeros(100_000)
    values[12345], values[777], values[5000:6000] = 9.0, -4.0, np.nan
    thin = curves.thin(values)
    assert len(thin) == curves.times(100_000, 0.1)["n"] <= curves.MOST_POINTS + 2
    assert np.nanmax(thin) == 9.0 and np.nanmin(thin) == -4.0 and np.isnan(thin).sum() > 250
    assert curves.times(100_000, 0.1)["dt"] * len(thin) == pytest.approx(10_000, rel=1e-3)


def test_packed_curves_come_back() -> None:
    values = np.array([0.5, np.nan, -1.25, 3.0])
    assert decoded(curves.encode(values)) == pytest.approx(values, abs=4.25 / 131068 * 1.01, nan_ok=True)
    assert np.isnan(decoded(curves.encode(np.full(3, np.nan)))).all()
    assert decoded(curves.encode(np.full(3, 2.5))) == pytest.approx([2.5] * 3)


def decoded(e: dict[str, Any]) -> Array:
    import base64

    steps = np.frombuffer(base64.b64decode(e["b"]), "<u2")
    return np.where(steps == curves.MISSING, np.nan, e["lo"] + steps * (e["hi"] - e["lo"]) / 65534)


def test_verdict_names_the_largest_gap_and_says_when_it_is_worse_than_nothing() -> None:
    run = make_run(600)
    good = words.verdict(compare(run, make_sim(run)))
    assert good.startswith("Over windows of 10 s") and "in surge (" in good and "in yaw (" in good
    assert "better than predicting no motion on every measured axis" in good
    bad = words.verdict(compare(run, make_sim(run, gap=(0.06, 0.4, 0.01, 0.002, 0.001, 0.03))))
    assert "in sway (" in bad and "worse than predicting no motion in sway and better in surge, heave" in bad


def test_table_is_aligned_and_carries_degrees() -> None:
    lines = terminal.text(case(absent=("q",))).splitlines()
    tables = [k for k, line in enumerate(lines) if line.startswith("surge  ")]
    assert len(tables) == 3, "the free run, the windows, and the other simulator"
    for surge in tables[:2]:
        assert re.search(r"[+-]\d\.\d\d +100 %$", lines[surge]) and len({len(line) for line in lines[surge - 1 : surge + 3]}) == 1
    assert any(line.strip().startswith("deg/s") for line in lines) and "not measured: pitch" in lines
    assert max(map(len, lines)) <= 80


def test_stops_are_reported() -> None:
    c = case(stop=300)
    for text in (html.text(c), markdown.text(c), terminal.text(c)):
        assert "pitch beyond 80 deg" in text


def test_nothing_heavy_is_imported_with_the_package() -> None:
    modules = "rovval.report, rovval.report.comparison.terminal, rovval.report.comparison.html"
    code = f"import sys, {modules}; print([m for m in ('rerun','polars','scipy') if m in sys.modules])"
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert out.strip() == "[]"


def test_a_log_without_velocities_has_no_empty_table_and_no_empty_plots() -> None:
    c = case(absent=("u", "v", "w", "p", "q", "r"))
    said = terminal.text(c)
    assert "free run" not in said
    assert "depth (" in said and "roll angle" in said and "phi" not in said
    assert ">Velocities<" not in html.text(c) and ">Velocities<" in html.text(case())
    for said in (html.text(c), markdown.text(c)):
        assert said.count(words.NO_VELOCITY) == 1 and ">not measured<" not in said and "| not measured" not in said
    assert words.NO_VELOCITY not in html.text(case(absent=("q",)))


def test_findings_are_counted_in_the_head_with_the_way_to_them() -> None:
    c = case()
    found = (Finding("repeated_row", "t", "twice"), Finding("gap", "u", "1 s"), Finding("gap", "v", "2 s"))
    page = html.text(replace(c, run=replace(c.run, findings=found)))
    check_html(page)
    assert '<a href="#findings">3 findings in this log</a>: repeated row, gap (2).' in read(page).partition("<section")[0]
    assert '<section id="findings">' in page
    assert 'href="#findings"' not in html.text(replace(c, run=replace(c.run, findings=())))


def windowed(n: int, window_s: float, **more: Any) -> Comparison:
    """Simulated in windows of what length there is."""
    run = make_run(n, **more)
    sim = make_sim(run)
    stretch = np.arange(n) // round(window_s / run.dt)
    return compare(run, replace(sim, window_s=window_s, windowed=replace(sim.windowed, stretch=stretch)))


def test_a_log_shorter_than_its_window_says_what_was_done() -> None:
    """It said "Over windows of 10 s" of a log of five."""
    c = windowed(50, 10.0)
    for said in (terminal.text(c), markdown.text(c), read(html.text(c))):
        flat = " ".join(said.split())
        assert "ver one window of 4.9 s" in flat and "shorter than a window of 10 s" in flat and "indows of 10 s," not in flat
    assert report_json.document(c)["window"]["longest_s"] == pytest.approx(4.9)
    assert "windows of 10 s" in words.verdict(windowed(250, 10.0)) and "asked" not in words.verdict(windowed(250, 10.0))


def test_broken_stretches_shorter_than_a_window_are_said() -> None:
    c = windowed(600, 10.0)
    stretch = np.arange(600) // 40
    c = replace(c, sim=replace(c.sim, windowed=replace(c.sim.windowed, stretch=stretch)))
    assert "windows of at most 3.9 s" in words.verdict(c) and "No unbroken stretch" in words.verdict(c)


def test_a_log_of_less_than_a_minute_says_so_first() -> None:
    """Three seconds were compared without a word."""
    assert words.verdict(windowed(30, 10.0)).startswith("Only 2.9 s of log: under a minute")
    assert words.verdict(windowed(600, 10.0)).startswith("Over windows of 10 s")


@pytest.mark.parametrize(("wobble", "alarm"), [(0.004, False), (0.02, True)])
def test_what_lies_within_the_noise_of_a_sensor_is_no_alarm(wobble: float, alarm: bool) -> None:
    """A headline once said "worse than predicting no motion in pitch" of errors of 0.03 deg/s."""
    run = make_run(600)
    still = replace(run, values={**run.values, "q": np.random.default_rng(3).normal(0.0, 0.006, 600)})
    sim = make_sim(still)
    nu = sim.windowed.nu.copy()
    nu[:, 4] = wobble * np.sin(np.arange(600) / 9.0)
    c = compare(still, replace(sim, windowed=replace(sim.windowed, nu=nu), free=replace(sim.free, nu=nu)))
    said, pitch = words.verdict(c), c.windowed["pitch"]
    assert pitch.noise == pytest.approx(0.006, rel=0.1) and (pitch.skill or 0.0) < 0.0
    assert ("worse than predicting no motion in pitch" in said) is alarm
    assert ("in pitch motion and error are hardly more than the sensor's noise" in said) is not alarm
    assert ('class="neg"' in html.text(c)) is alarm


def test_of_a_simulation_alone_it_is_said_that_nothing_was_measured() -> None:
    run = make_run(300)
    assert "Nothing was measured" in words.verdict(Comparison(run, make_sim(run), {}, {}, {}, AXES))


def test_the_page_says_how_sure_the_errors_are_and_what_is_seen_of_them() -> None:
    c = case(1200)
    page, document = html.text(c), report_json.document(c)
    assert "How sure these errors are" in page and "ASME V&amp;V 20" in page
    row = document["window"]["axes"]["surge"]
    low, high = row["intervals"]["rmse"].values()
    assert low < row["rmse"] < high and set(row["intervals"]) == {"mean_error", "mae", "iae", "rmse", "skill"}
    found = document["validation"]["axes"]["surge"]
    assert found["verdict"] == "seen" and found["low"] == pytest.approx(found["error"] - 2 * found["u_validation"])
    assert len(document["validation"]["left_out"]) == 2
    few = case(300)
    assert not few.windowed["surge"].intervals and [form for _, _, form, _ in uncertainty.interval_rows(few)] == ["free run"] * 6


def test_tolerances_are_judged_on_the_page_and_drawn_as_a_tube() -> None:
    c = case()
    rmse, vaf = c.windowed["surge"].rmse, c.free["surge"].extra["vaf"]
    limits = [Tolerance(True, "surge", "rms", 2 * rmse), Tolerance(False, "surge", "vaf", vaf - 1), Tolerance(False, "yaw", "mae", 1e-6)]
    judged = tolerances.rows(c, limits)
    assert [j.kept for j in judged] == [True, True, False] and judged[0].inside != judged[2].inside and judged[1].inside == "-"
    page = html.text(c, limits=limits)
    check_html(page)
    assert "Tolerance exceeded: yaw.mae." in read(page) and page.count(">kept<") == 2 and page.count(">exceeded<") == 1
    [data] = re.findall(r'id="data">(.*?)</script>', page, re.DOTALL)
    plots = {p["id"]: p for p in json.loads(data.replace("<\\/", "</"))["plots"]}
    assert plots["v-surge"]["tube"] == pytest.approx(2 * rmse) and plots["v-yaw"]["tube"] == pytest.approx(math.degrees(1e-6))
    assert "tube" not in plots["v-sway"] and 'class="tube"' in page
    assert ">Tolerances<" not in html.text(c)


def test_a_tolerance_of_what_was_not_measured_is_not_kept() -> None:
    [judged] = tolerances.rows(case(absent=("q",)), [Tolerance(False, "pitch", "rmse", 1.0)])
    assert not judged.kept and judged.value == "-"


def test_the_track_is_drawn_from_above_where_positions_were_measured() -> None:
    c = case()
    plan = track.plan(c)
    assert plan is not None and "Track from above" in html.text(c)
    ends = {s.words: (s.x, s.y) for s in plan.shapes if isinstance(s, Text)}
    north, east = (c.run.get(n)[-1] - c.run.get(n)[0] for n in ("x", "y"))
    assert np.sign(ends["end"][0] - ends["start"][0]) == np.sign(east) and np.sign(ends["end"][1] - ends["start"][1]) == -np.sign(north)
    [picture], _ = track.error(c)
    free = decoded(picture["series"][0]["d"])
    assert free[0] < 0.1 and free[-1] == pytest.approx(0.02 * 60 * math.sqrt(2), rel=0.05), "it goes off by 0.02 m/s north and east"
    bare = case(absent=("x", "y"))
    assert track.plan(bare) is None and "Track from above" not in html.text(bare)


def test_the_error_s_autocorrelation_and_spectrum_are_on_the_page() -> None:
    axes, pictures, places = residuals.drawn(case(1200, absent=("q",)))
    assert {p.identity for p in places} == {p["id"] for p in pictures} == {f"{kind}-{a}" for kind in "rf" for a in AXES if a != "pitch"}
    assert (axes["lag"]["unit"], axes["frequency"]["unit"], axes["frequency"]["log"]) == ("s", "Hz", True)
    assert all(p.note.endswith("of the lags outside the band") for p in places if p.identity.startswith("r-"))
