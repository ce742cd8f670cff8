"""What of the gap needs no cause."""

from __future__ import annotations

import pytest

from rovval.diagnose.decision.unexplained import Accounted


@pytest.mark.parametrize(("departure", "share"), [(0.0, 0.3), (4.9, 0.3), (6.6, 0.04)])
def test_tolerance_accounts_for_a_gap_only_at_its_stated_size(departure: float, share: float):
    assert Accounted(noise=0.04, tolerance=0.26, departure=departure).share == pytest.approx(share)
