"""Where the plant stops a lane, and what its second platform leaves out."""

from __future__ import annotations

from functools import partial

import numpy as np
import plant_cases as cases
import pytest

from rovval.plant import Inputs, Plant
from rovval.plant.reference import plant as oracle


def test_a_lane_that_leaves_sane_limits_stops_with_reason_and_time():
    """Its neighbours go on, and no NaN is left behind."""
    plant = Plant(cases.merlin())
    speed = np.zeros((101, 7))
    speed[50:] = 500.0
    out = plant.simulate(Inputs(0.1, speed, True), np.array([0, 0]), 100, np.zeros((2, 6)), np.zeros((2, 6)), np.tile(plant.null, (2, 1)))
    assert (out.stopped > 50).all() and (out.stopped < 60).all()
    assert ("m/s" in out.why[0] or "rad/s" in out.why[0]) and "lane 0 stopped at 5." in out.why[0]
    assert np.isfinite(out.nu).all()
    assert (out.nu[0, out.stopped[0] :] == out.nu[0, out.stopped[0] - 1]).all()


@pytest.mark.parametrize(("hold", "last"), [(True, 30), (False, 29)])
def test_a_lane_stops_where_thruster_speed_is_missing(hold, last):
    plant = Plant(cases.merlin())
    speed = np.ones((101, 7))
    speed[30, 2] = np.nan
    out = plant.simulate(Inputs(0.1, speed, hold), np.array([0, 40]), 50, np.zeros((2, 6)), np.zeros((2, 6)), np.tile(plant.null, (2, 1)))
    assert out.stopped.tolist() == [last + 1, -1]
    assert out.why == (f"lane 0 stopped at {(last + 1) / 10:.1f} s: thruster speed missing in the log",)
    assert np.isfinite(out.nu).all()


def test_a_load_that_is_set_down_takes_inertia_with_it_and_never_all_of_it():
    """A push astern moves the lighter vehicle more; a mass taken from so far out that nothing is left to turn stops the lane when it goes, in the kernel and
    in its oracle, and the lane beside it goes on."""
    plant = Plant(cases.merlin())
    beta = np.tile(plant.null, (3, 1))
    at = {name: plant.index[f"payload_change.{name}"] for name in ("mass", "onset", "x")}
    beta[:, at["onset"]], beta[1, at["mass"]], beta[2, [at["mass"], at["x"]]] = 1.0, -300.0, (-1000.0, 3.0)
    inputs, zero = Inputs(0.1, np.tile([3.0, 3.0, 0, 0, 0, 0, 0], (60, 1)), True), np.zeros((3, 6))
    for simulate in (plant.simulate, partial(oracle.simulate, plant)):
        out = simulate(inputs, np.zeros(3, int), 50, zero, zero, beta)
        assert out.stopped.tolist() == [-1, -1, 11]
        assert np.allclose(out.nu[0, :11], out.nu[1, :11], rtol=0, atol=1e-15)
        assert 1.01 < (out.nu[1, 20, 0] - out.nu[1, 10, 0]) / (out.nu[0, 20, 0] - out.nu[0, 10, 0]) < 1.2
    assert plant.simulate(inputs, np.zeros(3, int), 50, zero, zero, beta).why == ("lane 2 stopped at 1.1 s: the payload that was set down leaves no inertia",)


def test_freefloating_has_no_added_mass_and_no_linear_drag():
    """Thesis 2.1 and 2.3: at the first instant the acceleration is T / m; slow motion does not decay."""
    neutral = cases.changed(cases.merlin(), volume=2936.0 / 1025.0)
    fossen, free = Plant(neutral), Plant(neutral, "freefloating")
    nu = [1e-4, 0, 0, 0, 0, 0]
    a, b = (cases.run(p, seconds=10.0, nu=nu).nu[0, -1, 0] for p in (fossen, free))
    assert a == pytest.approx(1e-4 * np.exp(-150.0 / 4404.0 * 10), rel=1e-3)
    assert b == pytest.approx(1e-4, rel=1e-3)
