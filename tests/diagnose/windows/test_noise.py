"""White noise of a channel, and the steps in which it is written."""

from __future__ import annotations

import numpy as np
import pytest
from diagnose_case import own, with_values

from rovval.diagnose.windows.conditioning import condition
from rovval.diagnose.windows.noise import clean_channels, quantisation_step


@pytest.mark.parametrize("step", [0.02, 0.1])
def test_a_channel_in_coarse_steps_is_no_better_than_its_rounding(step: float):
    """A slow vehicle repeats its values, of which no difference shows noise; what rounding really does is measured against the log it was made of."""
    slow = 0.4 * np.sin(0.03 * np.arange(3000) * 0.1 + 0.3)
    coarse = np.round(slow / step) * step
    run = with_values(own((), 5, 300.0), u=coarse)
    _, _, (noise,), _ = clean_channels(run, ("u",))
    assert quantisation_step(coarse) == pytest.approx(step, rel=1e-6)
    assert noise == pytest.approx(np.sqrt(np.mean((coarse - slow) ** 2)), rel=0.2)


def test_values_that_lie_on_no_grid_have_no_grain():
    rng = np.random.default_rng(0)
    assert quantisation_step(rng.normal(size=2000)) == 0.0, "a fine channel"
    assert quantisation_step(np.zeros(2000)) == 0.0, "one that never moves"
    assert quantisation_step(np.repeat(rng.normal(size=200), 10)) == 0.0, "held, but on no grid"


def test_two_values_are_a_step_apart_unless_they_are_the_ends_of_a_range():
    slow = 0.12 * np.sin(0.03 * np.arange(3000) * 0.1)
    assert quantisation_step(np.round(np.minimum(slow, 0.09) / 0.2) * 0.2) == pytest.approx(0.2), "heave of a velocity log in steps of 0.2 m/s"
    fine = 0.3 * np.sin(0.5 * np.arange(3000) * 0.1) + 0.001 * np.random.default_rng(0).normal(size=3000)
    assert quantisation_step(np.clip(fine, -0.25, 0.25)) == 0.0, "a gyro that clips"


def test_coarse_velocities_held_between_pings_are_as_coarse_on_every_axis():
    """Of the heave of a survey two values are in the log, mostly 0: it was read as an end of the sensor's range, and what was left as free of noise."""
    run, step, hold = own((), 5, 300.0), 0.215, 17
    pinged = np.arange(len(run)) // hold * hold
    coarse = {c: np.round(run.get(c)[pinged] / step) * step for c in "uv"} | {"w": np.where(np.sin(pinged / 99.0) < -0.9, -step, 0.0)}
    conditioned, found = condition(with_values(run, **coarse))
    assert [f.code for f in found] == ["held"]
    np.testing.assert_allclose(clean_channels(conditioned, ("u", "v", "w"))[2], step / np.sqrt(12.0))
