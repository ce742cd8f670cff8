"""Flights of plant b: equal seeds give equal logs, every pilot stays sane, and each effect acts, in its label and in nothing when its severity is none."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from blind_case import vehicle_file

from rovval import vehicle
from rovval.blind.plant.spec import AXES, Flight, Planted
from rovval.blind.scoring import ground_truth
from rovval.blind.second.catalogue import catalogue
from rovval.blind.second.fault import Fault
from rovval.blind.second.flight import fly
from rovval.blind.second.pilots import PILOTS
from rovval.plant import Plant

MERLIN = vehicle_file("merlin")
SECONDS = 20.0
ALL_AT_ONCE = ("thruster_reversed", "velocity_filter_lag")  # a shaft turns the one way or the other; the highest corner of a filter is 4 Hz of the 5 there are
FEW = ("quadratic_drag", "thrust_lag", "current_shear", "tether_snag", "compass_deviation", "kelp")  # one of each way into the plant


@pytest.fixture(scope="module")
def healthy() -> Flight:
    return fly(MERLIN, "joystick", [], 11, SECONDS)


def difference(a: Flight, b: Flight) -> float:
    """Largest change of a cell of ``a`` from ``b``, in units of the column's spread in ``b``, by which all that is compared with it is measured alike."""
    found = 0.0
    for name, x in b.measured.items():
        change = a.measured[name] - x
        change = (change + 180.0) % 360.0 - 180.0 if name == "Heading" else change
        both = np.isfinite(change)
        found = max(found, float(np.abs(change[both]).max()) / (float(np.nanstd(x)) + 1e-9))
    return found


def label(flight: Flight) -> dict[str, Any]:
    [effect] = json.loads(json.dumps(flight.truth))["effects"]
    return dict(effect)


def test_the_same_seed_gives_the_same_log_and_another_does_not(healthy: Flight) -> None:
    again, other = fly(MERLIN, "joystick", [], 11, SECONDS), fly(MERLIN, "joystick", [], 12, SECONDS)
    assert all(np.array_equal(x, again.measured[name], equal_nan=True) for name, x in healthy.measured.items())
    assert not np.array_equal(other.true["u"], healthy.true["u"])


@pytest.mark.parametrize("name", ["merlin", pytest.param("bluerov2_heavy", marks=pytest.mark.slow), pytest.param("minerva", marks=pytest.mark.slow)])
@pytest.mark.parametrize("mission", PILOTS)
def test_every_pilot_flies_within_sane_limits(mission: str, name: str) -> None:
    true = fly(vehicle_file(name), mission, [], 5, SECONDS).true
    assert max(float(np.abs(true[k]).max()) for k in "uvw") < 1.5
    assert float(true["altitude"].min()) > 0.3
    assert max(float(np.abs(true[k]).max()) for k in ("roll", "pitch")) < 0.8
    assert max(float(np.abs(true[k]).max()) for k in "uvwr") > 0.005


def check(name: str, healthy: Flight) -> None:
    """Nothing at severity zero, more at one than at a fiftieth, and a label that says how much."""
    none = fly(MERLIN, "joystick", [Planted(name, None, 0.0)], 11, 2.0)
    assert all(np.array_equal(x, healthy.true[key][: len(x)]) for key, x in none.true.items() if key != "voltage")
    full, little = (fly(MERLIN, "joystick", [Planted(name, None, s)], 11, SECONDS) for s in (1.0, 0.02))
    assert difference(full, healthy) > 0.03
    if name not in ALL_AT_ONCE:
        assert difference(little, healthy) < 0.6 * difference(full, healthy)
    effect, kind = label(full), catalogue()[name]
    assert effect["values"] and effect["realised"]
    assert (effect["onset_s"] is not None) == kind.event
    assert ground_truth.foreign(effect) == (not kind.known and name not in ground_truth.NAMED_SINCE)


@pytest.mark.parametrize("name", FEW)
def test_an_effect_acts_and_is_labelled(name: str, healthy: Flight) -> None:
    check(name, healthy)


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(set(catalogue()) - set(FEW)))
def test_every_effect_acts_and_is_labelled(name: str, healthy: Flight) -> None:
    check(name, healthy)


def test_the_label_has_the_wrench_that_was_planted() -> None:
    """Of a force that is known: the lift of foam, in heave, and nothing sideways."""
    flight = fly(MERLIN, "hover", [Planted("buoyancy_error", None, 1.0)], 3, SECONDS, slop=0.0)
    effect = label(flight)
    assert effect["realised"]["wrench_rms"]["heave"] == pytest.approx(effect["values"]["lift"], rel=0.05)
    assert effect["realised"]["wrench_rms"]["sway"] < 0.1 * effect["values"]["lift"]
    mass = label(fly(MERLIN, "joystick", [Planted("added_mass", "translation", 1.0)], 3, SECONDS))
    assert all(mass["realised"]["wrench_rms"][axis] > 0.0 for axis in AXES[:3])


def test_an_onset_leaves_what_was_before_it_alone(healthy: Flight) -> None:
    late = fly(MERLIN, "joystick", [Planted("current_constant", None, 1.0, onset_s=12.0)], 11, SECONDS)
    before = healthy.time_s < 11.95
    assert np.allclose(late.true["u"][before], healthy.true["u"][before], rtol=0.0, atol=1e-12)
    assert not np.allclose(late.true["u"], healthy.true["u"])


def test_wrong_names_targets_and_severities_are_refused() -> None:
    for item in (Planted("gremlin"), Planted("thruster_degraded", "T9"), Planted("tether_drag", severity=-1.0)):
        with pytest.raises(ValueError, match=r"gremlin|T9|tether_drag"):
            fly(MERLIN, "hover", [item], 1, 1.0)
    with pytest.raises(ValueError, match="lawn"):
        fly(MERLIN, "lawn", [], 1, 1.0)


def test_every_name_is_the_library_s_or_no_name_of_it() -> None:
    library = set(Plant(vehicle.load("merlin")).hypotheses)
    for name, kind in catalogue().items():
        for target in ("HFP",) if kind.targets == ("thruster",) else kind.targets or (None,):
            planted = {"name": name, "target": target, "place": kind.place if kind.known else "foreign"}
            assert (ground_truth.name(planted) in library) == (kind.known or name in ground_truth.NAMED_SINCE), planted


def test_no_two_effects_look_the_same_on_paper() -> None:
    kinds: list[type[Fault]] = list(catalogue().values())
    assert len(kinds) >= 45 and all(kind.__doc__ and kind.unit for kind in kinds)
    assert sum(not kind.known for kind in kinds) >= 8
