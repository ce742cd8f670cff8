"""Axes that depart as one: the same as each of them by itself, and beside them."""

from __future__ import annotations

import numpy as np
import plant_cases as cases
import pytest

from rovval import effects
from rovval.plant import Plant, parse_settings

GROUPED = [(name, group, members) for name in effects.names() for group, members in effects.load(name).groups.items()]


@pytest.mark.parametrize(("name", "group", "members"), GROUPED)
def test_a_group_is_its_axes_at_once_and_multiplies(name, group, members):
    plant = Plant(cases.merlin())
    asked = (
        [f"{name}[{group}]:scale=0.5"],
        [f"{name}[{axis}]:scale=0.5" for axis in members],
        [f"{name}[{group}]:scale=0.5", f"{name}[{members[0]}]:scale=0.2"],
        [f"{name}[{members[0]}]:scale=0.8", *(f"{name}[{axis}]:scale=0.5" for axis in members[1:])],
    )
    beta = np.array([parse_settings(plant, list(settings)) for settings in asked])
    rng = np.random.default_rng(4)
    nu, eta = (np.tile(x, (len(beta), 1)) for x in cases.random_states(rng, 1))
    out = plant.simulate(cases.random_inputs(rng, plant), np.full(len(beta), 10), 30, nu, eta, beta)
    np.testing.assert_allclose(out.nu[0], out.nu[1], rtol=0, atol=1e-12)
    np.testing.assert_allclose(out.nu[2], out.nu[3], rtol=0, atol=1e-12)
    assert np.abs(out.nu[0] - out.nu[2]).max() > 1e-6


def test_a_group_has_no_tolerance_beside_that_of_its_axes():
    slots = {s.key: s.parameter for s in Plant(cases.merlin()).slots}
    for name, group, members in GROUPED:
        assert slots[f"{name}[{group}].scale"].tolerance is None
        assert all(slots[f"{name}[{axis}].scale"].tolerance is not None for axis in members)
