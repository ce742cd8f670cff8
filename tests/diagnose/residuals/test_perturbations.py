"""The plan of finite differences."""

from __future__ import annotations

import numpy as np
import pytest
from diagnose_case import posed, slot

from rovval.diagnose.hypotheses.hypothesis import columns_of
from rovval.diagnose.residuals import perturbations as lanes
from rovval.diagnose.residuals.perturbations import perturbations
from rovval.diagnose.residuals.sensitivities import linearise


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
