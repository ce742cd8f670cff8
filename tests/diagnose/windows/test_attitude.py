"""Attitude of runs that tumble, as a diagnosis sees it: no jump in its residuals, none in its noise."""

from __future__ import annotations

import numpy as np
import pytest
from diagnose_case import NOISE, own
from tumbling import bluerov2, tumbling

from rovval.core.frames import tilt_difference
from rovval.diagnose.residuals.sensitivities import linearise, residual
from rovval.diagnose.windows.attitude import tilted
from rovval.diagnose.windows.attitude import tumbling as tumbles
from rovval.diagnose.windows.multiple_shooting import cut


def test_the_vehicle_of_these_tests_goes_over_and_hangs_upside_down():
    run = tumbling()
    assert np.abs(run.get("theta")).max() > np.radians(80.0)
    assert (np.cos(run.get("phi")) < 0.0).mean() > 0.2
    assert tumbles(run)
    assert not tumbles(own(seconds=60.0))


def test_a_healthy_vehicle_that_tumbles_leaves_no_more_than_noise():
    [windows], _ = cut([tumbling()], bluerov2(), "fossen", 10.0)
    error, fine = residual(windows, windows.plant.null)
    assert fine.all()
    at = [windows.channels.index(c) for c in ("phi", "theta")]
    assert np.abs(windows.noise[at] / NOISE["phi"] - 1.0).max() < 2.5  # the estimate takes a part of a violent motion for noise
    assert np.abs(error[..., at]).max() < 0.015
    assert np.sqrt((error[..., at] ** 2).mean()) < 4 * NOISE["phi"]


def test_sensitivities_to_the_start_have_no_jump():
    """A window's attitude at its start shows in its attitude by about as much, however it stands."""
    [windows], _ = cut([tumbling()], bluerov2(), "fossen", 10.0)
    J = linearise(windows, windows.plant.null, ()).J
    of, at = (6, 7), [windows.channels.index(c) for c in ("phi", "theta")]
    assert np.abs(J[:, :20][..., at, :][..., of]).max() < 2.5


@pytest.mark.parametrize("euler", [(0.0, 0.0, 1.0), (0.4, np.pi / 2, 0.2), (3.0, -np.pi / 2, 0.0), (np.pi, 0.3, 2.0), (np.pi / 2, 0.0, 0.0)])
def test_two_tilts_span_all_directions_of_the_vertical(euler: tuple[float, float, float]):
    at = np.array([[0.0, 0.0, 0.0, *euler]])
    a, b = (tilt_difference(tilted(at, *by)[:, 3:], at[:, 3:])[0] for by in ((0.01, 0.0), (0.0, 0.01)))
    np.testing.assert_allclose([np.linalg.norm(a), np.linalg.norm(b), a @ b], [0.01, 0.01, 0.0], atol=1e-6)
