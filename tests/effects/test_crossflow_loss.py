"""Loss of thrust across a stream."""

from __future__ import annotations

import numpy as np


def test_thrust_across_a_stream_is_lost_and_never_turned_round():
    from rovval.effects.library.crossflow_loss import thrust

    assert thrust(1.0, 100.0, np.array([0.0, 0.5, 1.0, 3.0])).tolist() == [100.0, 50.0, 0.0, 0.0]
