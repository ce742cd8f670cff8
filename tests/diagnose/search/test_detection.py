"""Detection: false alarms at the stated rate, and a cause that is there is seen."""

from __future__ import annotations

import numpy as np

from rovval.diagnose.residuals.normal_equations import NormalEquations
from rovval.diagnose.residuals.ridge import Prior
from rovval.diagnose.search.detection import detect

RNG = np.random.default_rng


def test_detection_is_calibrated_on_its_own_null():
    """Logs with coefficients within tolerance and white noise, 80 of them: false alarms at the stated rate (loose), none systematic."""
    rng, m, k, p_values = RNG(10), 30, 8, []
    tolerance, wide = Prior({0: 0.05, 1: 0.05, 2: 0.05}), {f"h{i}": Prior({i: 2.0}) for i in range(3, k)}
    for _ in range(80):
        S = rng.normal(size=(m, 20, k)) + rng.normal(size=(m, 1, k))
        delta = np.concatenate([0.05 * rng.normal(size=3), np.zeros(k - 3)])
        r = S @ delta + rng.normal(size=(m, 20))
        data = NormalEquations(np.einsum("wni,wnj->wij", S, S), np.einsum("wni,wn->wi", S, r), (r**2).sum(axis=1), tuple(range(k)))
        everything = np.linalg.solve(data.A.sum(axis=0), data.b.sum(axis=0))
        found = detect(data, tolerance, tolerance, wide, 1.0, everything, int(rng.integers(1 << 30)))
        p_values.append(found.p_value(found.best))
    p = np.array(p_values)
    assert (p <= 0.05).mean() <= 0.125  # 0.05 expected, three standard errors
    assert (p <= 0.2).mean() <= 0.35
    assert p.min() > 0.004


def test_detection_sees_what_is_there():
    rng, m, k = RNG(11), 30, 5
    S = rng.normal(size=(m, 20, k))
    r = S @ np.array([0, 0, 0, 0.5, 0]) + rng.normal(size=(m, 20))
    data = NormalEquations(np.einsum("wni,wnj->wij", S, S), np.einsum("wni,wn->wi", S, r), (r**2).sum(axis=1), tuple(range(k)))
    tolerance = Prior({0: 0.05})
    everything = np.linalg.solve(data.A.sum(axis=0), data.b.sum(axis=0))
    found = detect(data, tolerance, tolerance, {"true": Prior({3: 2.0}), "other": Prior({4: 2.0})}, 1.0, everything, 0)
    assert found.best == "true"
    assert found.p_value("true") < 0.01
