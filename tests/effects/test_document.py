"""docs/effects.md is what the effects say of themselves."""

from __future__ import annotations

import re
from pathlib import Path

from rovval import effects
from rovval.effects.document import text
from rovval.effects.literature import REFERENCES, key

PAGE = Path(__file__).parent.parent.parent / "docs" / "effects.md"


def test_the_page_is_current():
    assert PAGE.read_text(encoding="utf-8") == text(), "write it anew: python -m rovval.effects.document > docs/effects.md"


def test_every_effect_has_a_section_and_every_link_leads_to_one():
    sections = re.findall(r"^### (\w+)$", text(), flags=re.MULTILINE)
    assert sorted(sections) == list(effects.names())
    assert set(re.findall(r"\]\(#(\w+)\)", text())) == set(sections)


def test_every_reference_is_cited_and_every_citation_is_there():
    listed = set(re.findall(r"^- \*\*(.+?)\*\*: ", text().partition("## References")[2], flags=re.MULTILINE))
    cited = {key(c) for name in effects.names() for c in effects.load(name).literature}
    assert cited <= listed
    assert listed == set(REFERENCES), "a reference that no effect cites"


def test_a_table_has_as_many_cells_as_its_head():
    for row in (line for line in text().splitlines() if line.startswith(("| ", "|--"))):
        assert row.count("|") == 8, row
