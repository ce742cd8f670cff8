"""Buoyancy that runs away or comes on steadily: a leak, ballast that bleeds, foam that soaks."""

from __future__ import annotations

from collections.abc import Mapping

from rovval.effects.arithmetic import Number
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

EFFECT = Effect(
    name="buoyancy_drift",
    title="Buoyancy drifts",
    place="wrench",
    equation="B(t) = B + rate t at the centre of buoyancy. Mass and inertia of what comes in are left as they are: per mille of the vehicle's.",
    symbols={
        "B": "buoyancy of the submerged vehicle, upwards in the north-east-down frame; N",
        "rate": "gain of buoyancy, negative while water comes in; N/s",
        "t": "time since the run's start; s",
    },
    parameters=(Parameter("rate", "N/s", -1.0, 1.0, 0.0, 0.005, "0.3 kg of water in ten minutes (chosen)", "weight"),),
    signature="a vertical force that grows with time, at every depth, heading and speed",
    confused_with=("payload_change", "buoyancy_error", "density_gradient"),
    separates="come back to a depth and a speed that the log has seen before",
    literature=("Fossen 2021, section 4.1: restoring forces of submerged vehicles",),
)
ROWS = ("rate", "bx", "by", "bz")


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """Rate of buoyancy, N/s, and where it acts."""
    b = lanes.centre_of_buoyancy
    return {"rate": p["rate"], "bx": b[:, 0], "by": b[:, 1], "bz": b[:, 2]}


def wrench(
    rate: Number, bx: Number, by: Number, bz: Number, t: Number, r31: Number, r32: Number, r33: Number
) -> tuple[Number, ...]:
    """Buoyancy that came on since the start, in the body frame, and its moment."""
    up = -rate * t
    fx, fy, fz = up * r31, up * r32, up * r33
    return fx, fy, fz, by * fz - bz * fy, bz * fx - bx * fz, bx * fy - by * fx
