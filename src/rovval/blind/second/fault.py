"""What an effect of plant b may touch, and the instant at which it is asked.

Each method below does nothing; an effect defines those that it needs, and the craft calls no other. An effect has its own memory and moves it on by
`advance` after every step of the craft. All is SI, forces in body axes, shaft speeds in rpm.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from rovval.blind.plant.spec import AXES, Array, Planted
from rovval.blind.second.hull import Hull
from rovval.blind.second.sheet import Sheet

COMES_ON_S = 1.5  # time constant with which an effect comes on after its onset (chosen)
Log = dict[str, Array]


@dataclass(frozen=True, slots=True)
class Site:
    """Where a flight takes place, drawn from its seed and never from what is planted."""

    seconds: float
    depth: float  # m, at the start
    seabed: float  # m, depth of the flat bottom
    heading: float  # rad, at the start
    winch: Array  # (3,) m, NED from the start of the vehicle's track (z: depth): where the tether comes from
    sag: float  # share of the supply's voltage lost by the end


@dataclass(slots=True)
class Instant:
    """The craft at one moment, as effects see it."""

    t: float = 0.0
    at: Array = field(default_factory=lambda: np.zeros(3))  # north, east, depth, m
    turn: Array = field(default_factory=lambda: np.eye(3))  # body to world
    nu: list[float] = field(default_factory=lambda: [0.0] * 6)  # over ground, body axes
    rel: list[float] = field(default_factory=lambda: [0.0] * 6)  # through the water, body axes
    water: Array = field(default_factory=lambda: np.zeros(3))  # velocity of the water, world
    n: Array = field(default_factory=lambda: np.zeros(0))  # shaft speeds, rpm
    spin: Array = field(default_factory=lambda: np.zeros(0))  # speeds that make thrust, rpm
    static: Array = field(default_factory=lambda: np.zeros(0))  # thrust at rest of these, N
    axial: Array = field(default_factory=lambda: np.zeros(0))  # inflow along each unit, m/s
    thrust: Array = field(default_factory=lambda: np.zeros(0))  # thrust that acts, N
    volts: float = 1.0  # supply over nominal
    altitude: float = 1e9

    @property
    def down(self) -> Array:
        """World down, seen from the body."""
        return np.asarray(self.turn[2])

    def world(self, v: Array) -> Array:
        """A body vector in the world."""
        return np.asarray(self.turn @ v)

    def body(self, v: Array) -> Array:
        """A world vector in the body."""
        return np.asarray(v @ self.turn)


class Fault:
    """An effect. ``place`` and ``form`` are those of a label; ``unit`` says what severity one is."""

    name: ClassVar[str] = ""
    place: ClassVar[str] = "wrench"
    known: ClassVar[bool] = True  # False: the library has nothing of the kind
    form: ClassVar[str] = "differs"
    targets: ClassVar[tuple[str, ...]] = ()  # axes, groups of axes or channels; ("thruster",) for any unit
    both_signs: ClassVar[bool] = False  # whether a severity below zero means something
    event: ClassVar[bool] = False  # begins during the log, always
    unit: ClassVar[str] = ""

    def __init__(self, item: Planted, sheet: Sheet, site: Site, rng: np.random.Generator) -> None:
        self.sheet, self.site, self.rng, self.size = sheet, site, rng, float(item.severity)
        self.target = self._target(item.target)
        late = float(rng.uniform(0.25, 0.6)) * site.seconds
        self.onset = item.onset_s if item.onset_s is not None or not self.event else late
        self.values: dict[str, Any] = {}
        self.prepare()

    def _target(self, wanted: str | None) -> str | None:
        choices = self.sheet.units if self.targets == ("thruster",) else self.targets
        if wanted is None and choices:
            return str(self.rng.choice(choices))
        if wanted is not None and wanted not in choices:
            raise ValueError(f"{self.name}: target {wanted!r} is not one of {', '.join(choices) or 'none'}")
        return wanted

    @property
    def axis(self) -> int:
        """Index of the target axis."""
        return AXES.index(str(self.target))

    @property
    def at_unit(self) -> int:
        """Index of the target thruster."""
        return self.sheet.units.index(str(self.target))

    def on(self, t: float) -> float:
        """0 before the onset, then up to 1 as a first-order lag."""
        return 1.0 if self.onset is None else max(0.0, -math.expm1(-(t - self.onset) / COMES_ON_S)) if t > self.onset else 0.0

    def levels(self, t: Array) -> Array:
        """`on` at many times."""
        return np.array([self.on(float(x)) for x in t])

    @classmethod
    def has(cls, method: str) -> bool:
        """Whether the effect defines a method."""
        return getattr(cls, method) is not getattr(Fault, method)

    def prepare(self) -> None:
        """Work out the effect's numbers and put what a label says into ``values``."""

    def alter(self, hull: Hull, on: float) -> None:
        """Change the hull's numbers."""

    def current(self, t: float, at: Array) -> Array:
        """Velocity (3,) of the water, world."""
        return np.zeros(3)

    def spins(self, n: Array, s: Instant) -> Array:
        """Shaft speeds to the speeds that make thrust."""
        return n

    def pushes(self, thrust: Array, s: Instant) -> Array:
        """Thrust to the thrust that acts."""
        return thrust

    def wrench(self, s: Instant) -> Array:
        """A wrench (6,) about the origin."""
        return np.zeros(6)

    def advance(self, s: Instant, dt: float) -> None:
        """Move the effect's memory on by ``dt``, at the end of a step."""

    def record(self, log: Log, true: Mapping[str, Array], t: Array) -> None:
        """Change channels of the log, in its units."""


def pull(force: Array, arm: Array) -> Array:
    """Wrench of a body force at a point of the body."""
    x, y, z = force.tolist()
    a, b, c = arm.tolist()
    return np.array([x, y, z, b * z - c * y, c * x - a * z, a * y - b * x])
