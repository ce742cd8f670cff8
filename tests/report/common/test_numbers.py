"""One formatter for terminal, Markdown and HTML: digits that mean something, an interval in brackets, degrees for angles, shares in per cent."""

import math

import pytest

from rovval.report.common import numbers


@pytest.mark.parametrize(
    ("value", "text"),
    [(0.0712, "0.0712"), (12.345, "12.3"), (1240.4, "1240"), (0.0, "0"), (9.996, "10.0"), (2e-7, "2.00e-07"), (-0.5, "-0.500"), (3e8, "3.00e+08")],
)
def test_three_digits_and_no_exponent_while_it_stays_readable(value: float, text: str) -> None:
    assert numbers.number(value) == text


def test_what_is_not_known_is_a_dash_everywhere() -> None:
    unknown = (numbers.number(None), numbers.number(math.nan), numbers.quantity(None, "m"), numbers.interval(None, 1.0), numbers.per_cent(None))
    assert {*unknown, numbers.per_cents(0.1, None), numbers.share(None), numbers.signed(None)} == {"-"}


def test_an_interval_stands_in_brackets_with_the_unit_behind_it() -> None:
    assert numbers.estimate(0.299, 0.241, 0.358) == "0.299 [0.241, 0.358]"
    assert numbers.estimate(0.12, -0.02, 0.24, "s") == "0.120 [-0.0200, 0.240] s"
    assert numbers.interval(0.1, 0.2, "m/s") == "[0.100, 0.200] m/s"
    assert numbers.estimate(0.299, None, 0.358, "m") == "0.299 m"


def test_angles_and_rates_are_in_degrees() -> None:
    assert numbers.quantity(math.radians(5.73), "rad/s") == "5.73 deg/s"
    assert numbers.estimate(math.radians(2.0), math.radians(1.0), math.radians(3.0), "rad") == "2.00 [1.00, 3.00] deg"


@pytest.mark.parametrize(("share", "text"), [(0.64, "64 %"), (0.003, "0.3 %"), (-0.3, "-30 %"), (-0.0001, "0 %"), (1.0, "100 %")])
def test_a_share_is_in_per_cent(share: float, text: str) -> None:
    assert numbers.per_cent(share) == text


def test_a_share_has_its_interval_in_whole_per_cents() -> None:
    assert numbers.share(0.66, 0.58, 0.72) == "66 % [58, 72]"
    assert numbers.per_cents(-0.001, 0.72) == "[0, 72] %"


def test_no_probability_is_rounded_to_certainty() -> None:
    assert [numbers.probability(p) for p in (0.5, 0.99, 0.9951, 1.0)] == ["0.50", "0.99", "> 0.99", "> 0.99"]


def test_lengths_of_time_are_in_words() -> None:
    assert [numbers.duration(s) for s in (3.04, 90.0, 725.0, 720.0, 7260.0)] == ["3.0 s", "90 s", "12 min 5 s", "12 min", "2 h 1 min"]


def test_lists_end_with_a_word() -> None:
    assert [numbers.listed(x.split()) for x in ("", "a", "a b", "a b c")] == ["", "a", "a and b", "a, b and c"]
    assert numbers.listed("ab", "or") == "a or b"
