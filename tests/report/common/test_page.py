"""Templates escape every value, refuse a name that they were not given, and are part of the package."""

import re
from pathlib import Path
from typing import Any

import pytest
from jinja2 import UndefinedError
from page_case import check_html
from report_cases import diagnosis, make_run, make_sim

from rovval import report
from rovval.comparison import compare
from rovval.report.common.page import render
from rovval.report.comparison import html as comparison_page
from rovval.report.diagnosis import html as diagnosis_page

HEAD: dict[str, Any] = {
    "title": "<t>", "eyebrow": "e", "name": "<b>n", "banner": "<i>", "said": ["a & b", "<u>"], "facts": {"<k>": "<v>", "empty": ""}, "footer": "f",
}  # fmt: skip


def test_every_value_is_escaped() -> None:
    page = render("page.html", **HEAD)
    check_html(page)
    assert "&lt;b&gt;n" in page and "a &amp; b" in page and "&lt;k&gt;" in page
    assert not any(tag in page for tag in ("<b>", "<i>", "<u>", "<v>", "<script", "empty"))


def test_curves_cannot_end_their_element_early() -> None:
    page = render("page.html", {"x": {}, "plots": [{"label": "</script><img>"}]}, **HEAD)
    check_html(page)
    assert "\\u003c/script>\\u003cimg>" in page and "Leon Sorokin" in page


def test_a_name_that_the_template_lacks_is_an_error() -> None:
    with pytest.raises(UndefinedError, match="footer"):
        render("page.html", **{k: v for k, v in HEAD.items() if k != "footer"})


def test_templates_and_assets_lie_in_the_package() -> None:
    room = Path(report.__file__).parent
    assert {p.name for p in (room / "templates").glob("*.html")} >= {"page.html", "parts.html", "comparison.html", "diagnosis.html", "batch.html", "blind.html"}
    assert "Leon Sorokin" in (room / "assets" / "uPlot.LICENSE").read_text()


def test_every_word_that_is_linked_has_its_meaning_on_the_page() -> None:
    for page in (diagnosis_page.text(diagnosis()), comparison_page.text(compare(make_run(200), make_sim(make_run(200))))):
        linked, told = set(re.findall(r'href="#word-([^"]+)"', page)), set(re.findall(r'id="word-([^"]+)"', page))
        assert linked and linked <= told
