"""HTML pages as tests look at them."""

import re
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote

from rovval.diagnose.result.diagnosis import Diagnosis

VOID = {"meta", "br", "link", "input", "img"}


class Balance(HTMLParser):
    """Refuses tags that are not closed in order, and collects what the page would fetch, and where it leads."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.fetched: list[str] = []
        self.links: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        to = self.links if tag == "a" else self.fetched
        to += [v or "" for k, v in attrs if k in ("src", "href", "srcset") and not (v or "").startswith("#")]
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """`<line/>` of SVG opens and closes itself."""

    def handle_endtag(self, tag: str) -> None:
        assert self.open and self.open.pop() == tag, f"</{tag}> at {self.getpos()}"


def check_html(text: str) -> None:
    """Every tag is closed, and nothing is fetched."""
    parser = Balance()
    parser.feed(text)
    assert parser.open == [] and parser.fetched == []


def pages_led_to(page: Path) -> set[Path]:
    """The files that a page leads to, all of which have to be there."""
    parser = Balance()
    parser.feed(page.read_text(encoding="utf-8"))
    found = {(page.parent / unquote(to)).resolve() for to in parser.links}
    assert all(path.is_file() for path in found), found
    return found


def read(page: str) -> str:
    """A page without the links of its terms, which stand in the middle of sentences."""
    return re.sub(r'<a class="term"[^>]*>([^<]*)</a>', r"\1", page)


def formats(d: Diagnosis) -> tuple[str, str, str]:
    """The diagnosis as page, Markdown and text of the terminal, the latter on one line."""
    from rovval.report.diagnosis import html, markdown, terminal

    page = html.text(d)
    check_html(page)
    return read(page), markdown.text(d), " ".join(terminal.text(d).split())
