"""What a mission came to: the motion, what the loop believed and asked for, how well set-points were held, and the spread over tolerances."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from hashlib import sha256
from types import MappingProxyType

import numpy as np

from rovval.core.channels import POSE, VELOCITIES
from rovval.core.data import Array, ClockReport, Flags, Reason, Run
from rovval.core.frames import wrap
from rovval.fly.mission import Mission
from rovval.fly.plan import Phase

QUANTILES = (0.05, 0.5, 0.95)
SPREAD = ("z", "psi", "u", "v", "x", "y")  # what the spread over draws is told of


@dataclass(frozen=True, slots=True)
class Held:
    """How one set-point of a leg was held by the true motion: ``step`` from where the leg began, ``error`` at its end (true minus asked), ``overshoot``
    beyond it, ``settled_s`` after which it stayed within 5 % of the step (None: it did not, or there was no step); in ``unit``.

    ``draws`` (D,) are the errors at the end over tolerances.
    """

    leg: str
    quantity: str
    unit: str
    set_point: float
    step: float
    error: float
    overshoot: float
    settled_s: float | None
    draws: Array | None = None


@dataclass(frozen=True, slots=True)
class Passed:
    """How near the true motion came to a way point, m, and when, s; ``draws`` (D,) the distances over tolerances."""

    leg: str
    point: tuple[float, float, float]
    distance: float
    at_s: float
    draws: Array | None = None


@dataclass(frozen=True, slots=True)
class Flight:
    """A mission that was flown, ``n`` samples ``dt`` s apart, ``k`` thrusters. SI, body axes forward-starboard-down, world north-east-down.

    ``nu`` and ``eta`` (n, 6) are the true motion, ``seen_nu`` and ``seen_eta`` what the loop was closed on (the same on perfect state). ``speed`` (n, k)
    rev/s is what the thrusters did, ``command`` what they were told; ``wrench`` (n, 6) what the autopilot asked for and ``given`` (n, 6) the share of it that
    the thrusters' limits allowed. ``set_points`` (n,) by channel, NaN where nothing was asked. ``spread`` (len(QUANTILES), n) by channel of `SPREAD`,
    over ``draws`` vehicles within tolerance.
    """

    mission: Mission
    vehicle: str
    vehicle_hash: str
    model: str
    effects: tuple[str, ...]
    seed: int
    noise: float
    draws: int
    dt: float
    thrusters: tuple[str, ...]
    phases: tuple[Phase, ...]
    nu: Array
    eta: Array
    seen_nu: Array
    seen_eta: Array
    altitude: Array | None
    seen_altitude: Array | None
    speed: Array
    command: Array
    wrench: Array
    given: Array
    set_points: Mapping[str, Array]
    held: tuple[Held, ...]
    passed: tuple[Passed, ...]
    spread: Mapping[str, Array] = field(default_factory=dict)
    stops: tuple[str, ...] = ()
    draws_stopped: int = 0
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "set_points", MappingProxyType(dict(self.set_points)))
        object.__setattr__(self, "spread", MappingProxyType(dict(self.spread)))

    def __len__(self) -> int:
        return len(self.nu)

    @property
    def t(self) -> Array:
        """Time of each sample, s (n,)."""
        return np.asarray(np.arange(len(self)) * self.dt)

    @property
    def on_sensors(self) -> bool:
        """Whether sensors closed the loop, and not the true state."""
        return self.mission.sensors is not None and self.noise > 0

    def saturated(self) -> Flags:
        """Samples (n,) in which the thrusters could not give all that was asked."""
        return np.asarray((self.given < 1.0).any(axis=1))

    def run(self, name: str = "", truth: bool = False) -> Run:
        """The flight as the log that the vehicle would keep (with ``truth``: of the true motion): what every other command of rovval works on."""
        nu, eta, altitude = (self.nu, self.eta, self.altitude) if truth else (self.seen_nu, self.seen_eta, self.seen_altitude)
        origin = np.array([self.eta[0, 0], self.eta[0, 1], 0.0, 0.0, 0.0, 0.0])
        values = {n: nu[:, i] for i, n in enumerate(VELOCITIES)} | {n: (eta - origin)[:, i] for i, n in enumerate(POSE)}
        values |= {n: wrap(values[n]) for n in ("phi", "theta", "psi")}
        if altitude is not None:
            values["altitude"] = altitude
        for j, thruster in enumerate(self.thrusters):
            values |= {f"n:{thruster}": self.speed[:, j], f"n_cmd:{thruster}": self.command[:, j]}
        reasons = {c: np.where(np.isfinite(v), Reason.OK, Reason.NOT_LOGGED).astype(np.uint8) for c, v in values.items()}
        said = f"flown by rovval ({self.model}{', ' + ', '.join(self.effects) if self.effects else ''}), nothing was measured"
        text = self.mission.model_dump_json() + repr((self.vehicle_hash, self.model, self.effects, self.seed, self.noise, truth))
        return Run(
            id=name or f"{self.mission.name}-{self.vehicle}-{self.model}", source=f"mission {self.mission.name}", sha256=sha256(text.encode()).hexdigest(),
            profile="", vehicle=self.vehicle, t0_ns=None, dt=self.dt, values=values, reasons=reasons, resampled={},
            clock=ClockReport("row", len(self), len(self), self.dt, None, None, "flown, not recorded"),
            properties={"synthetic": said, "seed": str(self.seed), "loop": "closed on sensors" if self.on_sensors else "closed on the true state"},
        )  # fmt: skip
