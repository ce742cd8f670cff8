"""A tool on an arm, by closed forms and against a body of two parts that keeps its momentum."""

from __future__ import annotations

import numpy as np
import plant_cases as cases
import pytest

from rovval.core.channels import AXES
from rovval.effects.lanes import nominal
from rovval.effects.library import moving_tool
from rovval.plant import Inputs, Plant, parse_settings

LEVEL = {"r33": np.ones(1)} | dict.fromkeys(("ur", "vr", "wr", "p", "q", "r", "r31", "r32"), np.zeros(1))


def force(t: float, motion: dict[str, np.ndarray] | None = None, **values: float) -> list[float]:
    """Force and moment of the tool on a level Merlin at a time."""
    p = {q.name: np.array([values.get(q.name, q.null)]) for q in moving_tool.EFFECT.parameters}
    own = moving_tool.rows(nominal(cases.merlin()), p)
    return [float(f[0]) for f in moving_tool.wrench(**own, **(LEVEL | (motion or {})), t=np.array([t]))]


def test_a_tool_s_weight_acts_where_the_arm_is():
    """A quarter of a period in it is out: 30 N at 1.5 m ahead pitch the bow down."""
    assert force(5.0, weight=30.0, x=1.0, swing=0.5, period=20.0) == pytest.approx([0, 0, 30.0, 0, -45.0, 0], abs=1e-9)


def test_a_tool_is_slowed_by_the_water_that_it_meets_itself():
    """1/2 rho A v^2 on its lever; an arm that swings ahead as fast as the hull falls back stands in the water."""
    slow = force(0.0, {"ur": np.full(1, 0.8)}, area=0.5, z=1.0)
    assert slow == pytest.approx([-0.5 * 1025.0 * 0.5 * 0.64, 0, 0, 0, -0.5 * 1025.0 * 0.5 * 0.64, 0])
    assert force(0.0, {"ur": np.full(1, -2 * np.pi * 0.5 / 10.0)}, area=0.5, swing=0.5, period=10.0) == pytest.approx([0.0] * 6, abs=1e-9)


def test_a_mass_that_is_pushed_ahead_pushes_back_and_turns_the_hull():
    assert force(2.5, mass=40.0, swing=0.5, period=10.0)[0] == pytest.approx(40.0 * 0.5 * (2 * np.pi / 10.0) ** 2)
    speed = 2 * np.pi * 0.5 / 10.0
    turning = force(0.0, {"r": np.full(1, 0.3), "q": np.full(1, 0.1)}, mass=40.0, swing=0.5, period=10.0, x=1.0)
    assert turning[1:3] == pytest.approx([-2 * 40.0 * speed * 0.3, 2 * 40.0 * speed * 0.1])


def test_hull_and_tool_keep_their_common_momentum():
    """In water without drag the hull goes back as the arm goes ahead: M du = -m ds/dt, with added mass in M."""
    merlin = cases.changed(cases.merlin(), linear_drag=(0.0,) * 6, quadratic_drag=(0.0,) * 6, volume=2936.0 / 1025.0)
    plant = Plant(merlin)
    beta = parse_settings(plant, ["moving_tool:mass=100,swing=1,period=12"])
    out = plant.simulate(Inputs(0.1, np.zeros((121, 7)), True), np.zeros(1, int), 120, np.zeros((1, 6)), np.array([[0, 0, 20.0, 0, 0, 0]]), beta[None])
    t, rate = 0.1 * np.arange(121), 2 * np.pi / 12.0
    expected = 100.0 / (2936.0 + 1468.0) * rate * (1.0 - np.cos(rate * t))  # the arm moves already at the first sample, when the hull still lies still
    assert out.nu[0, :, AXES.index("surge")] == pytest.approx(expected, abs=1e-6)
