"""Loop gains of an autopilot."""

from __future__ import annotations

import numpy as np
import pytest
from diagnose_case import bare, turned

from rovval import vehicle
from rovval.core.data import Run
from rovval.diagnose.windows.closed_loop import answered_forces, fast_damping, loop_gain, loop_gains, variance_factors
from rovval.diagnose.windows.multiple_shooting import cut_run
from rovval.vehicle.model import allocation


def steadied(gain: float) -> Run:
    """A BlueROV2 that rolls in the swell while its thrusters give ``gain`` times the righting moment against it."""
    v = vehicle.load("bluerov2_heavy")
    n = 1200
    t = 0.1 * np.arange(n)
    roll = 0.1 * np.sin(0.9 * t) * np.cos(0.13 * t)
    righting = v.weight * 0.01
    unit = np.linalg.pinv(allocation(v)) @ np.array([0.0, 0.0, 0.0, -righting, 0.0, 0.0])
    thrust = gain * roll[:, None] * unit
    speed = np.sign(thrust) * np.sqrt(
        np.abs(thrust) / np.where(thrust >= 0, [x.k_pos for x in v.thruster], [x.k_neg for x in v.thruster])
    )
    values = {c: np.zeros(n) for c in ("u", "v", "w", "q", "r", "x", "y", "z", "theta", "psi")}
    values |= {"phi": roll, "p": np.gradient(roll, 0.1)} | {f"n:{x.name}": speed[:, i] / 60.0 for i, x in enumerate(v.thruster)}
    return bare(values, v, f"steadied {gain}")


@pytest.mark.parametrize("gain", [0.0, 2.0, 6.0])
def test_the_gain_of_an_autopilot_is_read_off_the_thrusters(gain: float):
    part = cut_run(steadied(gain), vehicle.load("bluerov2_heavy"), "fossen", 10.0)
    assert loop_gain(part, "phi", "p", 3) == pytest.approx(gain, rel=0.05, abs=0.01)
    assert loop_gain(part, "theta", "q", 4) == 0.0
    found = variance_factors((part,), loop_gains((part,)))
    assert found[part.channels.index("phi")] == pytest.approx((1 + gain) ** 2, rel=0.1)
    assert (np.delete(found, [part.channels.index(c) for c in ("phi", "p")]) == 1.0).all()


@pytest.mark.parametrize("damping", [0.5, 2.0])
def test_what_thrusters_answer_within_a_sample_is_told_from_what_the_pilot_wants(damping: float):
    v = vehicle.load("bluerov2_heavy")
    part, other = (cut_run(turned(damping, answers), v, "fossen", 10.0) for answers in (True, False))
    found = fast_damping(part)
    assert found["yaw"] == pytest.approx(damping, rel=0.1)
    assert {axis for axis, size in found.items() if size > 0.0} == {"yaw"}
    assert fast_damping(other)["yaw"] < 0.1 * damping
    assert answered_forces((part,))["yaw"] == pytest.approx(damping * np.sqrt(np.mean(part.run.get("r") ** 2)), rel=0.1)
    assert loop_gains((part,))["yaw"] > 10.0 * loop_gains((other,))["yaw"]
