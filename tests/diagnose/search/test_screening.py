"""The screen: what is there promises most, and promises what its fit by re-simulation keeps."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from diagnose_case import posed

from rovval.diagnose.inference.hypothesis_fit import fit_hypothesis
from rovval.diagnose.inference.laplace import heavy_tails, laplace_evidence
from rovval.diagnose.inference.map_fit import healthy_fit, map_fit
from rovval.diagnose.search.screening import linearised, moved_to, screened


def test_a_small_departure_promises_the_evidence_that_it_has():
    """Nearly linear: evidence by Laplace's approximation about the fitted point, in the prior in which effects are fitted, against the one-step answer from
    the healthy vehicle."""
    p, library = posed(("buoyancy_error:force=150",), seconds=100.0)
    healthy = healthy_fit(p)
    promised = screened(p, linearised(p, library, healthy), library, ())
    best = max(library, key=lambda h: promised[h.label])
    there = fit_hypothesis(p, p.origin, best.slots)
    kept = there.evidence - heavy_tails(p, there.posterior) - laplace_evidence(p, healthy)
    assert best.name == "buoyancy_error" and promised[best.label] == pytest.approx(kept, rel=0.05)


def test_nothing_promises_much_on_a_healthy_log():
    p, library = posed(seconds=100.0)
    promised = screened(p, linearised(p, library, healthy_fit(p)), library, ())
    assert max(promised.values()) < 6.0


def test_what_no_window_shows_promises_nothing_to_the_last_bit():
    p, library = posed(seconds=100.0)
    data = linearised(p, library, healthy_fit(p))
    unseen = next(h for h in library if not set(h.columns) & set(p.tolerance.sd))
    at, A, b = data.place(unseen.columns), data.A.copy(), data.b.copy()
    A[:, at], A[:, :, at], b[:, at] = 0.0, 0.0, 0.0
    assert screened(p, replace(data, A=A, b=b), [unseen], ()) == {unseen.label: 0.0}


def test_a_linearisation_serves_near_by_and_is_made_anew_far_away():
    """Beside a cause that is there the library promises the same by the linearisation moved there as by one made there, where the cause adds a steady force;
    where it changes how the thrusters answer, the moved one is refused."""
    for planted, near in (("buoyancy_error:force=-150", True), ("inflow_loss:loss=0.5", False)):
        p, library = posed((planted,), seconds=100.0)
        at_first, cause = linearised(p, library, healthy_fit(p)), next(h for h in library if h.name == planted.partition(":")[0])
        point, others = map_fit(p, p.origin, cause.slots), [h for h in library if h is not cause]
        moved = moved_to(p, at_first, point)
        assert (moved is not None) == near
        if moved:
            there, anew = (screened(p, data, others, cause.slots) for data in (moved, linearised(p, library, point)))
            np.testing.assert_allclose([there[h.label] for h in others], [anew[h.label] for h in others], atol=0.5)
