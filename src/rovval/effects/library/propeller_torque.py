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
    equation="moment (handedness arm + common) T_i e_i, arm = K_Q D / K_T (Fossen 2021, 9.4; diagnosis.md A13); common: of propellers that are all of "
    "one hand, where the file says that they are not.",
    parameters=(
        Parameter("arm", "m", -0.6, 0.6, 0.0, 0.01, "1 to 3 cm of torque per newton (diagnosis.md A13); searched well beyond"),
        Parameter("common", "m", -0.6, 0.6, 0.0, 0.01, "as arm: which hand a spare propeller has, no file knows"),
    ),
    signature="roll, pitch or yaw that grows with thrust where handedness does not cancel",
    confused_with=("cg_offset", "thruster_misaligned"),
    separates="drive one thruster: torque is about its own axis",
    apart=True,
)


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """The plant adds it to the moment of each thruster; where the file has all propellers of one hand, ``arm`` says it all."""
    hand = np.array([t.handedness for t in lanes.vehicle.thruster], dtype=float)
    common = p["common"] * float(np.ptp(hand) > 0)
    return replace(lanes, torque_arm=lanes.torque_arm + p["arm"][:, None] * hand + common[:, None])
