"""From a label to what counts as right: the library's name of a planted effect, aliases each with its reason, axes, and what it goes with."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

from rovval import effects
from rovval.blind.plant.nominal_vehicle import read_vehicle
from rovval.blind.plant.scales import scales
from rovval.blind.plant.spec import AXES

Row = Mapping[str, Any]  # one effect of a label
TARGETED = {"added_mass", "linear_drag", "quadratic_drag", "inertia_error", "thruster_degraded", "thruster_fault_onset"}
TARGETED |= {"thruster_reversed", "thruster_misaligned", "thruster_interaction", "thruster_sticking"}  # by axis or thruster, as the library has them
NAMED_SINCE = {  # what a plant holds for foreign and the library has learnt
    "sticky_thruster": "thruster_sticking", "water_leak": "buoyancy_drift", "manipulator": "moving_tool", "dry_friction": "dragged_load",
    "sliding_battery": "shifting_ballast", "ventilation": "ventilation", "power_limit": "supply_droop",
    "one_sided_drag": "drag_asymmetry[surge]", "body_lift": "hull_lift", "twisted_tether": "tether_torsion",
    "depth_port_error": "depth_error",
}  # fmt: skip
EARLY_S = 10.0  # an onset within the first window is no onset to a diagnosis in windows of 10 s
MAIN_AXIS = 0.5  # an axis belongs to an effect that pushes it at least half as hard as its hardest
SAME_INERTIA = {"added_mass": "inertia_error", "inertia_error": "added_mass"}  # one law about roll, pitch and yaw
CHANNEL_AXIS = {"LinVelX": "surge", "LinVelY": "sway", "LinVelZ": "heave", "Depth": "heave", "AngVelX": "roll", "Roll": "roll"}
CHANNEL_AXIS |= {"AngVelY": "pitch", "Pitch": "pitch", "AngVelZ": "yaw", "Heading": "yaw"}
VELOCITY = dict(zip(AXES, "uvwpqr", strict=True))
GOES_WITH = {  # what the gap of an effect varies with, as the diagnosis words regimes and features; others are not scored
    "current_constant": "heading", "current_shear": "depth", "compass_deviation": "heading", "tether_tension": "heading",
    "density_gradient": "depth", "ground_effect": "altitude|bottom", "voltage_sag": "time|third", "payload_change": "time|third",
    "inflow_loss": r"\bu\b|thrust|turning", "reverse_asymmetry": "backward|thrust|turning",
}  # fmt: skip


class Said(Protocol):
    """An effect that an answer names, as a cause or in the confusion group of one."""

    @property
    def effect(self) -> str:
        """Name in the library."""

    @property
    def onset_s(self) -> float | None:
        """Time from which it is at work, s; None: all of the log, or not told."""


@dataclass(frozen=True, slots=True)
class Member:
    """A name of a confusion group, or of the ranking."""

    effect: str
    onset_s: float | None = None


def name(effect: Row) -> str:
    """The library's hypothesis for a planted effect; a foreign one keeps its own name, which no hypothesis has."""
    if effect["name"] == "inertia_error" and effect["target"] == "surge":
        return "added_mass[surge]"  # see `alias`
    called = NAMED_SINCE.get(effect["name"], str(effect["name"]))
    apart = called in TARGETED or (effect["name"] == "time_offset" and effect["target"] in ("velocity", "attitude", "depth"))
    return f"{called}[{effect['target']}]" if apart else called


def foreign(effect: Row) -> bool:
    """Whether the library has nothing of the kind."""
    return bool(effect["place"] == "foreign" and effect["name"] not in NAMED_SINCE)


def accepts(effect: Row, said: Said) -> bool:
    """Whether a cause of an answer names a planted effect, by its own name or an alias that the cause's numbers bear out."""
    return not foreign(effect) and (said.effect == name(effect) or alias(effect, said) is not None)


def alias(effect: Row, cause: Said) -> str | None:
    """The reason for which a cause of another name is the same answer; None: it is not. There are these and no others."""
    said, on = cause.effect, f"[{effect['target']}]"
    if said != name(effect) and _together(name(effect), said):
        return "one axis of several that the library takes for one, or all of which one was off"
    if effect["name"] == "inertia_error" and effect["target"] == "surge":
        if said in ("added_mass[sway]", "added_mass[heave]", "payload_change"):
            return "weightless extra mass has no name of its own: the library has it as added mass of an axis or as a payload"
    elif effect["name"] == "thruster_degraded" and said == f"thruster_fault_onset{on}":
        if cause.onset_s is not None and cause.onset_s < EARLY_S:
            return "a loss from the first window on is a loss all the time"
    elif effect["name"] in SAME_INERTIA and effect["target"] in ("roll", "pitch", "yaw") and said == SAME_INERTIA[effect["name"]] + on:
        return "about an axis of rotation the motion shows the sum of inertia and added inertia and nothing of either"
    return None


def _together(true: str, said: str) -> bool:
    """Whether two names are of one effect, one of them on a group of axes of which the other is one."""
    (name, _, one), (other, _, two) = (x.rstrip("]").partition("[") for x in (true, said))
    groups = effects.load(name).groups if name == other and name in effects.names() else {}
    return one in groups.get(two, ()) or two in groups.get(one, ())


def axes(effect: Row, vehicle: Path) -> set[str]:
    """Axes that the effect acts on: those it pushes hard, by the acceleration that its wrench would give; by channel for sensors."""
    size = effect["realised"]
    if "channel_rms" in size:
        return {CHANNEL_AXIS[c] for c in size["channel_rms"] if c in CHANNEL_AXIS}
    nominal = read_vehicle(vehicle)
    mass = [nominal.mass + float(nominal.added_mass[i, i]) for i in range(3)]
    turn = [(float(nominal.inertia[i, i]) + float(nominal.added_mass[i + 3, i + 3])) / scales(nominal).length for i in range(3)]
    push = {axis: size["wrench_rms"][axis] / m for axis, m in zip(AXES, [*mass, *turn], strict=True)}
    return {axis for axis, value in push.items() if value >= MAIN_AXIS * max(push.values())}


def goes_with(effect: Row) -> str | None:
    """Pattern that one of an answer's worst regimes, or features of the unknown force, should match; None: not scored."""
    if effect["name"] in ("linear_drag", "quadratic_drag"):
        axes = effects.load(effect["name"]).groups.get(effect["target"], (effect["target"],))
        return rf"\|?\b[{''.join(VELOCITY[axis] for axis in axes)}]\b"
    if effect["name"].startswith("thruster_") and effect["target"]:
        return re.escape(str(effect["target"]))
    return GOES_WITH.get(str(effect["name"]))
