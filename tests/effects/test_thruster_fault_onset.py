"""A thruster that fails during the log."""

from __future__ import annotations

import numpy as np
import pytest

from rovval import vehicle
from rovval.core.errors import UsageProblem
from rovval.effects.library.thruster_fault_onset import static
from rovval.plant import Plant, parse_settings


def test_it_is_sound_before_and_loses_its_share_after():
    t = np.array([0.0, 9.9, 10.05, 10.2, 60.0])
    np.testing.assert_allclose(static(np.full(5, 0.4), np.full(5, 10.0), np.full(5, -50.0), t), [-50.0, -50.0, -40.0, -30.0, -30.0])


def test_one_that_gets_stronger_has_not_failed():
    with pytest.raises(UsageProblem, match=r"thruster_fault_onset\[HFP\]\.loss = -0.1, allowed 0 to 1"):
        parse_settings(Plant(vehicle.load("merlin")), ["thruster_fault_onset[HFP]:loss=-0.1,onset=5"])
