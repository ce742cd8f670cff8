"""The score of a blind check as page and as text: every kind of logs, intervals beside shares, wrong answers, unsealings."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from blind_case import answer, answered_right, cause, label
from page_case import check_html

from rovval import vehicle
from rovval.blind.scoring.score import score_logs
from rovval.report.blind import html, terminal


@pytest.fixture(scope="module")
def result() -> dict[str, Any]:
    """Ten logs answered right, and a healthy one in which waves are blamed."""
    labels, answers = answered_right(np.random.default_rng(2), 10)
    labels["n"], answers["n"] = label(), answer(cause("waves"))
    head = {"vehicle": "merlin", "seed": 1, "size": "10", "engine": "abc", "rovval": "0", "opened": "", "committed": ""}
    past = {"opened": "2026-01-02T10:11:12Z", "seed": 3, "size": "full", "vehicle": "minerva", "logs": 300, "engine": "old"}
    return score_logs(labels, answers, {}, str(vehicle.LIBRARY / "merlin.toml")) | head | {"unsealings": [past]}


def test_page_and_text_hold_every_kind_of_logs(result: dict[str, Any]) -> None:
    json.dumps(result, allow_nan=False)
    page, text = html.text(result), terminal.text(result)
    check_html(page)
    assert all(kind in page and kind in text for kind in result["strata"])


def test_shares_have_their_interval_in_the_first_sentences(result: dict[str, Any]) -> None:
    page = html.text(result)
    assert "The right effect comes first in 100 % [79, 100] of 10 logs" in page
    assert "A gap is claimed in 100 % [27, 100] of 1 healthy logs." in page


def test_wrong_answers_and_unsealings_have_a_row_each(result: dict[str, Any]) -> None:
    page = html.text(result)
    assert [w["kind"] for w in result["wrong"]] == ["false alarm"]
    assert "false alarm" in page and "waves" in page and "1 answer wrong" in terminal.text(result)
    assert "2026-01-02 10:11" in page and "minerva" in page
    assert "Unsealings" not in html.text(result | {"unsealings": []})
