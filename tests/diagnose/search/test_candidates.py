"""Candidates: the points from which hypotheses are fitted by re-simulation."""

from __future__ import annotations

import numpy as np
import pytest
from diagnose_case import posed, slot

from rovval.diagnose.hypotheses.hypothesis import displaced
from rovval.diagnose.residuals.normal_equations import NormalEquations
from rovval.diagnose.search.candidates import start_of


@pytest.mark.parametrize(("before", "after"), [(0.0, np.pi), (np.pi / 2, -np.pi / 2)])
def test_a_negative_amplitude_is_half_a_turn(before: float, after: float):
    p, _ = posed()
    amplitude, phase = slot(p, "waves.amplitude"), slot(p, "waves.phase")
    h = displaced(p.plant, "waves@0", tuple(p.plant.hypotheses["waves"]), (amplitude,), ((phase, before),), 1000)
    data = NormalEquations(np.zeros((1, 1, 1)), np.zeros((1, 1)), np.zeros(1), (1000,))
    start = start_of(p, data, h, np.array([-0.7]), p.origin, h.slots)
    assert start[phase] == pytest.approx(after) and start[amplitude] == pytest.approx(0.7)
