"""The twin of a log: what an effect that the library lacks has made of its gap."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from rovval import vehicle
from rovval.blind.cases.generate import make
from rovval.blind.cases.grid import Case
from rovval.blind.plant.spec import Planted
from rovval.blind.scoring.outcomes import SEEN, SURE
from rovval.blind.scoring.twin import made_by_effect

MERLIN = vehicle.LIBRARY / "merlin.toml"
ASKED = {"model": "fossen", "window_s": 10.0, "calibration_slop": 0.05}
FLOWN = Case("steps", (), 11, 150.0)


def log(folder: Path, *effects: Planted) -> Path:
    made = make(MERLIN, replace(FLOWN, effects=effects), folder / "log.csv")
    assert "failed" not in made
    return folder / "log.csv"


@pytest.mark.slow
def test_a_log_without_effects_is_its_own_twin(tmp_path: Path):
    found = made_by_effect(log(tmp_path), str(MERLIN), FLOWN, ASKED)
    assert found["seen"] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.slow
def test_a_strong_effect_has_made_most_of_the_gap(tmp_path: Path):
    found = made_by_effect(log(tmp_path, Planted("dry_friction", None, 2.0)), str(MERLIN), FLOWN, ASKED)
    assert found["seen"] > SEEN and found["sure"] > SURE
