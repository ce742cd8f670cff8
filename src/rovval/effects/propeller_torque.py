"""A propeller turns the vehicle against its own rotation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from rovval.effects import Effect, Parameter
from rovval.effects._lanes import Array, Lanes

EFFECT = Effect(
    name="propeller_torque",
    title="Propeller torque",
    place="input",
    equation="moment handedness arm T_i e_i, arm = K_Q D / K_T (Fossen 2021, 9.4; diagnosis.md A13).",
    parameters=(Parameter("arm", "m", -0.6, 0.6, 0.0, 0.01, "1 to 3 cm of torque per newton (diagnosis.md A13); searched well beyond"),),
    signature="roll, pitch or yaw that grows with thrust where handedness does not cancel",
    confused_with=("cg_offset", "thruster_misaligned"),
    separates="drive one thruster: torque is about its own axis",
)


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """The plant adds it to the moment of each thruster."""
    return replace(lanes, torque_arm=lanes.torque_arm + p["arm"])
