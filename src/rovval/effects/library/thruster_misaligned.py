"""One thruster points a little elsewhere than the vehicle file says."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rovval.effects.effect import Effect, Parameter, Tolerance
from rovval.effects.lanes import Array, Lanes

SOURCE = "1 to 10 degrees (chosen); the bounds hold one that was knocked round: beyond 45 degrees a bracket has come off, and its thrust is no longer there"
MOUNTED = Tolerance(0.3, "rad per unit of calibration tolerance: 5 % goes with thrusters mounted to within a degree (chosen)")

EFFECT = Effect(
    name="thruster_misaligned",
    title="Thruster misaligned",
    place="input",
    equation="e_i <- e_i turned by yaw about the body's z axis, then by tilt about the horizontal axis across e_i (about x for a vertical "
    "thruster, whose yaw turns about y); thrust and moment follow.",
    symbols={"e_i": "unit vector of thruster i's thrust, body axes", "yaw, tilt": "angles of the two turns; rad"},
    parameters=(
        Parameter("yaw", "rad", -0.8, 0.8, 0.0, 0.05, SOURCE, tolerance=MOUNTED),
        Parameter("tilt", "rad", -0.8, 0.8, 0.0, 0.05, SOURCE, tolerance=MOUNTED),
    ),
    per="thruster",
    signature="a force across that thruster, growing with its thrust",
    confused_with=("thruster_degraded", "cross_drag", "cg_offset", "propeller_torque"),
    separates="drive that thruster apart from the others and watch the other axes",
    literature=("thesis, equation 3.15", "Fossen and Johansen 2006: thruster configuration matrix"),
    family="allocation",
)


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """Turn the directions (Rodrigues' formula); an angle of zero leaves a direction to the last bit."""
    first, second = axes(np.asarray(lanes.direction[0]))
    turned = _turn(_turn(lanes.direction, first, p["yaw"]), second, p["tilt"])
    return replace(lanes, direction=turned)


def axes(direction: Array) -> tuple[Array, Array]:
    """Axes (k, 3) of the two turns for directions (k, 3)."""
    up = np.array([0.0, 0.0, 1.0])
    vertical = np.abs(direction[:, 2]) > 0.9
    first = np.where(vertical[:, None], np.array([0.0, 1.0, 0.0]), up)
    second = np.where(vertical[:, None], np.array([1.0, 0.0, 0.0]), np.cross(up, direction))
    length = np.linalg.norm(second, axis=1, keepdims=True)
    return first, second / length


def _turn(vector: Array, axis: Array, angle: Array) -> Array:
    s, c = np.sin(angle)[..., None], (1.0 - np.cos(angle))[..., None]
    once = np.cross(axis, vector)
    return vector + s * once + c * np.cross(axis, once)
