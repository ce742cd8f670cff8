"""The shape of a planted effect: one class, a few hooks, and a description that the catalogue prints.

An effect overrides only the hooks it needs; the plant calls only those that are overridden. All hooks see SI units and body
axes unless they say otherwise, thruster speed in rpm. ``self.level(t)`` is 0 before the onset and ramps to 1 over two seconds.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import ClassVar, Literal

import numpy as np

from rovval.blind.plant.nominal_vehicle import NominalVehicle
from rovval.blind.plant.parameters import Params
from rovval.blind.plant.rotation import Matrix
from rovval.blind.plant.scales import Scales
from rovval.blind.plant.spec import AXES, Array, Planted

RAMP_S = 2.0  # chosen: nothing fails in an instant
Flow = tuple[float, float, float, float, float, float, float, float]
STILL: Flow = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Setting:
    """What a flight's surroundings are, drawn from the seed alone (never from what is planted)."""

    seed: int
    duration_s: float
    depth: float  # m, start
    bottom: float  # m, depth of the flat bottom
    heading: float  # rad, start
    anchor: Array  # (3,), NED m, upper end of the tether
    droop: float  # share of the supply voltage lost by the end
    volts: float


@dataclass(slots=True)
class Kinematics:
    """The instant, as the hooks see it; refilled by every call of the right-hand side."""

    t: float = 0.0
    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    r: Matrix = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
    vel: list[float] = field(default_factory=lambda: [0.0] * 6)  # over ground, body
    rel: list[float] = field(default_factory=lambda: [0.0] * 6)  # through the water, body
    water: Flow = STILL
    n: Array = field(default_factory=lambda: np.zeros(0))  # shaft speed, rpm
    turn: Array = field(default_factory=lambda: np.zeros(0))  # speed that makes thrust, rpm
    static: Array = field(default_factory=lambda: np.zeros(0))  # thrust of the static curve, N
    thrust: Array = field(default_factory=lambda: np.zeros(0))  # thrust that acts, N
    volts: float = 1.0  # supply over nominal
    altitude: float = 1e9


@dataclass(slots=True)
class Planting:
    """What an effect is built from."""

    item: Planted
    nominal: NominalVehicle
    scale: Scales
    setting: Setting
    rng: np.random.Generator


class Effect:
    """Base of every planted effect: no hook does anything."""

    name: ClassVar[str] = ""
    place: ClassVar[Literal["vehicle", "input", "water", "wrench", "sensor"]] = "wrench"
    known: ClassVar[bool] = True  # False: foreign, the library has nothing of the kind
    form: ClassVar[Literal["equal", "differs"]] = "differs"
    targets: ClassVar[tuple[str, ...]] = ()  # axes, channels, or ("thruster",)
    least: ClassVar[float] = 0.0  # severities below this mean nothing
    event: ClassVar[bool] = False  # has an onset even where none is asked for
    unit: ClassVar[str] = ""  # what severity 1 is

    def __init__(self, plan: Planting) -> None:
        item = plan.item
        self.plan, self.s = plan, float(item.severity)
        self.target = self._aim(item.target, plan)
        self.onset = item.onset_s
        draw = float(plan.rng.uniform(0.3, 0.65))
        if self.onset is None and self.event:
            self.onset = draw * plan.setting.duration_s
        self.values: dict[str, float | str | list[float]] = {}
        self.setup(plan)

    def _aim(self, target: str | None, plan: Planting) -> str | None:
        choices = plan.nominal.thrusters if self.targets == ("thruster",) else self.targets
        if target is None:
            return str(plan.rng.choice(choices)) if self.targets == ("thruster",) else next(iter(choices), None)
        if target not in choices:
            raise ValueError(f"{self.name}: target {target!r} is not one of {', '.join(choices) or 'none'}")
        return target

    def setup(self, plan: Planting) -> None:
        """Draw and scale the numbers; put what a label should say into ``self.values``."""

    def level(self, t: float) -> float:
        """0 before the onset, 1 two seconds after (smooth step)."""
        if self.onset is None:
            return 1.0
        x = min(1.0, max(0.0, (t - self.onset) / RAMP_S))
        return x * x * (3.0 - 2.0 * x)

    @property
    def axis(self) -> int:
        """Index of the target axis."""
        return AXES.index(self.target or "surge")

    @property
    def unit_index(self) -> int:
        """Index of the target thruster."""
        return self.plan.nominal.thrusters.index(self.target or "")

    def change(self, p: Params, a: float) -> None:
        """Place ``vehicle``: alter the parameters in place, at level ``a``."""

    def tick(self, k: Kinematics) -> None:
        """Once a control step, before it is integrated: random walks, events, memory."""

    def flow(self, t: float, x: float, y: float, z: float) -> Flow:
        """Water velocity (NED), its local time derivative, and the z-derivative of the two horizontal components."""
        return STILL

    def speed(self, n: Array, k: Kinematics) -> Array:
        """Shaft speed (rpm) to the speed that makes thrust."""
        return n

    def thrust(self, thrust: Array, k: Kinematics, own: Array) -> Array:
        """Thrust (N) to the thrust that acts. ``own`` is this effect's slice of the state."""
        return thrust

    def wrench(self, k: Kinematics, own: Array, f: list[float]) -> None:
        """Add a body wrench about the origin (N, N m) to ``f``."""

    def start(self, k: Kinematics) -> Array:
        """Initial values of this effect's own states (empty: none)."""
        return np.zeros(0)

    def derivative(self, k: Kinematics, own: Array) -> Array:
        """Time derivative of the own states."""
        return own

    def record(self, log: dict[str, Array], true: Mapping[str, Array], t: Array) -> None:
        """Place ``sensor``: alter the measured channels (CSV names, CSV units) in place."""

    @classmethod
    def overrides(cls, hook: str) -> bool:
        """Whether this effect implements ``hook``."""
        return getattr(cls, hook) is not getattr(Effect, hook)
