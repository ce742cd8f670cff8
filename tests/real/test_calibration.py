"""Tank runs of a BlueROV2, one left out at a time: the vehicle calibrated on two predicts the third better than a published simulator."""

from __future__ import annotations

import functools

import numpy as np
import pytest
from knock_outs import RUNS, calibrated, tank
from real_data import real

from rovval.simulation import simulate
from rovval.storage.archive import open_run

pytestmark = pytest.mark.real


@functools.cache
def ratios(left_out: str) -> tuple[float, ...]:
    """Mean absolute error of the free run in surge, sway and heave over that of the authors' Unity simulator, on the rows that all have."""
    unity, run = open_run(real(f"bluerov2_tank/run_{left_out}.sim.csv")), open_run(tank(left_out))
    ours = simulate(run, calibrated(left_out))
    assert not ours.stops
    out = []
    for axis, channel in enumerate("uvw"):
        rows = run.ok(channel) & unity.ok(channel) & ours.free.ok
        assert rows.mean() > 0.98
        measured = run.get(channel)[rows]
        mine, theirs = (np.abs(x - measured).mean() for x in (ours.free.nu[rows, axis], unity.get(channel)[rows]))
        out.append(float(mine / theirs))
    print(f"run {left_out}: " + ", ".join(f"{name} {x:.2f}" for name, x in zip(("surge", "sway", "heave"), out, strict=True)), "of Unity's error")
    return tuple(out)


@pytest.mark.parametrize("left_out", RUNS)
def test_a_run_left_out_is_predicted_better_than_by_the_published_simulator(left_out: str):
    assert max(ratios(left_out)) < 1.0


def test_most_axes_are_below_three_fifths_of_its_error():
    found = np.array([ratios(name) for name in RUNS]).ravel()
    assert (found < 0.6).sum() >= 7
    assert found.mean() < 0.48
