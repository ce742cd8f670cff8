"""A simulated vehicle that flies out of the water, or through the logged bottom, is told; one that stays in it is not."""

from __future__ import annotations

import numpy as np
import pytest

from rovval import vehicle
from rovval.alignment import align
from rovval.core.data import RawLog, Run, Series
from rovval.simulation import simulate
from rovval.vehicle.model import Vehicle

SECONDS = 40.0


def at_rest(rov: Vehicle, depth: float, altitude: float | None = None) -> Run:
    """A log of a vehicle that hangs still with its thrusters stopped."""
    t = np.arange(round(SECONDS * 10) + 1) / 10
    values = dict.fromkeys(("u", "v", "w", "p", "q", "r", "phi", "theta", "psi", *(f"n:{n}" for n in rov.thrusters)), 0.0) | {"z": depth}
    values |= {} if altitude is None else {"altitude": altitude}
    return align(RawLog("x.csv", "ab" * 32, "test", rov.name, None, {n: Series(t, np.full(len(t), v), "row") for n, v in values.items()}))


def trimmed(times: float) -> Vehicle:
    rov = vehicle.load("bluerov2_heavy")
    return rov.model_copy(update={"body": rov.body.model_copy(update={"volume": times * rov.body.volume})})


@pytest.mark.parametrize(("times", "altitude", "words"), [(1.2, None, "above the surface"), (0.8, 1.0, "below the bottom")])
def test_a_simulation_that_leaves_the_water_says_so(times, altitude, words):
    rov = trimmed(times)
    assert any(words in a for a in simulate(at_rest(rov, 3.0, altitude), rov).assumptions)


def test_with_a_surface_or_a_bottom_it_stays_in_the_water_and_nothing_is_said():
    light, heavy = trimmed(1.2), trimmed(0.8)
    floats = simulate(at_rest(light, 3.0), light, effects=("free_surface:share=1",))
    lies = simulate(at_rest(heavy, 3.0, 1.0), heavy, effects=("seabed:firmness=1,depth=4",))
    for sim in (floats, lies):
        assert sim.free.ok.all() and not any("--effect" in a for a in sim.assumptions)
    assert floats.free.eta[-1, 2] > -0.13 and lies.free.eta[-1, 2] < 4.0
