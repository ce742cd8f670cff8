"""The demonstration: its sample is what its maker makes, says that it is synthetic, and is explained by what was left in."""

import json
from pathlib import Path

import numpy as np
import pytest
from command_case import run
from diagnosis_schema import check_document
from page_case import pages_led_to

from rovval import demo
from rovval.demo import make


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_demo_is_labelled_and_its_maker_is_deterministic(here):
    done = run("demo", "--no-diagnose", "--out", "demo")
    assert "SYNTHETIC" in done.stdout
    assert demo.EFFECT in done.stdout
    assert {p.name for p in Path("demo").iterdir()} == {
        "SYNTHETIC_merlin_dive.csv",
        "report.json",
        "report.md",
        "report.html",
        "run.rrd",
    }
    for name in ("report.md", "report.html", "report.json"):
        assert "synthetic" in Path("demo", name).read_text().lower()
    make.main(Path("again.csv.gz"))
    assert demo.SAMPLE.stat().st_size < 300_000
    first, second = (np.genfromtxt(p, delimiter=",", skip_header=1) for p in (demo.SAMPLE, "again.csv.gz"))
    np.testing.assert_allclose(first, second, atol=0.011)


def test_demo_names_the_effect_that_was_left_in(here):
    document = json.loads(run("demo", "--json", "--out", "demo", "-q").stdout)
    check_document(document["diagnosis"])
    assert [cause["effect"] for cause in document["diagnosis"]["causes"]] == [demo.EFFECT.partition(":")[0]]
    assert all(Path(p).exists() for p in document["files"].values())
    pages = [Path("demo", name).resolve() for name in ("report.html", "diagnosis.html")]
    assert [set(pages_led_to(page)) for page in pages] == [{other, page.parent / "run.rrd"} for page, other in zip(pages, pages[::-1], strict=True)]
