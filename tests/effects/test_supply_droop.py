"""A supply that gives way under the load of all thrusters."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from diagnose_case import foreign, merlin, own

from rovval.diagnose import diagnose
from rovval.effects.lanes import reference_speed
from rovval.effects.library.supply_droop import static
from rovval.plant import Inputs, Plant, parse_settings
from rovval.plant.inputs import prepare


def test_the_load_is_the_mean_power_over_that_of_all_thrusters_at_one_metre_a_second_ahead():
    vehicle = merlin()
    one = np.zeros((3, len(vehicle.thrusters)))
    one[1], one[2, 0] = reference_speed(vehicle), -2.0 * reference_speed(vehicle)
    load = prepare(Inputs(0.1, one, hold=False), vehicle).log[:, 4]
    assert load == pytest.approx([0.0, 1.0, 8.0 / len(vehicle.thrusters)])


def test_at_that_load_so_much_is_lost_over_what_is_left():
    thrust = np.array([-30.0, 0.0, 50.0])
    assert static(0.25, thrust, 1.0) == pytest.approx(0.8 * thrust)
    assert np.array_equal(static(0.0, thrust, 3.0), thrust)


def test_a_thruster_loses_thrust_to_the_load_of_the_others():
    """Two runs of a vehicle at rest: a vertical thruster by itself, and beside a horizontal one that turns faster."""
    vehicle = merlin()
    plant, n, thrusters = Plant(vehicle, "fossen"), reference_speed(vehicle), vehicle.thrusters
    alone = np.zeros((20, len(thrusters)))
    alone[:, thrusters.index("VAC")] = n
    loaded = alone.copy()
    loaded[:, thrusters.index("HFP")] = 1.5 * n
    still, where = np.zeros((1, 6)), np.zeros(1, int)
    moved = {}
    for name, speed in (("alone", alone), ("loaded", loaded)):
        for droop in (0.0, 0.3):
            beta = parse_settings(plant, [f"supply_droop:droop={droop}"])[None]
            moved[name, droop] = float(plant.simulate(Inputs(0.1, speed, hold=False), where, 5, still, still, beta).nu[0, -1, 2])
    own, more = (moved[name, 0.3] / moved[name, 0.0] for name in ("alone", "loaded"))
    assert own == pytest.approx(1.0 / (1.0 + 0.3 / len(thrusters)), rel=0.02)
    assert more == pytest.approx(1.0 / (1.0 + 0.3 * (1.0 + 1.5**3) / len(thrusters)), rel=0.05)


@pytest.mark.slow
def test_another_plant_s_supply_is_named_without_a_name_beside_it(tmp_path: Path):
    """Its thrust falls with the sum of the thrusts, half of it at a working load, and so with the square of the speeds."""
    [cause] = diagnose([foreign(tmp_path, (("power_limit", "", 1.0),), 31)], merlin()).causes
    assert cause.effect == "supply_droop" and cause.probability > 0.7


@pytest.mark.slow
def test_it_is_named_with_its_size_and_not_where_all_thrusters_are_weaker_by_one_factor():
    [cause] = diagnose([own(("supply_droop:droop=0.5",), 3, 300.0)], merlin()).causes
    droop = cause.parameters["droop"]
    assert cause.effect == "supply_droop" and droop.low < 0.5 < droop.high
    assert [c.effect for c in diagnose([own(("rpm_scale:scale=-0.15",), 3, 300.0)], merlin()).causes] == ["rpm_scale"]
