"""Units by what they are in SI, worked out by hand; a unit that is not known is refused with those that are."""

import math

import pytest

from rovval.core.errors import UsageProblem
from rovval.core.units import in_degrees, mistaken_units, to_si


@pytest.mark.parametrize(
    ("value", "unit", "si"),
    [
        (180.0, "deg", math.pi), (100.0, "cdeg", math.radians(1.0)), (60.0, "rpm", 1.0), (2 * math.pi, "radps_shaft", 1.0),
        (1.0, "knot", 1852.0 / 3600.0), (3.6, "km/h", 1.0), (1.0, "ft", 0.3048), (1000.0, "mg", 9.80665), (1.0, "kgf", 9.80665), (50.0, "percent", 0.5),
        (1e9, "ns", 1.0),
    ],
)  # fmt: skip
def test_a_unit_is_what_it_is_in_si(value, unit, si):
    assert value * to_si(unit) == pytest.approx(si, rel=1e-12)


def test_a_unit_that_is_not_known_is_refused_with_those_that_are():
    with pytest.raises(UsageProblem, match="unknown unit 'furlong'") as refused:
        to_si("furlong")
    assert "knot" in refused.value.hint


def test_people_read_degrees_and_all_else_as_it_is():
    value, unit = in_degrees(math.pi, "rad/s")
    assert value == pytest.approx(180.0) and unit == "deg/s"
    assert in_degrees(2.0, "m/s") == (2.0, "m/s")


@pytest.mark.parametrize(
    ("ratio", "units"), [(57.1, "degrees and radians"), (1 / 60.3, "rpm and rev/s"), (0.1047, "rpm and rad/s"), (0.5144, "knots and m/s"), (1.3, ""), (0.0, "")]
)
def test_the_ratio_of_two_units_has_their_names(ratio, units):
    assert mistaken_units(ratio) == units
