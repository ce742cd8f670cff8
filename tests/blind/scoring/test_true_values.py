"""What is planted in the independent plant's numbers, told in the library's."""

from __future__ import annotations

from pathlib import Path

import pytest
from diagnose_case import logged

from rovval import vehicle
from rovval.blind.cases.flight import fly
from rovval.blind.plant.spec import Planted
from rovval.blind.planted.catalogue import catalogue
from rovval.blind.scoring import ground_truth, true_values
from rovval.blind.scoring.oracle import fitted

MERLIN = vehicle.LIBRARY / "merlin.toml"


def targets(name: str) -> tuple[str | None, ...]:
    kinds = catalogue()[name].targets
    return ("HFP",) if kinds == ("thruster",) else kinds or (None,)


MAPPED = [(name, target) for name in true_values.TABLE for target in targets(name) if (name, target) != ("inertia_error", "surge")]


@pytest.mark.slow
@pytest.mark.parametrize(("name", "target"), MAPPED)
def test_numbers_map_onto_the_library(name, target, tmp_path: Path):
    """On a vehicle without slop, re-simulation with the true effect finds the number that the table says (sign, unit, reference)."""
    flight = fly(MERLIN, "rich", [Planted(name, target, 1.5)], 11, 180.0, slop=0.0)
    [effect] = flight.truth["effects"]
    wanted = true_values.true_values(effect, vehicle.load("merlin"))
    if not wanted:
        pytest.skip("the planted size lies outside the library's bounds: not scored")
    onsets = {ground_truth.name(effect): effect["onset_s"]} if effect["onset_s"] else {}
    found = fitted(logged(flight, tmp_path / "log.csv"), vehicle.load("merlin"), [ground_truth.name(effect)], onsets)
    for key, value in wanted.items():
        assert found[f"{ground_truth.name(effect)}.{key}"] == pytest.approx(value, rel=0.35, abs=1e-3)
