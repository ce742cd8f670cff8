"""What the diagnosis calls things, in words that need no statistics: an effect by its title, a regime by what the vehicle does, an error by its rms."""

from __future__ import annotations

import re
from math import sqrt

import numpy as np

from rovval import effects
from rovval.core.data import Flags, Run
from rovval.core.units import DEGREES
from rovval.diagnose.result.diagnosis import Reduction
from rovval.report.common.numbers import MISSING, per_cent, per_cents

# a velocity: what the vehicle does when it is positive, negative, of either sign, and small
MOVING = {
    "u": ("moving ahead faster than", "moving astern faster than", "moving ahead or astern faster than", "moving ahead or astern slower than"),
    "v": ("moving to starboard faster than", "moving to port faster than", "moving sideways faster than", "moving sideways slower than"),
    "w": ("moving down faster than", "moving up faster than", "moving up or down faster than", "moving up or down slower than"),
    "r": ("turning to starboard faster than", "turning to port faster than", "turning faster than", "turning slower than"),
}
CHANNELS = {"depth": "z", "altitude": "altitude"}  # of a regime, where it is not named by the channel itself
_LIMIT = re.compile(r"(\|?)(\w+)\|? ([<>]) (-?[\d.e-]+)(?: \S+)?")
_TIMES = re.compile(r"time (\S+) to (\S+) s")
_LEVEL = re.compile(r"(\|?)([uvwr])\|? ([<>]) -?([\d.e-]+ \S+)")


def title(name: str) -> str:
    """Axial inflow loss; the name itself of what is not in the library."""
    effect = name.partition("[")[0].partition(".")[0]
    return effects.load(effect).title if effect in effects.names() else name


def of_what(name: str) -> str:
    """Linear drag differs (yaw): its title, and which axis or thruster it is of."""
    target = name.partition("[")[2].rstrip("]")
    return f"{title(name)} ({target})" if target else title(name)


def titled(name: str) -> str:
    """Linear drag differs (linear_drag[yaw])."""
    said = title(name)
    return said if said == name else f"{said} ({name})"


def regime(name: str) -> str:
    """When: "u > 0.33 m/s" as moving ahead faster than 0.33 m/s."""
    found = _LEVEL.fullmatch(name)
    if not found:
        return name.replace("time ", "from ", 1) if name.startswith("time ") else name
    either, channel, sign, level = found.groups()
    kind = (3 if sign == "<" else 2) if either else 0 if sign == ">" else 1
    return f"{MOVING[channel][kind]} {level}"


def when(name: str) -> str:
    """The same in a sentence: when moving ahead faster than 0.33 m/s, when HFP turns forward, from 20 to 80 s."""
    said = regime(name)
    return said if name.startswith("time ") else f"when {said.replace(' turning ', ' turns ')}"


def holds(run: Run, name: str) -> Flags | None:
    """When a regime holds (n,), from the run's own channels; None for one that cannot be told from them."""
    if found := _TIMES.fullmatch(name):
        return np.asarray((run.t >= float(found[1])) & (run.t < float(found[2])))
    found = _LIMIT.fullmatch(name)
    channel = CHANNELS.get(found[2], found[2]) if found else ""
    if not found or not run.measured(channel):
        return None
    value = run.get(channel) * (DEGREES if channel == "r" else 1.0)
    value = np.abs(value) if found[1] else value
    return np.asarray(value > float(found[4]) if found[3] == ">" else value < float(found[4]))


def remaining(share: float) -> float:
    """The part of an rms error that is left when the share ``share`` of its square is gone."""
    return sqrt(max(1.0 - share, 0.0))


def falls(share: float, low: float | None = None, high: float | None = None) -> str:
    """falls to 33 % [30, 37]: the rms error when the share ``share`` [low, high] of its square is gone; grows where it does."""
    verb = "grows" if share < 0 else "falls"
    if low is None or high is None:
        return f"{verb} to {per_cent(remaining(share))}"
    return f"{verb} to {per_cent(remaining(share))} {per_cents(remaining(high), remaining(low)).removesuffix(' %')}"


def falls_to(s: Reduction) -> str:
    """The same of a reduction with its interval."""
    return falls(s.total, s.low, s.high)


def left_of(share: float | None) -> str:
    """33 %: what is left of an rms error."""
    return MISSING if share is None else per_cent(remaining(share))
