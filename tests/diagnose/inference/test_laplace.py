"""Laplace evidence."""

from __future__ import annotations

import numpy as np
from diagnose_case import posed

from rovval.diagnose.inference.laplace import resampled_evidence
from rovval.diagnose.inference.map_fit import map_fit


def test_evidence_is_linear_in_copies_of_the_log_but_for_the_prior():
    p = posed(("inflow_loss:loss=0.3",), seconds=100.0)[0]
    point = map_fit(p, p.origin, ())
    one, two = resampled_evidence(p, point, np.stack([np.ones(p.window_count), 2 * np.ones(p.window_count)]))
    assert two > one, "twice the data says the same louder"
