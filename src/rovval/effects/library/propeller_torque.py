"""A propeller turns the vehicle against its own rotation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

EFFECT = Effect(
    name="propeller_torque",
    title="Propeller torque",
    place="input",
    equation="moment (handedness arm + common) T_i e_i, arm = K_Q D / K_T; common: of propellers that are all of one hand, where the file says that they "
    "are not.",
    symbols={
        "T_i, e_i": "thrust of thruster i and its unit vector, body axes; N",
        "handedness": "+1 or -1, as the vehicle's file has it",
        "K_Q, K_T": "torque and thrust coefficient of the propeller; 1",
        "D": "propeller diameter; m",
    },
    parameters=(
        Parameter("arm", "m", -0.6, 0.6, 0.0, 0.01, "1 to 3 cm of torque per newton (K_Q D / K_T of small propellers); searched well beyond"),
        Parameter("common", "m", -0.6, 0.6, 0.0, 0.01, "as arm: which hand a spare propeller has, no file knows"),
    ),
    signature="roll, pitch or yaw that grows with thrust where handedness does not cancel",
    confused_with=("cg_offset", "thruster_misaligned"),
    separates="drive one thruster: torque is about its own axis",
    option="propeller_torque",
    literature=("Fossen 2021, section 9.4: thrust and torque coefficients", "Carlton 2018, chapter 6: propeller characteristics"),
    separable=True,
)


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """The plant adds it to the moment of each thruster; where the file has all propellers of one hand, ``arm`` says it all."""
    hand = np.array([t.handedness for t in lanes.vehicle.thruster], dtype=float)
    common = p["common"] * float(np.ptp(hand) > 0)
    return replace(lanes, torque_arm=lanes.torque_arm + p["arm"][:, None] * hand + common[:, None])
