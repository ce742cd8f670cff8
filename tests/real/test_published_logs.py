"""Published logs whose answer is known: ballast bags, yaw drag of a BlueROV of 2016, and the logs of an outside plant."""

from __future__ import annotations

import pytest
from published_logs import YAW, ballast, height_of_thrusters, outside_parts, outside_plant, yaw_drag, yaw_drag_over_thrust
from real_answers import WRONG, Answer, confidence, named_first, overconfident, table

pytestmark = pytest.mark.real
BALLAST_N = -4.6  # beyond the file's, of `ff_nb1` by its publishers' own fit
YAW_DRAG = 3.95  # N m s: least squares on one axis, with the thrust table held, 3.9 to 4.0 on each of the three logs
HEIGHT_M = 0.085  # of the horizontal thrusters below the centre, printed (von Benzon 2022); about nothing acts
MINUTES = 10.0  # of the outside plant's logs; the longer ones, a third, say nothing else and take as long as these together


def force(answer: Answer) -> float | None:
    """Buoyancy (N) beyond the file's that an answer names."""
    found = [cause["parameters"]["force"]["value"] for cause in answer.document["causes"] if cause["effect"] == "buoyancy_error"]
    return float(found[0]) if found else None


def test_ballast_is_named_with_its_sign_and_size():
    answers = ballast()
    print("\n" + table(answers) + "\n\n" + confidence(answers))
    forces = {one.question.log: force(one) for one in answers}
    print("\n".join(f"{log}: " + ("not named" if value is None else f"{value:.1f} N") for log, value in forces.items()))
    assert all(value < 0 for value in forces.values() if value is not None)
    [without] = [one for one in answers if one.question.log == "ff_nb1"]
    assert without.mark == "right"
    assert forces["ff_nb1"] == pytest.approx(BALLAST_N, abs=1.0)


def test_yaw_drag_is_named_each_and_jointly():
    answers = yaw_drag()
    print("\n" + table(answers) + "\n\n" + confidence(answers))
    right, asked = named_first(answers)
    assert right == asked


@pytest.mark.parametrize("logs", [*((name,) for name in YAW), YAW], ids=" ".join)
def test_yaw_drag_over_thrust_is_that_of_least_squares(logs: tuple[str, ...]):
    found = yaw_drag_over_thrust(logs)
    print(f"{' '.join(logs)}: {found:.2f} N m s")
    assert found == pytest.approx(YAW_DRAG, rel=0.1)


def test_height_of_thrusters_is_named_with_its_size_on_each_run():
    """85 mm are printed and next to nothing acts: calibrations on two runs at a time say 85 to 91 mm less."""
    answers = height_of_thrusters()
    print("\n" + table(answers) + "\n\n" + confidence(answers))
    for one in answers[:-1]:
        assert one.mark == "right", one
        cause = next(c for c in one.document["causes"] if c["effect"] == "thruster_place")
        assert cause["kind"] == "file"
        assert cause["parameters"]["down"]["value"] == pytest.approx(-HEIGHT_M, abs=0.02)


def test_effects_of_an_outside_plant_are_named():
    answers = outside_plant(MINUTES)
    print("\n" + "\n".join(f"{one.question.log} {one.question.piece}: {one}" for one in answers) + "\n\n" + confidence(answers))
    (right, asked), (wrong, sure) = named_first(answers), overconfident(answers)
    print(f"named first: {right} of {asked}; wrong of those printed at 0.9 or above: {wrong} of {sure}")
    assert right >= asked / 2


def test_effects_of_an_outside_plant_are_named_in_parts_of_its_logs():
    """Half an hour: less than whole logs say, and so more that is undecided."""
    answers = outside_parts()
    print("\n" + "\n".join(f"{one.question.log} {one.question.piece}: {one}" for one in answers) + "\n\n" + confidence(answers))
    (right, asked), (wrong, sure) = named_first(answers), overconfident(answers)
    print(f"named first: {right} of {asked}; wrong of those printed at 0.9 or above: {wrong} of {sure}")
    assert right >= 0.8 * asked
    assert wrong <= WRONG * sure
    assert not [one for one in answers if not one.question.right and one.causes], "a healthy part is blamed"
