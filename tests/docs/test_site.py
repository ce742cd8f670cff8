"""The documentation builds as a site without a warning, and what is generated in it is what the code says."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator
from report_cases import make_run, make_sim

import rovval
from conftest import ROOT
from rovval.cli import document as commands
from rovval.cli.app import COMMANDS
from rovval.comparison import compare
from rovval.pipeline import document as pipelines
from rovval.pipeline.keeping.summary import summarise
from rovval.pipeline.planning.config import Pipeline, Source
from rovval.report import side_by_side
from rovval.report.comparison.json import document

DOCS = ROOT / "docs"
SCHEMAS = sorted((DOCS / "schemas").glob("*.json"))


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The site, built once; a warning of the build is an error."""
    folder = tmp_path_factory.mktemp("site")
    done = subprocess.run(
        [sys.executable, "-m", "mkdocs", "build", "--strict", "--quiet", "--site-dir", str(folder)],
        cwd=ROOT, env={**os.environ, "NO_MKDOCS_2_WARNING": "1"}, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    return folder


def test_every_page_is_there_and_fetches_nothing(site: Path):
    pages = {path.relative_to(DOCS).with_suffix(".html") for path in DOCS.rglob("*.md")}
    assert pages <= {path.relative_to(site) for path in site.rglob("*.html")}
    for page in pages:
        text = (site / page).read_text(encoding="utf-8")
        assert not re.findall(r'<(?:script|link|img)[^>]+(?:src|href)="https?://[^"]+"', text), page


def test_the_pages_hold_what_they_include(site: Path):
    schemas = (site / "reference" / "schemas.html").read_text(encoding="utf-8")
    assert "{{ schema" not in schemas and "<code>window.axes</code>" in schemas and 'id="comparison-error"' in schemas
    python = (site / "reference" / "python.html").read_text(encoding="utf-8")
    assert {name for name in rovval.__all__ if f'id="rovval.{name}"' in python} == set(rovval.__all__) - {"__version__"}
    right = (site / "how_right.html").read_text(encoding="utf-8")
    assert "90 % intervals that hold the true value" in right and "Rigid body with constant coefficients" in right


@pytest.mark.parametrize(("page", "text"), [("commands", commands.text), ("pipelines", pipelines.text)])
def test_a_generated_page_is_current(page, text):
    room = "cli" if page == "commands" else "pipeline"
    path = DOCS / "reference" / f"{page}.md"
    assert path.read_text(encoding="utf-8") == text(), f"write it anew: python -m rovval.{room}.document > docs/reference/{page}.md"


def test_every_command_has_a_section_with_an_example():
    sections = dict(re.findall(r"^## (rovval .+?)\n(.*?)(?=^## |\Z)", commands.text(), re.MULTILINE | re.DOTALL))
    assert {f"rovval {name}" for name, _, _ in COMMANDS} <= set(sections)
    assert {"rovval profile check", "rovval blind score"} <= set(sections)
    assert all("Example:" in sections[f"rovval {name}"] for name, _, _ in COMMANDS)


def test_every_key_of_a_pipeline_file_is_explained():
    for model in (Pipeline, Source):
        for name, field in model.model_fields.items():
            assert field.description and f"| `{name}` |" in pipelines.text(), name


@pytest.mark.parametrize("path", SCHEMAS, ids=lambda path: path.stem)
def test_a_schema_is_one_and_explains_each_key(path):
    schema = json.loads(path.read_text(encoding="utf-8"))
    Draft202012Validator.check_schema(schema)
    parts = [schema, *schema.get("$defs", {}).values()]
    assert all(key.get("description") or "$ref" in key for part in parts for key in part.get("properties", {}).values())
    page = (DOCS / "reference" / "schemas.md").read_text(encoding="utf-8")
    assert f"{{{{ schema {path.stem} }}}}" in page and f"../schemas/{path.name}" in page


def validator(name: str) -> Draft202012Validator:
    return Draft202012Validator(json.loads((DOCS / "schemas" / f"{name}.json").read_text(encoding="utf-8")))


@pytest.mark.parametrize("absent", [(), ("p", "phi")])
def test_a_comparison_is_what_its_schema_says(absent):
    run = make_run(300, absent=absent)
    for other in ({}, {"u": run.get("u") * 0.9}):
        compared = document(compare(run, make_sim(run), other, "another") if other else compare(run, make_sim(run)))
        validator("comparison").validate(json.loads(json.dumps(compared, allow_nan=False)))
        del compared["model"]
        assert not validator("comparison").is_valid(compared)


@pytest.mark.parametrize(("runs", "models"), [(2, 1), (1, 2), (2, 2)])
def test_a_report_side_by_side_is_what_its_schema_says(runs, models):
    made = [replace(make_run(300), id=f"dive{k}") for k in range(runs)]
    all_of_them = [compare(run, replace(make_sim(run), run_id=run.id, model=model)) for run in made for model in ("fossen", "uuv")[:models]]
    found = json.loads(json.dumps(side_by_side.document(all_of_them), allow_nan=False))
    validator("side_by_side").validate(found)
    assert len(found["comparisons"]) == runs * models
    for one in found["comparisons"].values():
        validator("comparison").validate(one)
    assert not validator("side_by_side").is_valid(found | {"comparisons": {"a": {}}})


def test_a_summary_is_what_its_schema_says():
    aside = {"log": "a.csv", "kind": "bad_input", "reason": "no rows", "next": "mend it"}
    found = summarise("night", [], [], [aside], [("b.csv", "still being copied")], ["surge=0.1"], 1.5, {"new": 1}, [("x/*.csv", "no such folder")])
    validator("summary").validate(json.loads(json.dumps(found, allow_nan=False)))
    assert not validator("summary").is_valid(found | {"unknown": 1})


def test_the_figure_of_the_diagnosis_names_its_rooms():
    figure = (DOCS / "pictures" / "diagnose.svg").read_text(encoding="utf-8")
    named = set(re.findall(r"(\w+)/</text>", figure))
    rooms = {path.name for path in (ROOT / "src" / "rovval" / "diagnose").iterdir() if (path / "__init__.py").is_file()}
    assert named == rooms
