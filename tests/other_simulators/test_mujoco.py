"""Vehicles in another simulator, calibrated on three of its logs: what is then wrong with them is named, and nobody is blamed where nothing is.

Vehicles of an earlier form of this plant, with other thrust, were looked at while the engine was made, and so were seeds 2 to 6 of this one. These
were not at first; since then they have been asked again after changes, and are development.
"""

from __future__ import annotations

import math
import tempfile
from functools import cache
from pathlib import Path

import pytest
from mujoco_rov import PROFILE, Fault, Rov, read
from real_answers import Answer, Question, ask, confidence, named_first, overconfident

from rovval import vehicle
from rovval.fit.calibration import Calibration, calibrate
from rovval.fit.calibration.unknowns import SENSORS
from rovval.vehicle.write import to_toml

pytestmark = pytest.mark.slow
pytest.importorskip("mujoco")

CASES: dict[str, tuple[Fault, tuple[str, ...]]] = {
    "nothing": (Fault(), ()),
    "nothing, again": (Fault(), ()),
    "T2 at 0.6": (Fault(gain={2: 0.6}), ("thruster_degraded[T2]",)),
    "T2 at 1/0.6": (Fault(gain={2: 1.0 / 0.6}), ("thruster_degraded[T2]",)),
    "T6 dead": (Fault(gain={6: 0.0}), ("thruster_degraded[T6]",)),
    "all thrusters at 0.75": (Fault(thrust=0.75), ("rpm_scale", "voltage_sag")),
    "astern at 0.6": (Fault(astern=0.6), ("reverse_asymmetry",)),
    "lag of 0.45 s": (Fault(lag=0.45), ("thrust_lag", "time_offset")),
    "buoyancy, 3 N": (Fault(buoyancy=3.0), ("buoyancy_error",)),
    "centre of gravity, 5 mm": (Fault(centre=(0.005, 0.0, 0.0)), ("cg_offset",)),
    "a plate across the bow": (Fault(plate=True), ("quadratic_drag[surge]", "linear_drag[surge]")),
    "a current": (Fault(water=(0.15, 0.1, 0.0)), ("current_constant",)),
    "6 N from the middle on": (Fault(weight=6.0), ("payload_change",)),
    "velocity 0.4 s late": (Fault(late=0.4), ("time_offset[velocity]", "velocity_filter_lag")),
    "velocity turned by 10 degrees": (Fault(turned=math.radians(10.0)), ("dvl_misalignment",)),
    "velocity 1.1 times": (Fault(scaled=1.1), ("dvl_scale",)),
    "roll off by 4 degrees": (Fault(roll=math.radians(4.0)), ("attitude_bias",)),
    "yaw rate off by 2 deg/s": (Fault(yaw=math.radians(2.0)), ("gyro_bias",)),
}
CALIBRATED_ON = ("first", "second", "third")
SEEDS = (1, 8)  # a vehicle takes six minutes


@cache
def folder(seed: int) -> tempfile.TemporaryDirectory[str]:
    """Where the logs of a vehicle are; gone with the process."""
    return tempfile.TemporaryDirectory(prefix=f"mujoco{seed}")


def log(seed: int, name: str) -> Path:
    """The log of a case, or one that the vehicle is calibrated on, flown where that was not done yet."""
    there, number = Path(folder(seed).name), (*CALIBRATED_ON, *CASES).index(name)
    (there / "mujoco_rov.toml").write_text(PROFILE, encoding="utf-8")
    path = there / f"{number}.csv"
    if not path.exists():
        Rov(seed).fly(path, number, CASES[name][0] if name in CASES else None)
    return path


@cache
def calibration(seed: int) -> Calibration:
    return calibrate([read(log(seed, name)) for name in CALIBRATED_ON], vehicle.load("bluerov2_heavy"))


def answers(seed: int) -> tuple[Answer, ...]:
    """What is named of each case, asked two at a time."""
    known = to_toml(calibration(seed).vehicle)
    return ask(tuple(Question(name, (log(seed, name),), known, right, read) for name, (_, right) in CASES.items()))


@pytest.mark.parametrize("seed", SEEDS)
def test_a_calibration_finds_attitude_and_velocity_in_one_frame(seed: int):
    """As they are: drag that no equation of the model has turns neither against the other. Both together it may, which kinematics do not show."""
    found = {row.unknown.key: row.value for row in calibration(seed).rows if row.unknown.key in SENSORS}
    print({key: round(value, 4) for key, value in found.items()})
    assert abs(found["attitude.phi"] - found["velocity.roll"]) < math.radians(0.3)
    assert abs(found["attitude.theta"] - found["velocity.pitch"]) < math.radians(0.3)


@pytest.mark.parametrize("seed", SEEDS)
def test_what_is_wrong_with_a_calibrated_vehicle_is_named(seed: int):
    found = answers(seed)
    print("\n" + "\n".join(f"{one.question.piece}: {one}" for one in found) + "\n\n" + confidence(found))
    (right, asked), (wrong, _) = named_first(found), overconfident(found)
    print(f"vehicle {seed}: named first {right} of {asked}; wrong at 0.9 or above {wrong}")
    assert right >= asked / 2  # of all, also of what hardly shows: a plate and a weight do not
    assert wrong == 0
    assert not any(one.causes for one in found if not one.question.right)
