"""White noise of a channel, and the steps in which it is written."""

from __future__ import annotations

import numpy as np
import pytest
from diagnose_case import own, with_values

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
