"""The current that the wind drives, by its closed form."""

from __future__ import annotations

import numpy as np
import plant_cases as cases
import pytest

from rovval.effects.lanes import nominal
from rovval.effects.library import wind_current
from rovval.plant import Inputs, Plant, parse_settings


def test_the_current_is_two_per_cent_of_the_wind_at_the_surface_and_nothing_at_its_reach():
    p = {q.name: np.array([{"north": 10.0}.get(q.name, q.null)]) for q in wind_current.EFFECT.parameters}
    own = wind_current.rows(nominal(cases.merlin()), p)
    at = {z: wind_current.water(**own, z=np.array([z]), vd=np.array([0.5])) for z in (0.0, 25.0, 50.0, 80.0)}
    assert [float(v[0][0]) for v in at.values()] == pytest.approx([0.2, 0.1, 0.0, 0.0], abs=1e-9)
    assert at[25.0][3][0] == pytest.approx(-0.2 * 0.5 / 50.0) and at[80.0][3][0] == 0.0


def test_a_vehicle_near_the_surface_is_carried_with_the_wind_and_one_below_its_reach_is_not():
    """At 5 m of 50 m a wind of 10 m/s to the east moves the water with 0.18 m/s, and in the end the vehicle, too."""
    plant = Plant(cases.changed(cases.merlin(), volume=2936.0 / 1025.0))
    beta = np.tile(parse_settings(plant, ["wind_current:east=10"]), (2, 1))
    eta = np.array([[0, 0, 5.0, 0, 0, 0], [0, 0, 60.0, 0, 0, 0]])
    out = plant.simulate(Inputs(0.1, np.zeros((1201, 7)), True), np.zeros(2, int), 1200, np.zeros((2, 6)), eta, beta)
    assert out.nu[:, -1, 1] == pytest.approx([0.18, 0.0], abs=0.02)
