"""The channel table: what a log can hold, under which name, in which unit, and how it comes to 10 Hz.

A channel's name is a word of this table (``u``, ``psi``, ``altitude``) or ``family:member`` for what a vehicle has many
of (``n:HFP`` is the measured speed of thruster HFP).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal

from rovval.core.errors import UsageProblem

Resampling = Literal["mean", "hold", "hold_mean", "circular", "linear"]
HELD: tuple[Resampling, ...] = ("hold", "hold_mean")  # of commands, which act until the next one
AXES = ("surge", "sway", "heave", "roll", "pitch", "yaw")
VELOCITIES = ("u", "v", "w", "p", "q", "r")
POSE = ("x", "y", "z", "phi", "theta", "psi")
DRIVING = (*VELOCITIES, *POSE, "n", "n_cmd", "pwm", "stick")  # what drives a vehicle and how it moves: the channels that span the grid
STICKS = ("surge", "sway", "heave", "roll", "pitch", "yaw")


@dataclass(frozen=True, slots=True)
class Channel:
    """One row: SI unit inside, default resampling, longest gap bridged (s), and the sane range beyond which a value is
    refused as physically impossible for an ROV (chosen wide; masked with a reason, never clipped)."""

    name: str
    unit: str
    meaning: str
    resampling: Resampling
    longest_gap_s: float
    low: float
    high: float


@dataclass(frozen=True, slots=True)
class Rule:
    """What a source's profile says otherwise than the table: None leaves the table's value. A run of equal values longer than
    ``stuck_s`` (s) is masked only where this is given."""

    resampling: Resampling | None = None
    longest_gap_s: float | None = None
    stuck_s: float | None = None


def _table() -> Mapping[str, Channel]:
    rows = [
        *(Channel(n, "m/s", f"body velocity over ground, {a}", "mean", 0.5, -15.0, 15.0) for n, a in zip("uvw", AXES[:3], strict=True)),
        *(Channel(n, "rad/s", f"body rate, {a}", "mean", 0.5, -20.0, 20.0) for n, a in zip("pqr", AXES[3:], strict=True)),
        Channel("x", "m", "north of the first sample", "linear", 1.0, -1e6, 1e6),
        Channel("y", "m", "east of the first sample", "linear", 1.0, -1e6, 1e6),
        Channel("z", "m", "depth, positive down", "linear", 1.0, -100.0, 12000.0),
        *(Channel(n, "rad", f"{a} angle", "circular", 0.5, -7.0, 7.0) for n, a in zip(("phi", "theta", "psi"), AXES[3:], strict=True)),
        *(Channel(n, "m/s2", f"time derivative of {n[0]} in the body frame", "mean", 0.5, -200.0, 200.0) for n in ("udot", "vdot", "wdot")),
        Channel("altitude", "m", "height above the bottom", "linear", 1.0, -1.0, 12000.0),
        Channel("wall_distance", "m", "distance to the nearest wall", "linear", 1.0, 0.0, 12000.0),
        Channel("voltage", "V", "supply voltage at the thrusters", "mean", 5.0, 0.0, 10000.0),
        Channel("tether_length", "m", "tether paid out", "linear", 5.0, 0.0, 20000.0),
        # a shaft turns continuously: holding its last sample would make the log half a sample late; so would a command that comes between grid points
        Channel("n", "rev/s", "measured thruster speed", "mean", 0.5, -500.0, 500.0),
        Channel("n_cmd", "rev/s", "thruster speed set-point", "hold_mean", 1.0, -500.0, 500.0),
        Channel("pwm", "us", "thruster pulse width", "hold_mean", 1.0, 500.0, 2500.0),
        Channel("stick", "1", "pilot's command on an axis, -1 to 1", "hold_mean", 1.0, -2.0, 2.0),
    ]
    return MappingProxyType({row.name: row for row in rows})


CHANNELS: Mapping[str, Channel] = _table()


def channel(name: str) -> Channel:
    """The table's row for ``name`` (``n:HFP`` -> the row of ``n``); refuses a name that is not in the table."""
    try:
        return CHANNELS[name.partition(":")[0]]
    except KeyError:
        raise UsageProblem(f"unknown channel {name!r}", f"use one of: {', '.join(CHANNELS)} (families as n:THRUSTER, stick:AXIS)") from None


def members(names: Mapping[str, object] | tuple[str, ...], family: str) -> tuple[str, ...]:
    """The members of ``family`` among ``names``: ``n:HFP`` and ``n:HFS`` give ("HFP", "HFS")."""
    return tuple(n.partition(":")[2] for n in names if n.startswith(family + ":"))
