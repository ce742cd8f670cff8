"""Thrusters at another place: the same as a vehicle file with the places moved, and named by a log of a vehicle whose thrusters are there."""

from __future__ import annotations

import numpy as np
import pytest
from diagnose_case import merlin, own

from rovval import simulation
from rovval.diagnose import diagnose
from rovval.vehicle.model import Vehicle


def moved(of: Vehicle, down: float, ahead: float) -> Vehicle:
    """The vehicle with its thrusters' places moved in its file, the height of those that act in the horizontal plane only."""
    thrusters = []
    for one in of.thruster:
        x, y, z = one.position
        thrusters.append(one.model_copy(update={"position": (x + ahead, y, z + (0.0 if abs(one.direction[2]) > 0.9 else down))}))
    return of.model_copy(update={"thruster": tuple(thrusters)})


def test_it_is_a_file_with_the_places_moved():
    run = own((), 5, 60.0)
    of_the_file = simulation.simulate(run, moved(merlin(), 0.2, -0.1))
    by_the_effect = simulation.simulate(run, merlin(), effects=("thruster_place:down=0.2,ahead=-0.1",))
    nominal = simulation.simulate(run, merlin())
    np.testing.assert_allclose(by_the_effect.free.nu, of_the_file.free.nu, atol=1e-9)
    assert np.abs(by_the_effect.free.nu - nominal.free.nu)[:, 4].max() > 1e-3


@pytest.mark.slow
@pytest.mark.parametrize(("parameter", "size"), [("down", 0.3), ("ahead", 0.3)])
def test_it_is_named(parameter: str, size: float):
    found = diagnose([own((f"thruster_place:{parameter}={size}",), 5, 200.0)], merlin())
    assert found.causes and found.causes[0].effect == "thruster_place"
    told = found.causes[0].parameters[parameter]
    assert told.low <= size <= told.high
