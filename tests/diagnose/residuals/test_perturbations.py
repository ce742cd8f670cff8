"""The plan of finite differences."""

from __future__ import annotations

import numpy as np
import pytest
from diagnose_case import posed, slot

from rovval import effects
from rovval.diagnose.hypotheses.hypothesis import columns_of
from rovval.diagnose.residuals import perturbations as lanes
from rovval.diagnose.residuals.perturbations import perturbations
from rovval.diagnose.residuals.sensitivities import linearise, residual
from rovval.plant.sensors import moves_the_vehicle


def test_where_nothing_is_there_yet_the_nominal_simulation_serves(monkeypatch: pytest.MonkeyPatch):
    """To the last digit: onsets, periods, depths, levers of effects of no size; once there is a size, the place counts."""
    p, library = posed()
    part, asked = p.runs[0], columns_of(library)
    columns, directions = tuple(sorted({*asked.slots, *p.tolerance.sd})), asked.displaced
    beta = p.origin.copy()
    beta[slot(p, "payload_change.weight")] = 50.0
    lean, few = linearise(part, beta, columns, directions), len(perturbations(part, beta, [], columns, directions))
    monkeypatch.setattr(lanes, "_unchanged", lambda *known: set())
    whole, all_of_them = linearise(part, beta, columns, directions), len(perturbations(part, beta, [], columns, directions))
    whole_sized = [lean.columns.index(d.id) for d in directions if d.slot < 0]  # simulated alike either way, among other neighbours
    np.testing.assert_array_equal(np.delete(lean.S, whole_sized, axis=-1), np.delete(whole.S, whole_sized, axis=-1))
    np.testing.assert_allclose(lean.S, whole.S, rtol=0.0, atol=1e-16, err_msg="of these the last digit may be another")
    assert few < 0.9 * all_of_them


def test_a_clock_s_offset_has_the_slope_of_both_sides():
    """The thrusters' log is linear between samples: at no offset its slope is another on either side, by a share of itself that no one-sided step shows."""
    p, _ = posed(seconds=100.0)
    part, tau = p.runs[0], slot(p, "time_offset.tau")
    ahead, behind = p.origin.copy(), p.origin.copy()
    ahead[tau], behind[tau] = 0.05, -0.05
    both = (residual(part, behind)[0] - residual(part, ahead)[0]) / 0.1  # of what is predicted
    coarse = linearise(part, p.origin, (), coarse=(tau,))
    seen = part.ok & coarse.valid[:, None, None]
    np.testing.assert_allclose(coarse.S[..., 0][seen], both[seen], rtol=1e-6, atol=1e-9)
    one_sided = (residual(part, p.origin)[0] - residual(part, ahead)[0]) / 0.05
    assert np.abs(one_sided - both)[seen].max() > 0.01 * np.abs(both[seen]).max()


def test_only_clocks_of_the_thrusters_move_the_vehicle_among_what_sensors_do():
    p, _ = posed(seconds=100.0)
    sensors = [one for one in p.plant.slots if effects.load(one.effect).place == "sensor"]
    assert {one.key for one in sensors if moves_the_vehicle(one)} == {"time_offset.tau", "clock_drift.rate"}
