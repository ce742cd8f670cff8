"""A payload is taken up or set down during the log."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rovval.effects.arithmetic import Number, clip
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

RAMP = 0.1  # s over which the weight comes on: a sample of the common grid, so that the onset has a gradient

EFFECT = Effect(
    name="payload_change",
    title="Payload taken up or set down",
    place="wrench",
    equation="from onset on: mass m at r_P = (x, y, z) joins M_RB and C_RB, negative where it is set down, and its weight in water acts there. Weight comes on "
    "over 0.1 s, mass at the next step; what would leave no inertia of some motion stops the simulation. Added mass of the payload is not modelled.",
    symbols={
        "m": "mass of the payload; kg",
        "weight": "its weight less its buoyancy, down in the north-east-down frame; N",
        "r_P": "where it hangs, from the body's origin, body axes; m",
        "M_RB, C_RB": "rigid-body mass matrix and its Coriolis and centripetal matrix",
        "onset": "time since the run's start; s",
    },
    parameters=(
        Parameter("mass", "kg", -10.0, 10.0, 0.0, 0.5, "up to some per cent of the vehicle (Merlin: 250 to 475 kg of 3000, thesis 2.2)", "weight"),
        Parameter("weight", "N", -60.0, 60.0, 0.0, 3.0, "weight less buoyancy of the load", "weight"),
        Parameter("onset", "s", 0.0, 1e6, 0.0, 60.0, "any time of the log", role="onset"),
        Parameter("x", "m", -3.0, 3.0, 0.0, 0.2, "where it hangs"),
        Parameter("y", "m", -3.0, 3.0, 0.0, 0.2, "where it hangs"),
        Parameter("z", "m", -3.0, 3.0, 0.0, 0.2, "where it hangs"),
    ),
    signature="from one moment on: heave and pitch step together, and the answer to thrust slows",
    confused_with=("buoyancy_error", "tether_tension", "thruster_fault_onset", "cg_offset"),
    separates="the change point and the axes that step together",
    literature=("Fossen 2021, section 3.3: rigid-body kinetics, Huygens-Steiner", "thesis, section 2.2: payloads of the Merlin"),
)
FULL_KERNEL = True
ROWS = ("weight", "onset", "px", "py", "pz")


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """Hand the mass to the plant, which adds it when its time comes."""
    place = np.stack([p["x"], p["y"], p["z"]], axis=1)
    return replace(lanes, payload_mass=p["mass"], payload_position=place, payload_onset=p["onset"])


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """Weight in water, when and where."""
    return {"weight": p["weight"], "onset": p["onset"], "px": p["x"], "py": p["y"], "pz": p["z"]}


def wrench(
    weight: Number, onset: Number, px: Number, py: Number, pz: Number, t: Number, r31: Number, r32: Number, r33: Number
) -> tuple[Number, ...]:
    """Weight in water in the body frame, and its moment."""
    down = weight * clip((t - onset) * (1.0 / RAMP), 0.0, 1.0)
    fx, fy, fz = down * r31, down * r32, down * r33
    return fx, fy, fz, py * fz - pz * fy, pz * fx - px * fz, px * fy - py * fx
