"""Each page says what made it."""

from __future__ import annotations

from report_cases import make_run, make_sim

from rovval.comparison import compare
from rovval.core.version import __version__
from rovval.report.common.versions import foot, made_by
from rovval.report.comparison import html


def test_a_page_names_its_command_and_the_version():
    run = make_run(100)
    with made_by(["compare", "my dive.csv", "--out", "<b>"]):
        page = html.text(compare(run, make_sim(run)))
    assert f"made by rovval compare &#39;my dive.csv&#39; --out &#39;&lt;b&gt;&#39; · rovval {__version__} · python" in page


def test_a_page_of_a_script_names_no_command_and_one_command_is_not_another_s():
    with made_by(["run", "night.toml"]):
        with made_by(["compare", "a.csv"]):
            assert foot().startswith("made by rovval compare a.csv · ")
        assert foot().startswith("made by rovval run night.toml · ")
    assert foot("more").startswith(f"rovval {__version__} · ") and foot("more").endswith(" · more")
