"""Observability: an effect that would not show is not called absent, and one that shows only when it is large competes."""

from __future__ import annotations

from pathlib import Path

import pytest
from diagnose_case import bluerov2, posed

from rovval.diagnose import diagnose
from rovval.diagnose.criteria import LARGE_SIZE, OBSERVABLE_SIGMA
from rovval.diagnose.hypotheses.observability import observable
from rovval.vehicle import load


def test_what_only_shows_when_it_is_large_competes_and_is_not_called_absent():
    p, library = posed()
    kept, silent = observable(p, library)
    names = {h.name for h in kept}
    assert silent.keys() & names and silent.keys() - names and not (names | silent.keys()) ^ {h.name for h in library}
    assert all(float(why.split("with ")[1].split()[0]) >= OBSERVABLE_SIGMA / LARGE_SIZE for name, why in silent.items() if name in names)


@pytest.mark.slow
def test_what_is_named_is_not_called_untestable(tmp_path: Path):
    """A thruster that is turned far round shows, though a turn of typical size would not."""
    document = diagnose([bluerov2(tmp_path, "turned.csv", 12, 200.0, 0.03, ("thruster_misaligned", "T1", -2.0))], load("bluerov2_heavy")).document()
    assert [c["effect"] for c in document["causes"]] == ["thruster_misaligned[T1]"], document["sentence"]
    untestable = {row["effect"] for row in document["not_testable"]}
    assert "thruster_misaligned[T2]" in untestable and "thruster_misaligned[T1]" not in untestable
