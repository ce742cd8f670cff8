"""Terms of the pages lead to their meaning."""

from __future__ import annotations

import re

import pytest
from report_cases import diagnosis, make_run, make_sim

from rovval.comparison import compare
from rovval.report.common.glossary import TERMS, linked
from rovval.report.comparison import html as comparison_page
from rovval.report.diagnosis import html as diagnosis_page

FOOT = '<section id="words">foot: the gap</section>'


def said(html: str) -> str:
    return re.sub(r"<[^>]+>", "", html)


def test_the_first_of_a_section_is_a_link_and_words_that_are_part_of_others_are_none():
    page = f"<body><th>The gap, gaps, a gapless Confusion Group</th><section><dt>gap</dt></section>{FOOT}"
    link = '<a class="term" href="#word-gap">gap</a>'
    group = '<a class="term" href="#word-confusion-group">Confusion Group</a>'
    assert linked(page) == f"<body><th>The {link}, gaps, a gapless {group}</th><section><dt>{link}</dt></section>{FOOT}"


def test_a_sentence_is_linked_beside_what_is_typed_and_what_is_a_link_already():
    page = f'<body><p>The <code>gap</code> of <a href="x">rms</a>, a gap.</p><ul><li>held-out</li></ul>{FOOT}'
    found = linked(page)
    assert re.findall(r'<a class="term" href="#word-([^"]+)">', found) == ["gap", "held-out"]
    assert '<code>gap</code> of <a href="x">rms</a>, a <a class="term"' in found


@pytest.mark.parametrize("page", ["<td>gap <b>rms</b></td>", "<h2>gap</h2>", '<dd class="value">gap.csv</dd>', '<th scope="row">gap</th>'])
def test_names_and_values_stay(page):
    assert linked(f"<body>{page}{FOOT}") == f"<body>{page}{FOOT}"


def test_a_link_that_is_there_counts():
    page = f'<body><a class="term" href="#word-free-run">free run</a><th>free run</th>{FOOT}'
    assert linked(page) == page


@pytest.mark.parametrize("page", ["comparison", "diagnosis"])
def test_a_whole_page_links_each_term_that_it_uses_and_says_what_it_said(page):
    run = make_run(300)
    html = comparison_page.text(compare(run, make_sim(run))) if page == "comparison" else diagnosis_page.text(diagnosis())
    body = html.partition("<body>")[2].partition('<section id="words">')[0]
    links = re.findall(r'<a class="term" href="#word-([^"]+)"[^>]*>([^<]*)</a>', body)
    assert {name.replace("-", " ") for name, _ in links} <= set(TERMS) and len({name for name, _ in links}) >= 5
    assert all(f'id="word-{name}"' in html for name, _ in links)
    assert "<a" not in "".join(re.findall(r"<a [^>]*>(.*?)</a>", body, re.DOTALL)), "no link in a link"
    assert linked(html) == html and "gap" in said(body), "once is enough"
