"""A depth sensor that reads wrong."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from diagnose_case import foreign, merlin, own

from rovval.diagnose import diagnose
from rovval.effects.library.depth_error import observe, unobserve
from rovval.effects.log import Log


def test_the_port_of_a_stream_reads_its_dynamic_pressure_as_depth():
    """Bernoulli: at 2 m/s a port that faces the stream reads 2^2 / (2 g) = 0.204 m deeper; fresh water taken for salt reads 2.7 % shallower."""
    nu, eta = np.zeros((1, 2, 6)), np.zeros((1, 2, 6))
    nu[..., 0], eta[..., 2] = 2.0, 10.0
    log = observe(Log(nu, eta, 0.1, nu[:, 0], eta[:, 0]), {"scale": np.array([-0.027]), "pressure": np.array([1.0])})
    assert log.eta[0, :, 2] == pytest.approx(9.73 + 0.2039, abs=1e-3) and np.array_equal(log.nu, nu)
    assert unobserve(nu[:, 0], log.eta[:, 0], {"scale": np.array([-0.027]), "pressure": np.array([1.0])})[1][0, 2] == pytest.approx(10.0)


@pytest.mark.slow
def test_another_plant_s_depth_sensor_is_named_with_its_factor(tmp_path: Path):
    """A scale of 0.06 times 1.3, and a port that sees the flow."""
    [cause] = diagnose([foreign(tmp_path, (("depth_port_error", "", 1.3),), 6012)], merlin()).causes
    assert cause.effect == "depth_error" and cause.probability > 0.9
    assert cause.parameters["scale"].value == pytest.approx(0.078, abs=0.01)


@pytest.mark.slow
def test_a_velocity_log_s_factor_is_not_told_as_this():
    assert [c.effect for c in diagnose([own(("dvl_scale:scale=0.08",), 3, 300.0)], merlin()).causes] == ["dvl_scale"]


@pytest.mark.slow
def test_feet_are_told_as_a_factor():
    [cause] = diagnose([own(("depth_error:scale=2.28",), 3, 200.0)], merlin()).causes
    assert cause.effect == "depth_error" and cause.parameters["scale"].value == pytest.approx(2.28, abs=0.1)
