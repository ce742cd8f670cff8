"""What drives the plant: pulse widths and sticks where they were logged, and nothing where they were not."""

from __future__ import annotations

import numpy as np
import pytest
from diagnose_case import bare
from scipy.spatial.transform import Rotation

from rovval import vehicle
from rovval.alignment import align
from rovval.core.data import RawLog, Reason, Run, Series
from rovval.core.errors import BadInput
from rovval.simulation import simulate
from rovval.simulation.actuation import recorded_actuation, start_states

HEAVY = vehicle.load("bluerov2_heavy")
assert HEAVY.mixer is not None and HEAVY.pulse_table is not None
PULSES = tuple(f"pwm:{name}" for name in HEAVY.thrusters)
STICKS = tuple(f"stick:{axis}" for axis in HEAVY.mixer.factors)


def driven(names: tuple[str, ...], value: float, begins_s: float = 0.0, ends_s: float = 20.0) -> Run:
    """A vehicle at rest for 20 s, with commands of one value for a part of it, ten a second."""
    t = np.linspace(0.0, 20.0, 201)
    at = t[(t > begins_s - 0.01) & (t < ends_s + 0.01)]
    channels = {n: Series(t, np.zeros(201), "row") for n in ("u", "v", "w", "p", "q", "r", "z", "phi", "theta", "psi")}
    return align(RawLog("x.csv", "ab" * 32, "test", "", None, channels | {n: Series(at, np.full(len(at), value), "row") for n in names}))


@pytest.mark.parametrize(("names", "value"), [(PULSES, 1600.0), (STICKS, 0.0)])
def test_a_stream_that_is_shorter_than_the_sensors_is_missing_there(names: tuple[str, ...], value: float):
    run = driven(names, value, 3.0, 15.0)
    actuation = recorded_actuation(run, HEAVY)
    inside = (run.t > 2.95) & (run.t < 15.15)
    assert np.array_equal(actuation.known, inside) and actuation.inputs.speed.shape == (201, 8)
    assert not actuation.inputs.speed[~inside].any()
    free = simulate(run, HEAVY).free
    assert np.array_equal(free.ok, inside) and (free.reasons[~inside] == Reason.STOPPED).all()


def test_a_pulse_width_above_neutral_is_the_strong_side():
    """The T200 pushes 1.29 times as hard ahead as astern at the ends of its table."""
    ahead, astern = (recorded_actuation(driven(PULSES, value), HEAVY).inputs.speed[0] for value in (1900.0, 1100.0))
    thrust = [t.k_pos * (60.0 * a) ** 2 / (t.k_neg * (60.0 * b) ** 2) for t, a, b in zip(HEAVY.thruster, ahead, astern, strict=True)]
    assert (ahead > 0).all() and (astern < 0).all() and np.allclose(thrust, 51.4849 / 39.9131)


def test_a_pulse_table_needs_no_speeds():
    assert HEAVY.pulse_table is not None
    bare = HEAVY.model_copy(update={"pulse_table": HEAVY.pulse_table.model_copy(update={"rpm": None})})
    run = driven(PULSES, 1700.0)
    assert np.array_equal(recorded_actuation(run, bare).inputs.speed, recorded_actuation(run, HEAVY).inputs.speed)


def test_a_pulse_width_beyond_the_table_is_refused():
    with pytest.raises(BadInput, match="outside the thruster table") as refused:
        recorded_actuation(driven(PULSES, 2000.0, 3.0), HEAVY)
    first, last = HEAVY.thrusters[0], HEAVY.thrusters[-1]
    assert f"- {first}: 171 samples from 2000 to 2000 us, the first at t = 3.0 s" in refused.value.message and f"- {last}: " in refused.value.message
    assert "pulse_table" in refused.value.hint and "--from" in refused.value.hint


def test_rates_that_were_not_logged_start_as_the_attitude_turns_however_the_vehicle_stands():
    """A vehicle that turns over and over about its own y at a constant rate, past both poles of the Euler angles by a thousandth of a radian."""
    rate, t = np.array([0.0, 1.3, 0.0]), np.arange(120) * 0.1
    euler = (Rotation.from_euler("ZYX", [0.3, 0.1, 0.001]) * Rotation.from_rotvec(np.outer(t, rate))).as_euler("ZYX")
    assert np.degrees(np.abs(euler[:, 1]).max()) > 88.0
    run = bare(dict(zip(("psi", "theta", "phi"), euler.T, strict=True)), HEAVY, "over")
    nu, _, assumptions = start_states(run, np.arange(10, 110))
    assert any("p was not logged" in said for said in assumptions)
    np.testing.assert_allclose(nu[:, 3:], np.tile(rate, (100, 1)), atol=1e-6)
