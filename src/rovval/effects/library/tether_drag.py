"""The tether that the vehicle drags along: a force against its velocity through the water, the same whichever way it points."""

from __future__ import annotations

from collections.abc import Mapping

from rovval.effects.arithmetic import Number, sqrt
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

EFFECT = Effect(
    name="tether_drag",
    title="Drag of the tether",
    place="wrench",
    equation="F = -(coefficient + per_length L) |v| v at the attachment (x, 0, z); coefficient ~ 1/2 rho C_n d L, of which the vehicle carries about half.",
    symbols={
        "F": "force, body axes; N",
        "v": "velocity of the attachment relative to the water, the vehicle's turning included, body axes; m/s",
        "L": "logged length of tether paid out; m",
        "rho": "density of the water; kg/m3",
        "C_n, d": "coefficient of normal drag (1) and diameter (m) of the tether",
        "x, z": "attachment ahead of and below the origin, body axes; m",
    },
    parameters=(
        Parameter(
            "coefficient", "N s2/m2", 0.0, 1500.0, 0.0, 40.0, "0.5 m/s with 100 m of 7.6 mm: 115 N at C_n 1.2 (Hoerner 1965) to 190 N at 2.0 (in use)", "drag",
        ),
        Parameter("per_length", "N s2/m3", 0.0, 20.0, 0.0, 2.0, "1/2 rho C_n d with half carried by the vehicle: 7.6 mm, C_n 1.2: 2.3; needs tether_length"),
        Parameter("x", "m", -2.0, 2.0, 0.0, 0.3, "attachment, ahead of the origin", role="lever"),
        Parameter("z", "m", -2.0, 2.0, 0.0, 0.2, "attachment, below the origin", role="lever"),
    ),
    signature="opposes the velocity through the water alike in every body direction; grows with tether paid out",
    confused_with=("quadratic_drag", "linear_drag", "current_constant", "inflow_loss"),
    separates="the same speed ahead and sideways: a hull's drag differs, a tether's does not; the log of tether length",
    literature=(
        "Hoerner 1965: normal drag of a cylinder, C_n 1.2",
        "Driscoll 2000: dynamics of an ROV's tether",
        "Feng and Allen 2004: a cable's drag on an underwater vehicle",
    ),
)
ROWS = ("coefficient", "per_length", "ax", "az")


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """Coefficients and attachment."""
    return {"coefficient": p["coefficient"], "per_length": p["per_length"], "ax": p["x"], "az": p["z"]}


def wrench(
    coefficient: Number, per_length: Number, ax: Number, az: Number, tether_length: Number,
    ur: Number, vr: Number, wr: Number, p: Number, q: Number, r: Number,
) -> tuple[Number, ...]:  # fmt: skip
    """Force against the attachment's velocity relative to the water (its length is the same in both frames) and its moment."""
    ua, va, wa = ur + q * az, vr + r * ax - p * az, wr - q * ax
    pull = -(coefficient + per_length * tether_length) * sqrt(ua * ua + va * va + wa * wa)
    fx, fy, fz = pull * ua, pull * va, pull * wa
    return fx, fy, fz, -az * fy, az * fx - ax * fz, ax * fy
