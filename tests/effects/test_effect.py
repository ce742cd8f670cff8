"""What an effect states of itself: parameters that make sense, and tolerances of a healthy vehicle."""

from __future__ import annotations

from typing import Any

import pytest

from rovval import effects, vehicle
from rovval.core.errors import UsageProblem
from rovval.effects import Parameter, Tolerance
from rovval.plant import Plant


def parameter(**stated: Any) -> Parameter:
    plain: dict[str, Any] = {"name": "size", "unit": "N", "low": -1.0, "high": 1.0, "null": 0.0, "typical": 0.1, "source": "chosen"}
    return Parameter(**plain | stated)


@pytest.mark.parametrize("stated", [{"null": 2.0}, {"low": 1.0, "null": 1.0}, {"typical": 0.0}, {"role": "anchor"}, {"channel": "x"}])
def test_a_parameter_that_makes_no_sense_is_refused(stated):
    with pytest.raises(ValueError, match="parameter size"):
        parameter(**stated)


def test_what_only_places_an_effect_is_no_departure():
    roles = ("size", "lever", "onset", "period", "direction", "datum", "extent")
    assert [parameter(role=role).places for role in roles] == [False] * 2 + [True] * 5
    assert parameter(role="anchor", channel="x").places


def test_a_tolerance_goes_by_the_calibration_tolerance_or_stands_as_it_is():
    merlin, p = vehicle.load("merlin"), parameter()
    assert Tolerance(2.0, "chosen").of(p, merlin, "", 0.05) == 0.1
    assert Tolerance(2.0, "chosen", calibrated=False).of(p, merlin, "", 0.05) == 2.0
    assert Tolerance(lambda p, v, target: p.typical * v.weight, "chosen").of(p, merlin, "", 0.5) == pytest.approx(0.05 * merlin.weight)


def test_under_an_autopilot_the_tolerance_of_the_steadied_axis_widens():
    stiff, loop = Tolerance(1.0, "chosen"), {"roll": 3.0, "pitch": 1.0}
    linear, root = Tolerance(1.0, "chosen", loop_gain=1.0), Tolerance(1.0, "chosen", loop_gain=0.5)
    assert stiff.widened(0.1, "roll", loop) == 0.1
    assert linear.widened(0.1, "roll", loop) == pytest.approx(0.4)
    assert linear.widened(0.1, "yaw", loop) == 0.1
    assert root.widened(0.1, "", loop) == pytest.approx(0.2), "what belongs to no axis goes by the stiffest loop"


def test_every_sensor_states_how_far_off_a_healthy_one_is():
    for name in effects.names():
        assert (effects.sensor_tolerance(name) is not None) == (effects.load(name).place == "sensor")
    assert effects.sensor_tolerance("no such effect") is None


def test_a_platform_without_a_term_has_nothing_of_it_to_take_away():
    merlin = vehicle.load("merlin")
    low = {m: {s.key: s.parameter.low for s in Plant(merlin, m).slots} for m in ("fossen", "freefloating")}
    assert {k.partition("[")[0] for k in low["fossen"] if low["fossen"][k] != low["freefloating"][k]} == {"added_mass", "linear_drag"}
    assert low["freefloating"]["added_mass[surge].scale"] == 0.0


def test_a_name_that_is_not_in_the_library_is_refused():
    with pytest.raises(UsageProblem, match="no effect named 'gremlins'"):
        effects.load("gremlins")


def test_families_of_a_fit_hold_coefficients_that_are_tuned_and_not_searched():
    for name in effects.names():
        effect = effects.load(name)
        assert not (effect.family and effect.searched), name
    assert {effects.load(n).family for n in effects.names()} == {"", *effects.FAMILIES}
