"""ArduSub's frames as AP_Motors6DOF.cpp prints them, and the library's vehicles that fly with one."""

from __future__ import annotations

import numpy as np
import pytest

from rovval import vehicle
from rovval.core.channels import AXES
from rovval.vehicle.ardusub import FRAMES, factors
from rovval.vehicle.model import allocation

VECTORED_6DOF = """
0 0 1 0 -1 1
0 0 -1 0 -1 -1
0 0 -1 0 1 1
0 0 1 0 1 -1
1 -1 0 -1 0 0
-1 -1 0 -1 0 0
1 1 0 -1 0 0
-1 1 0 -1 0 0
"""  # roll pitch yaw throttle forward lateral; a row is a motor
FLOWN = [name for name in vehicle.names() if (mixer := vehicle.load(name).mixer) is not None and mixer.frame]


def test_the_tables_are_the_published_ones():
    assert np.array_equal(FRAMES["vectored_6dof"], np.loadtxt(VECTORED_6DOF.splitlines()))
    assert np.array_equal(FRAMES["vectored"][:4], FRAMES["vectored_6dof"][:4])
    assert FRAMES["vectored"][4:] == ((1, 0, 0, -1, 0, 0), (-1, 0, 0, -1, 0, 0))


def test_throttle_up_is_heave_up():
    assert factors("vectored")["heave"] == (0.0, 0.0, 0.0, 0.0, 1.0, 1.0)
    assert "pitch" not in factors("vectored"), "no motor of it pitches"


@pytest.mark.parametrize("name", FLOWN)
def test_a_stick_of_a_library_vehicle_drives_its_own_axis_by_every_motor_it_has(name: str):
    """With the published factors, so that the sign of each direction is the firmware's and not the file's."""
    loaded = vehicle.load(name)
    assert loaded.mixer is not None and loaded.mixer.frame is not None
    wrench = allocation(loaded)
    for stick, row in factors(loaded.mixer.frame).items():
        driven = np.array(row) != 0
        assert (np.array(row)[driven] * wrench[AXES.index(stick), driven] > 0.05).all(), stick


def test_some_vehicle_flies_with_a_published_frame():
    assert FLOWN == ["bluerov2", "bluerov2_heavy"]
