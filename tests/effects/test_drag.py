"""Drag that a file leaves out, or has far too small, can be told in full, and what is there can be taken away and no more."""

from __future__ import annotations

import numpy as np
import pytest

from rovval import vehicle
from rovval.core.channels import AXES
from rovval.effects.lanes import nominal, reference_drag, reference_drag_force
from rovval.effects.library import linear_drag, quadratic_drag
from rovval.vehicle.model import Vehicle, as_matrix


def with_surge_drag(share: float) -> tuple[Vehicle, Vehicle]:
    """A BlueROV2 as its file has it, and with that share of its drag ahead."""
    whole = vehicle.load("bluerov2_heavy")
    body = whole.body
    keep = np.array([share, 1.0, 1.0, 1.0, 1.0, 1.0])
    drag = {name: tuple((keep * np.diag(as_matrix(getattr(body, name)))).tolist()) for name in ("linear_drag", "quadratic_drag")}
    return whole, whole.model_copy(update={"body": body.model_copy(update=drag)})


@pytest.mark.parametrize("share", [0.0, 0.05, 0.2])
@pytest.mark.parametrize(("effect", "part"), [(linear_drag, 0), (quadratic_drag, 1)])
def test_a_drag_that_is_nearly_missing_is_given_back_within_the_bounds(effect, part, share):
    whole, less = with_surge_drag(share)
    name = ("linear_drag", "quadratic_drag")[part]
    true = np.diag(as_matrix(getattr(whole.body, name)))[0]
    missing = true - np.diag(as_matrix(getattr(less.body, name)))[0]
    scale = missing / reference_drag(less)[part][0]
    [parameter] = effect.EFFECT.parameters
    assert 0.0 < scale < min(parameter.high, 10.0 * parameter.typical)
    p = {"scale": np.where(np.array(AXES) == "surge", scale, 0.0)[None]}
    assert getattr(effect.lower(nominal(less), p), name)[0, 0, 0] == pytest.approx(true)


@pytest.mark.parametrize("share", [0.05, 0.2, 1.0])
@pytest.mark.parametrize("effect", [linear_drag, quadratic_drag])
def test_no_more_of_a_drag_is_taken_away_than_there_is(effect, share):
    _, less = with_surge_drag(share)
    lanes = nominal(less)
    p = {"scale": np.full((1, 6), effect.EFFECT.parameters[0].low)}
    before, after = (np.diagonal(getattr(x, effect.EFFECT.name)[0]) for x in (lanes, effect.lower(lanes, p)))
    assert (after[before > 0] > 0).all() and (after[before > 0] < before[before > 0]).all()


def test_the_drag_ahead_of_published_vehicles_is_their_own():
    """It sizes priors and bounds: one axis of a file alone must not shrink them all."""
    whole, less = with_surge_drag(0.05)
    assert reference_drag_force(whole) == pytest.approx(141.0 + 13.7)
    assert reference_drag_force(less) == pytest.approx(217.0 / 3.0, rel=0.15)
