"""Every kind of page in a real browser: no error on its console, readable colours, all of it by keys, on a phone, and each picture as a file."""

from __future__ import annotations

import csv
import re
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from browser_case import found, in_browser
from catalogue_case import row
from report_cases import diagnosis, make_run, make_sim

from rovval.comparison import compare
from rovval.pipeline.keeping import summary
from rovval.pipeline.tolerances import parse
from rovval.report import side_by_side
from rovval.report.batch import html as batch_page
from rovval.report.comparison import html as comparison_page
from rovval.report.diagnosis import html as diagnosis_page
from rovval.trend import trends

pytestmark = [pytest.mark.slow, in_browser]
LEAST_CONTRAST = 4.5  # WCAG 2.2, 1.4.3, level AA


@cache
def comparison() -> str:
    run = make_run(1200)
    return comparison_page.text(compare(run, make_sim(run)), limits=parse(["surge=0.1", "window.yaw.rms=0.001"]))


@cache
def diagnosed() -> str:
    run = make_run(1200)
    return diagnosis_page.text(diagnosis(), compare(run, make_sim(run)), make_sim(run, gap=(0.01,) * 6))


@cache
def beside() -> str:
    run = make_run(400)
    return side_by_side.html([compare(run, make_sim(run)), compare(make_run(500), make_sim(make_run(500)))])


@cache
def batch() -> str:
    axes = {"surge": {"rms": 0.1, "unit": "m/s"}}
    done = {"compare": {"comparison": {"vehicle": "merlin", "stops": [], "window": {"seconds": 10, "axes": axes}, "axes": {}}, "outputs": []}}
    records = [{"log": f"/logs/d{n}.csv", "run": f"d{n}-ab", "duration_s": 90.0, "findings": 0, "steps": done} for n in range(70)]
    dives = [row(n, vehicle="merlin", current=True, causes=[], surge=0.05 + 0.02 * (n > 30)) for n in range(60)]
    document = summary.summarise("nightly", records[:3], records[3:], (), (), ["window.surge=0.05"], 3.0, {})
    return batch_page.text(document, records, trends(dives))


PAGES: dict[str, Callable[[], str]] = {"comparison": comparison, "diagnosis": diagnosed, "side_by_side": beside, "batch": batch}
every_page = pytest.mark.parametrize("page", PAGES)

CONTRAST = """
const split = (s) => { const v = s.match(/[\\d.]+/g).map(Number); return [v[0], v[1], v[2], v.length > 3 ? v[3] : 1]; };
const over = (top, under) => { const a = top[3]; return [0, 1, 2].map((k) => a * top[k] + (1 - a) * under[k]).concat(1); };
const linear = (v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
const light = (c) => { const [r, g, b] = c.map((v) => linear(v / 255)); return 0.2126 * r + 0.7152 * g + 0.0722 * b; };
const up = (e) => { const all = []; for (; e; e = e.parentElement) all.push(e); return all.reverse(); };
const weak = {};
const texts = document.createTreeWalker(document.body, 4);
while (texts.nextNode()) {
  const e = texts.currentNode.parentElement;
  if (!texts.currentNode.data.trim() || !e.getClientRects().length || e.closest("script, noscript, option")) continue;
  let ground = [255, 255, 255, 1], seen = 1;
  for (const one of up(e)) {
    const style = window.getComputedStyle(one);
    ground = over(split(style.backgroundColor), ground);
    seen *= Number(style.opacity);
  }
  if (seen === 0) continue;
  const style = window.getComputedStyle(e), ink = split(e.closest("svg") ? style.fill : style.color);
  const shown = over([...ink.slice(0, 3), ink[3] * seen], ground);
  const [a, b] = [light(shown), light(ground)].sort((x, y) => y - x), ratio = (a + 0.05) / (b + 0.05);
  if (ratio < LEAST) weak[`${e.tagName} ${e.className} in ${e.parentElement.tagName}`] = [texts.currentNode.data.trim().slice(0, 30), ratio];
}
return weak;
""".replace("LEAST", str(LEAST_CONTRAST))

KEYS = """
const shown = (e) => e.checkVisibility({ contentVisibilityAuto: true });
const operated = [...document.querySelectorAll("a[href], button, summary, input, select, [aria-sort], .u-over")].filter(shown);
const unreached = operated.filter((e) => (e.closest("[tabindex]") || e).tabIndex < 0 && !e.closest(".error")).map((e) => e.outerHTML.slice(0, 80));
const unseen = [];
for (const e of [...operated, ...document.querySelectorAll("[tabindex]")].filter((e) => e.tabIndex >= 0 && shown(e))) {
  e.focus({ focusVisible: true });
  const style = window.getComputedStyle(e);
  if (document.activeElement !== e || style.outlineStyle === "none" || parseFloat(style.outlineWidth) < 2) unseen.push(e.outerHTML.slice(0, 80));
}
return { unreached, unseen, operated: operated.length };
"""

WIDE = """
const right = document.documentElement.clientWidth, out = (e) => e.getBoundingClientRect().right > right + 1 && !e.parentElement.closest(".scroll, svg");
const beyond = [...document.body.querySelectorAll("*")].filter(out);
return { width: document.documentElement.scrollWidth, beyond: beyond.map((e) => e.outerHTML.slice(0, 80)).slice(0, 5) };
"""

SAVED = """
const saved = [];
window.HTMLAnchorElement.prototype.click = function () { saved.push([this.download, this.href]); };
const boxes = [...document.querySelectorAll(".plot, figure.drawn")];
for (const box of boxes) for (const button of box.querySelectorAll(".save button")) button.click();
for (let k = 0; k < 40 && saved.length < 2 * boxes.length; k++) await pause(100);
const content = async (name, url) => (name.endsWith("csv") ? (await window.fetch(url)).text() : url.slice(0, 22) + url.length);
return { boxes: boxes.length, files: await Promise.all(saved.map(async ([name, url]) => [name, await content(name, url)])) };
"""


def looked(page: str, script: str, folder: Path, **how: Any) -> Any:
    return found(PAGES[page](), script, folder, **how)


@every_page
@pytest.mark.parametrize("dark", [False, True], ids=["light", "dark"])
def test_every_word_stands_out_from_its_ground(page: str, dark: bool, tmp_path: Path) -> None:
    assert looked(page, CONTRAST, tmp_path, dark=dark) == {}


@every_page
def test_all_that_can_be_operated_is_reached_by_keys_and_shows_that_it_is(page: str, tmp_path: Path) -> None:
    seen = looked(page, KEYS, tmp_path)
    assert seen["unreached"] == [] and seen["unseen"] == [] and seen["operated"] > 0


@every_page
def test_a_phone_of_360_pixels_scrolls_one_way_only(page: str, tmp_path: Path) -> None:
    seen = looked(page, WIDE, tmp_path, width=360)
    assert seen["width"] <= 360, seen["beyond"]


@every_page
def test_each_picture_is_saved_as_a_drawing_and_as_its_values(page: str, tmp_path: Path) -> None:
    seen = looked(page, SAVED, tmp_path)
    files = dict(seen["files"])
    assert seen["boxes"] > 0 and len(seen["files"]) == 2 * seen["boxes"]
    for name, text in files.items():
        if name.endswith(".png"):
            assert text.startswith("data:image/png;base64,") and int(text[22:]) > 1000, name
        else:
            lines = list(csv.reader(text.splitlines()))
            assert len(lines) > 3 and {len(line) for line in lines} == {len(lines[0])} and all(lines[0]), name


def test_a_drawing_s_values_are_those_that_it_shows(tmp_path: Path) -> None:
    run = make_run(1200)
    files = dict(looked("comparison", SAVED, tmp_path)["files"])
    [track] = (list(csv.DictReader(text.splitlines())) for name, text in files.items() if "Tracks" in name and name.endswith("csv"))
    assert len(track) == len(run) / 2 and float(track[7]["time_s"]) == pytest.approx(1.4)
    assert [float(r["measured, north, m"]) for r in track[::100]] == pytest.approx(run.get("x")[::200].tolist(), abs=1e-3)


def test_a_curve_is_read_and_zoomed_by_keys(tmp_path: Path) -> None:
    script = """
    const host = document.getElementById("v-surge"), read = () => host.parentNode.querySelector(".read").textContent;
    const press = (key) => host.dispatchEvent(new window.KeyboardEvent("keydown", { key, bubbles: true, cancelable: true }));
    const said = [];
    for (const key of ["ArrowRight", "ArrowRight", "+", "+", "ArrowRight", "0", "ArrowRight"]) { press(key); await pause(50); said.push(read()); }
    return said;
    """
    times = [float(re.match(r"[\d.]+", said)[0]) for said in looked("comparison", script, tmp_path)]  # type: ignore[index]
    steps = [times[1] - times[0], times[4] - times[3]]
    assert steps[0] > 3 * steps[1] >= 0 and times[6] > times[0]
