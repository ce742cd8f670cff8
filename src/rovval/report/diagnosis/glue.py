"""The page that every HTML report is put in: one file, nothing fetched, light and dark, readable on a phone."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from html import escape
from pathlib import Path
from typing import Any

ASSETS = Path(__file__).parent.parent / "assets"


@cache
def asset(name: str) -> str:
    """Text of a file of ``assets``."""
    return (ASSETS / name).read_text(encoding="utf-8")


def page(title: str, body: str, data: Mapping[str, Any] | None) -> str:
    """The whole document. ``data`` holds the curves that the script draws; a page of tables alone (None) has no script."""
    return (
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{escape(title)}</title>\n<style>{asset('uPlot.min.css')}\n{asset('report.css')}</style></head>\n<body>\n{body}\n"
        f"{'' if data is None else _script(data)}</body></html>\n"
    )


def _script(data: Mapping[str, Any]) -> str:
    """What draws the curves, and the curves; "</" in them cannot end their element early."""
    curves = json.dumps(data, separators=(",", ":"), allow_nan=False).replace("</", "<\\/")
    return (
        f'<script type="application/json" id="data">{curves}</script>\n'
        f"<script>/* uPlot, (c) 2022 Leon Sorokin, MIT licence */{asset('uPlot.iife.min.js')}</script>\n"
        f"<script>{asset('report.js')}</script>\n"
    )


def head(eyebrow: str, name: str, banner: str, verdict: Sequence[str], facts: Mapping[str, Any], note: str = "") -> str:
    """What a reader sees first: what this is, the banner of a made-up log, the answer in a sentence, and a ready-made ``note``
    (HTML) on what it rests on."""
    warn = f'<p class="banner">{escape(banner)}</p>' if banner else ""
    rest = f'<p class="rest">{escape(" ".join(verdict[1:]))}</p>' if verdict[1:] else ""
    items = "".join(f"<div><dt>{escape(k)}</dt><dd>{escape(str(v))}</dd></div>" for k, v in facts.items() if v)
    return (
        f'<p class="eyebrow">{escape(eyebrow)}</p><h1>{escape(name)}</h1>{warn}'
        f'<p class="verdict">{escape(verdict[0])}</p>{rest}{note}<dl class="facts">{items}</dl>'
    )


def section(title: str, *parts: str, lead: str = "", anchor: str = "") -> str:
    """A heading with what belongs under it; nothing when there is nothing. ``anchor`` is what a link to it names."""
    if not any(parts):
        return ""
    intro = f'<p class="lead">{escape(lead)}</p>' if lead else ""
    place = f' id="{anchor}"' if anchor else ""
    return f"<section{place}><h2>{escape(title)}</h2>{intro}{''.join(parts)}</section>\n"


def listing(items: Iterable[str]) -> str:
    """A bulleted list of plain texts, "" for none."""
    lines = "".join(f"<li>{escape(item)}</li>" for item in items)
    return f"<ul>{lines}</ul>" if lines else ""


def table(header: Sequence[str], rows: Iterable[Sequence[str]], css: str = "", over: str = "", left: Sequence[int] = ()) -> str:
    """A table of ready-made cells (HTML); the first cell of a row is its heading, columns in ``left`` are text."""
    cells = "".join(f'<th scope="col"{_left(j, left)}>{h}</th>' for j, h in enumerate(header))
    body = "".join(
        f'<tr><th scope="row">{row[0]}</th>' + "".join(f"<td{_left(j, left)}>{c}</td>" for j, c in enumerate(row[1:], 1)) + "</tr>"
        for row in rows
    )
    return f'<div class="scroll"><table class="{css}"><thead>{over}<tr>{cells}</tr></thead><tbody>{body}</tbody></table></div>'


def canvas(identity: str, title: str, unit: str, note: str = "", css: str = "", error: bool = False) -> str:
    """The place of one picture, with its heading, and under it a strip for the error if wanted."""
    strip = f'<div class="canvas error" id="{identity}-error"></div>' if error else ""
    return (
        f'<div class="plot {css}"><header><b>{escape(title)}</b><span>{escape(unit)}</span><span>{escape(note)}</span>'
        f'<span class="read"></span></header><div class="canvas" id="{identity}"></div>{strip}</div>'
    )


def switches(keys: Mapping[str, str]) -> str:
    """Legend and switches in one: a button a curve."""
    buttons = "".join(
        f'<button type="button" data-key="{key}" aria-pressed="true"><i style="border-color:var(--{key})"></i>{escape(label)}</button>'
        for key, label in keys.items()
    )
    return f'<div class="keys" role="group" aria-label="curves">{buttons}</div>'


def footer(text: str) -> str:
    """The last line: what made this."""
    return f"<footer>{escape(text)}</footer>"


def _left(j: int, left: Sequence[int]) -> str:
    return ' class="l"' if j in left else ""
