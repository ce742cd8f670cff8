"""Lift of the hull."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from diagnose_case import foreign, merlin, own

from rovval.diagnose import diagnose
from rovval.effects.library.hull_lift import wrench


def test_a_hull_alike_at_both_ends_is_its_own_mirror_image():
    """Ahead and astern turned round, the force across stays and its moment changes sign: it acts at the end that meets the water first."""
    ahead = np.array(wrench(3.0, 2.0, 0.4, 1.0, 0.0, 0.7, 0.3, -0.2), dtype=float)
    astern = np.array(wrench(3.0, 2.0, 0.4, 1.0, 0.0, -0.7, 0.3, -0.2), dtype=float)
    assert ahead[:3] == pytest.approx([0.0, -3.0 * 0.7 * 0.3, 2.0 * 0.7 * 0.2])
    assert ahead[3:] == pytest.approx([0.0, -0.4 * ahead[2], 0.4 * ahead[1]])
    assert astern == pytest.approx(ahead * [1, 1, 1, 1, -1, -1])


def test_the_standard_equations_are_products_of_velocities():
    rng = np.random.default_rng(0)
    for u, v, w in rng.normal(size=(5, 3)):
        assert np.array(wrench(3.0, 2.0, 0.4, 0.0, 1.0, u, v, w)) == pytest.approx(
            [0.0, -3.0 * u * v, -2.0 * u * w, 0.0, 0.4 * 2.0 * u * w, -0.4 * 3.0 * u * v]
        )


@pytest.mark.slow
def test_another_plant_s_lift_is_named_whichever_way_it_goes(tmp_path: Path):
    """Its force goes with u v and u w, ahead and astern."""
    cause, *_ = diagnose([foreign(tmp_path, (("body_lift", "", 1.3),), 31)], merlin()).causes
    assert cause.effect == "hull_lift" and cause.probability > 0.9
    assert cause.parameters["astern"].value == pytest.approx(-1.0, abs=0.2)


@pytest.mark.slow
def test_it_is_named_with_its_size():
    [cause] = diagnose([own(("hull_lift:sway=0.6,heave=0.3,x=0.1",), 3, 300.0)], merlin()).causes
    assert cause.effect == "hull_lift" and cause.parameters["sway"].low < 0.6 < cause.parameters["sway"].high
