"""Buoyancy that runs away or comes on, from some time on: a leak, ballast that bleeds, foam that soaks."""

from __future__ import annotations

from collections.abc import Mapping

from rovval.effects.arithmetic import Number, positive
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

EFFECT = Effect(
    name="buoyancy_drift",
    title="Buoyancy drifts",
    place="wrench",
    equation="B(t) = B + rate s / (1 + s settling), the change x ahead of the centre of buoyancy, s = max(t - onset, 0): steady where settling is 0, else "
    "the slower the more has come in, as a housing fills whose pressure rises. Mass and inertia of what comes in are left as they are: per mille of the "
    "vehicle's.",
    symbols={
        "B": "buoyancy of the submerged vehicle, upwards in the north-east-down frame; N",
        "rate": "gain of buoyancy at first, negative while water comes in; N/s",
        "settling": "one over the time after which half of all has come in; 1/s",
        "x": "where it comes in, ahead of the centre of buoyancy, body axes; m",
        "onset": "time since the run's start; s",
        "t": "time since the run's start; s",
    },
    parameters=(
        Parameter("rate", "N/s", -1.0, 1.0, 0.0, 0.005, "0.3 kg of water in ten minutes (chosen)", "weight"),
        Parameter("onset", "s", 0.0, 1e6, 0.0, 60.0, "any time of the log, or before it", role="onset"),
        Parameter("settling", "1/s", 0.0, 1.0, 0.0, 0.01, "a housing that fills in minutes (chosen)", role="extent", starts=(0.0,)),
        Parameter("x", "m", -3.0, 3.0, 0.0, 0.2, "a housing at either end"),
    ),
    signature="a vertical force that grows with time, at every depth, heading and speed",
    confused_with=("payload_change", "buoyancy_error", "density_gradient"),
    separates="come back to a depth and a speed that the log has seen before",
    literature=("Fossen 2021, section 4.1: restoring forces of submerged vehicles",),
    lasts=True,
)
ROWS = ("rate", "onset", "settling", "bx", "by", "bz")


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """Rate of buoyancy, N/s, from when on, how it settles, and where it acts."""
    b = lanes.centre_of_buoyancy
    return {"rate": p["rate"], "onset": p["onset"], "settling": p["settling"], "bx": b[:, 0] + p["x"], "by": b[:, 1], "bz": b[:, 2]}


def wrench(
    rate: Number, onset: Number, settling: Number, bx: Number, by: Number, bz: Number, t: Number, r31: Number, r32: Number, r33: Number
) -> tuple[Number, ...]:
    """Buoyancy that came on since the start, in the body frame, and its moment."""
    since = positive(t - onset)
    up = -rate * since / (1.0 + since * settling)
    fx, fy, fz = up * r31, up * r32, up * r33
    return fx, fy, fz, by * fz - bz * fy, bz * fx - bx * fz, bx * fy - by * fx
