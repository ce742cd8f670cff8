"""Trains of waves beside the first."""

from __future__ import annotations

import numpy as np
import plant_cases as cases
import pytest

from rovval.plant import Inputs, Plant, parse_settings


@pytest.mark.parametrize("i", [2, 3])
@pytest.mark.parametrize(("further", "phase"), [("cosine", 0.0), ("sine", -np.pi / 2)])
def test_a_further_train_is_a_wave_like_the_first(i, further, phase):
    """a sin(arg) is a cos(arg - pi/2); deep, moving, and with another train about."""
    plant = Plant(cases.merlin())
    alike = f"waves:amplitude=0.8,period=7,phase={phase},direction=0.6", f"waves:{further}_{i}=0.8,period_{i}=7,direction=0.6"
    beta = np.array([parse_settings(plant, [setting]) for setting in alike])
    nu, eta = np.zeros((2, 6)), np.zeros((2, 6))
    nu[:, 0], nu[:, 2], eta[:, 2] = 0.4, 0.1, 6.0
    out = plant.simulate(Inputs(0.1, np.zeros((101, 7)), False), np.array([0, 0]), 100, nu, eta, beta)
    np.testing.assert_allclose(out.nu[0], out.nu[1], rtol=0, atol=1e-12)
    assert np.abs(np.diff(out.nu[0, :, 2])).max() > 1e-3
