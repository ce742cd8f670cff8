"""The equivalent wrench: acting as a force that nobody logged, it does what the effect does."""

from __future__ import annotations

import numpy as np
import pytest
from diagnose_case import merlin, own

from rovval.diagnose.residuals.equivalent_wrench import equivalent_wrench
from rovval.diagnose.residuals.external_forces import wrench_sensitivities
from rovval.diagnose.residuals.sensitivities import residual
from rovval.diagnose.windows.multiple_shooting import cut
from rovval.plant import parse_settings

ALIKE, SIZE = 0.995, 0.15  # correlation and relative size at least: a force of given course acts on a motion that it has changed itself


@pytest.mark.parametrize(
    "effect",
    [
        "quadratic_drag[surge]:scale=0.3", "added_mass[sway]:scale=0.2", "thruster_degraded[VAC]:loss=0.2", "thrust_lag:tau=0.3", "rpm_scale:scale=-0.05",
        "current_constant:north=0.05", "buoyancy_error:force=20", "cg_offset:x=0.005", "tether_tension:north=10,east=5",
    ],
)  # fmt: skip
def test_a_wrench_does_what_the_effect_does(effect: str):
    windows = cut([own()], merlin(), "fossen", 10.0)[0][0]
    without = parse_settings(windows.plant, ())
    beta = parse_settings(windows.plant, (effect,))
    truly = residual(windows, without)[0] - residual(windows, beta)[0]
    wrench = equivalent_wrench(windows, beta, without)
    found = wrench_sensitivities(windows, without, 1, lambda _: wrench)[..., 0]
    a, b = truly[windows.ok], found[windows.ok]
    assert a @ b > ALIKE * np.linalg.norm(a) * np.linalg.norm(b)
    assert np.linalg.norm(b) == pytest.approx(np.linalg.norm(a), rel=SIZE)


def test_nothing_is_done_by_nothing():
    windows = cut([own()], merlin(), "fossen", 10.0)[0][0]
    without = parse_settings(windows.plant, ())
    assert not equivalent_wrench(windows, without, without).any()
