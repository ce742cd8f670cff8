"""Templates escape every value, refuse a name that they were not given, and are part of the package."""

from pathlib import Path
from typing import Any

import pytest
from jinja2 import UndefinedError
from page_case import check_html

from rovval import report
from rovval.report.common.page import render

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
    assert "<\\/script><img>" in page and "Leon Sorokin" in page


def test_a_name_that_the_template_lacks_is_an_error() -> None:
    with pytest.raises(UndefinedError, match="footer"):
        render("page.html", **{k: v for k, v in HEAD.items() if k != "footer"})


def test_templates_and_assets_lie_in_the_package() -> None:
    room = Path(report.__file__).parent
    assert {p.name for p in (room / "templates").glob("*.html")} >= {"page.html", "parts.html", "comparison.html", "diagnosis.html", "batch.html", "blind.html"}
    assert "Leon Sorokin" in (room / "assets" / "uPlot.LICENSE").read_text()
