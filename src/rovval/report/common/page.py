"""HTML pages from the templates: one file each, nothing fetched, readable on a phone, light and dark.

A template (``templates/*.html``, Jinja2) holds all the HTML of its page; what it is given is data. Every value is escaped.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from functools import cache, partial
from pathlib import Path
from typing import Any
from urllib.parse import quote

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup, escape

from rovval.core.units import DEGREE_UNITS, DEGREES, integral_unit
from rovval.report.common import numbers
from rovval.report.common.glossary import TERMS, linked
from rovval.report.drawings.still import still

ROOM = Path(__file__).parent.parent
EXPLAINED = ("comparison.html", "diagnosis.html")  # pages that end with the meaning of their words
FORMATS = (numbers.number, numbers.signed, numbers.quantity, numbers.interval, numbers.per_cent, numbers.per_cents, numbers.share,
           numbers.probability, numbers.duration, numbers.listed)  # fmt: skip


def render(template: str, curves: Mapping[str, Any] | None = None, links: Mapping[str, str] | None = None, **data: Any) -> str:
    """The whole document of ``templates/<template>`` filled with ``data``. ``curves`` is what the script draws (see `curves.plot`), if there are any.
    ``links`` are the pages that belong to it, by what they are called. A name that the template uses and ``data`` lacks is an error."""
    words = TERMS if template in EXPLAINED else {}
    drawn = {"curves": None} if curves is None else {"curves": _json(curves), "picture": partial(still, plots=curves["plots"], axes=curves["x"])}
    page = _environment().get_template(template).render(glossary=words, links=links, **drawn, **data)
    return linked(page) if words else page


@cache
def _environment() -> Environment:
    environment = Environment(
        loader=FileSystemLoader(ROOM / "templates"), autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    environment.filters |= {f.__name__: f for f in FORMATS} | {"path": quote, "code": _code, "as_json": _json}
    environment.globals |= {"asset": _asset, "MISSING": numbers.MISSING, "DEGREES": DEGREES, "DEGREE_UNITS": DEGREE_UNITS, "integral_unit": integral_unit}
    return environment


def _code(words: str) -> Markup:
    """Words in which what stands between backticks is typed."""
    return Markup(re.sub("`([^`]*)`", r"<code>\1</code>", str(escape(words))))


@cache
def _asset(name: str) -> Markup:
    """Text of a file of ``assets``, which is ours and is put into the page as it is."""
    return Markup((ROOM / "assets" / name).read_text(encoding="utf-8"))


def _json(values: Any) -> Markup:
    """Values as JSON; no "<" in them can end their element early."""
    return Markup(json.dumps(values, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c"))
