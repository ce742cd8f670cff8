"""A bottom that the vehicle can touch, lie on and slide over."""

from __future__ import annotations

from collections.abc import Mapping

from rovval.effects.arithmetic import Number, positive, sqrt
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

SLIDES = 0.05  # m/s: friction is that of sliding well above it and in proportion to the speed below, so that it never pushes (chosen)
SINKS = 0.05  # m into the bottom under the whole weight out of water: mud or sand, and soft enough for the integration (chosen)
DAMPING = 0.5  # of critical (chosen): a hull that lands does not bounce for long

EFFECT = Effect(
    name="seabed",
    title="Contact with the bottom",
    place="wrench",
    equation="N = positive(k d + c rate(d)) where d = z + height / 2 - depth > 0, else 0; up, at the origin; friction -mu N v / sqrt(|v|^2 + 0.05^2) against "
    "the horizontal velocity v. k = firmness W / 0.05 m; c = firmness times half of the critical damping of the vehicle on it. A flat bottom; no moment.",
    symbols={
        "N": "force of the bottom, up in the north-east-down frame; N",
        "d": "how far the lower side of the hull is in the bottom; m",
        "z, v": "depth of the origin, the middle of the hull; m; velocity over ground, north and east; m/s",
        "height": "height of the hull, third number of its size in the vehicle's file; m",
        "W": "weight of the vehicle; N",
        "mu": "friction of the hull on the bottom; 1",
    },
    parameters=(
        Parameter("firmness", "1", 0.0, 1.0, 0.0, 1.0, "1: the bottom gives 5 cm under the whole weight (chosen)"),
        Parameter("depth", "m", -1000.0, 12000.0, 0.0, 10.0, "of the bottom, in the depth of the log", role="datum"),
        Parameter("friction", "1", 0.0, 2.0, 0.5, 0.2, "steel on sand: about 0.5 (chosen)", role="extent"),
    ),
    signature="depth ends at a limit, and the vehicle stops there",
    confused_with=("ground_effect", "tether_snag"),
    separates="it acts on the bottom and nowhere above it",
    literature=("thesis, section 2.4.2", "Fossen 2021, section 4.1: restoring forces of submerged vehicles"),
    competes=False,
)
ROWS = ("k", "c", "touch", "mu")


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """Stiffness N/m, damping N s/m, depth of the origin at which the hull touches, m, and friction."""
    body = lanes.vehicle.body
    firm = lanes.weight / SINKS
    critical = 2.0 * (firm * (lanes.mass + lanes.added_mass[:, 2, 2])) ** 0.5
    return {"k": p["firmness"] * firm, "c": p["firmness"] * DAMPING * critical, "touch": p["depth"] - 0.5 * body.size[2], "mu": p["friction"]}


def wrench(
    k: Number, c: Number, touch: Number, mu: Number, z: Number, vn: Number, ve: Number, vd: Number,
    r11: Number, r12: Number, r13: Number, r21: Number, r22: Number, r23: Number, r31: Number, r32: Number, r33: Number,
) -> tuple[Number, ...]:  # fmt: skip
    """The bottom's push up and its friction, in body axes; it never pulls."""
    deep = positive(z - touch)
    push = positive(k * deep + c * vd) * (deep / (deep + 1e-9))
    rub = -mu * push / sqrt(vn * vn + ve * ve + SLIDES * SLIDES)
    north, east = rub * vn, rub * ve
    return r11 * north + r21 * east - r31 * push, r12 * north + r22 * east - r32 * push, r13 * north + r23 * east - r33 * push, 0.0, 0.0, 0.0
