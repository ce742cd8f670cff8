"""Gyros that read too much or too little."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from diagnose_case import foreign, merlin, own, with_values

from rovval.diagnose import diagnose
from rovval.effects.library.gyro_scale import observe, unobserve
from rovval.effects.log import Log


def test_what_is_logged_is_the_rate_times_its_factor_and_back():
    nu, eta, p = np.ones((1, 2, 6)), np.zeros((1, 2, 6)), {"p": np.array([0.1]), "q": np.array([0.0]), "r": np.array([-0.2])}
    log = observe(Log(nu, eta, 0.1, nu[:, 0], eta[:, 0]), p)
    assert log.nu[0, 0] == pytest.approx([1.0, 1.0, 1.0, 1.1, 1.0, 0.8])
    assert unobserve(log.nu[:, 0], eta[:, 0], p)[0] == pytest.approx(nu[:, 0])


@pytest.mark.slow
def test_a_yaw_gyro_of_another_plant_that_reads_too_much_is_named_with_its_factor(tmp_path: Path):
    run = foreign(tmp_path, (), 31, 300.0)
    [cause] = diagnose([with_values(run, r=1.06 * run.get("r"))], merlin()).causes
    assert cause.effect == "gyro_scale" and cause.probability > 0.9
    assert cause.parameters["r"].value == pytest.approx(0.06, abs=0.01)


@pytest.mark.slow
def test_a_bias_is_not_told_as_this():
    assert [c.effect for c in diagnose([own(("gyro_bias:r=0.02",), 3, 300.0)], merlin()).causes] == ["gyro_bias"]
