"""Laplace evidence."""

from __future__ import annotations

import numpy as np
from diagnose_case import posed

from rovval.diagnose.inference.laplace import evidence
from rovval.diagnose.inference.map_fit import settle


def test_evidence_is_linear_in_copies_of_the_log_but_for_the_prior():
    p = posed(("inflow_loss:loss=0.3",), seconds=100.0)[0]
    point = settle(p, p.origin, ())
    one, two = evidence(p, point, np.stack([np.ones(p.blocks), 2 * np.ones(p.blocks)]))
    assert two > one, "twice the data says the same louder"
