"""What flows through rovval: RawLog -> Run -> SimResult -> Comparison. Frozen, checked when made, arrays read-only.

Missing is a mask with a reason. Under the mask the stored value is NaN, so that a reader who forgets the mask gets a loud
result; what *says* that a value is missing is always the mask.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import IntEnum
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rovval.core.channels import Channel, Rule, channel
from rovval.core.errors import BadInput, Finding
from rovval.core.long_columns import at_rest, is_at_rest

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
Codes = NDArray[np.uint8]
MOST_OUTSIDE = 0.5  # share of the samples outside its sane range from which a channel is not what its source says (chosen)
FILL_VALUES = 3  # distinct values: no more than these are what an instrument writes while it has nothing to say (-32.768, 9999)
RATE_HZ = 10.0  # the design's common rate; Merlin logs at it (thesis 4.5)


class Reason(IntEnum):
    """Why a sample is missing (0: it is not)."""

    OK = 0
    NOT_LOGGED = 1
    BEFORE_FIRST = 2
    AFTER_LAST = 3
    GAP = 4
    OUT_OF_RANGE = 5
    STUCK = 6
    STOPPED = 7  # simulated only: the state left sane limits or an input was missing
    SATURATED = 8  # the sensor was at its stop


def frozen_array(values: Any, dtype: Any = np.float64) -> NDArray[Any]:
    """A read-only copy (a frozen dataclass alone does not freeze its arrays); an array that nobody can write to any more as it is."""
    if isinstance(values, np.ndarray) and values.dtype == dtype and not values.flags.writeable and (values.flags.owndata or is_at_rest(values)):
        return values
    copy = np.array(values, dtype=dtype)
    copy.setflags(write=False)
    return copy


@dataclass(frozen=True, slots=True)
class Series:
    """One logged channel in SI at its own stamps. ``t`` (n,) s since the log's ``t0_ns``, strictly increasing; ``values`` (n,)
    finite. ``stamp`` says which clock the stamps come from: "row", "header" or "record"."""

    t: Array
    values: Array
    stamp: str

    def __post_init__(self) -> None:
        object.__setattr__(self, "t", at_rest(frozen_array(self.t)))
        object.__setattr__(self, "values", at_rest(frozen_array(self.values)))
        if self.t.shape != self.values.shape or self.t.ndim != 1:
            raise BadInput(f"a channel has {self.values.shape} values at {self.t.shape} stamps")
        if not np.isfinite(self.values).all() or (np.diff(self.t) <= 0).any():
            raise BadInput("a channel's values must be finite and its stamps strictly increasing", "clean it in its reader")

    def outside(self, row: Channel) -> Flags:
        """Which samples (n,) are outside the sane range of a ``row`` of the channel table."""
        return np.asarray((self.values < row.low) | (self.values > row.high))

    def mostly_outside(self, row: Channel) -> bool:
        """Whether so many are, moving, that the channel is not what its source says, in another unit for one: its rest is no measurement either."""
        outside = self.outside(row)
        return bool(outside.mean() > MOST_OUTSIDE and len(np.unique(self.values[outside])) > FILL_VALUES)


@dataclass(frozen=True, slots=True)
class Marker:
    """A moment of a log that it names itself: ``t_s`` s after its start, what stands there."""

    t_s: float
    name: str


@dataclass(frozen=True, slots=True)
class RawLog:
    """A log as logged: channels by their name of `rovval.core.channels`, already SI, forward-starboard-down and north-east-down.

    ``t0_ns`` is the UTC epoch of t = 0 in ns where the log knows it; ``properties`` are facts beside the channels (latitude of
    the origin, topics read). ``vehicle`` is the profile's vehicle name or "". ``rules`` is what the profile says of a channel's
    resampling otherwise than the channel table. ``markers`` are in the order of time.
    """

    source: str
    sha256: str
    profile: str
    vehicle: str
    t0_ns: int | None
    channels: Mapping[str, Series]
    findings: tuple[Finding, ...] = ()
    properties: Mapping[str, str] = field(default_factory=dict)
    rules: Mapping[str, Rule] = field(default_factory=dict)
    markers: tuple[Marker, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "channels", MappingProxyType(dict(self.channels)))
        object.__setattr__(self, "properties", MappingProxyType(dict(self.properties)))
        object.__setattr__(self, "rules", MappingProxyType(dict(self.rules)))
        if not self.channels:
            raise BadInput(f"{self.source}: no channel of profile {self.profile!r} is in this log", "see `rovval show profile`")
        for name in self.channels:
            channel(name)


@dataclass(frozen=True, slots=True)
class Resampled:
    """How one channel came to the grid: method, samples in the log, median period and largest gap (s), longest gap bridged
    (s), and the share of grid points that hold a value."""

    method: str
    samples: int
    period_s: float
    largest_gap_s: float
    bridged_gap_s: float
    coverage: float


@dataclass(frozen=True, slots=True)
class ClockReport:
    """What the stamps are worth: which clock, samples matched to the grid, largest gap, and the estimated offset between
    thrusters and navigation (s, positive: navigation is stamped late), with its correlation; None where it cannot be had."""

    stamp: str
    samples: int
    matched: int
    largest_gap_s: float
    offset_s: float | None
    correlation: float | None
    note: str = ""


@dataclass(frozen=True, slots=True)
class Run:
    """A log on the 10 Hz grid. ``values[name]`` (n,) in SI with NaN under the mask, ``reasons[name]`` (n,) `Reason` codes. ``markers`` are in the
    order of time, s since the first grid point."""

    id: str
    source: str
    sha256: str
    profile: str
    vehicle: str
    t0_ns: int | None
    dt: float
    values: Mapping[str, Array]
    reasons: Mapping[str, Codes]
    resampled: Mapping[str, Resampled]
    clock: ClockReport
    findings: tuple[Finding, ...] = ()
    properties: Mapping[str, str] = field(default_factory=dict)
    markers: tuple[Marker, ...] = ()

    def __post_init__(self) -> None:
        sizes = {v.shape for v in self.values.values()} | {r.shape for r in self.reasons.values()}
        if len(sizes) != 1 or set(self.values) != set(self.reasons):
            raise BadInput(f"run {self.id}: channels of unequal length or without mask: {sizes}")
        masked = {n: np.where(self.reasons[n] == Reason.OK, v, np.nan) for n, v in self.values.items()}
        object.__setattr__(self, "values", MappingProxyType({n: frozen_array(v) for n, v in masked.items()}))
        object.__setattr__(
            self, "reasons", MappingProxyType({n: frozen_array(r, np.uint8) for n, r in self.reasons.items()})
        )
        for name in ("resampled", "properties"):
            object.__setattr__(self, name, MappingProxyType(dict(getattr(self, name))))

    def __len__(self) -> int:
        return len(next(iter(self.values.values())))

    @property
    def t(self) -> Array:
        """Time of each grid point, s since the first (n,)."""
        return np.asarray(np.arange(len(self)) * self.dt, dtype=np.float64)

    @property
    def duration_s(self) -> float:
        """From the first grid point to the last (s)."""
        return (len(self) - 1) * self.dt

    def measured(self, name: str) -> bool:
        """Whether the channel was logged and holds at least one value."""
        return name in self.values and bool(self.ok(name).any())

    def ok(self, name: str) -> Flags:
        """Where the channel holds a value (n,); all False for a channel that was not logged."""
        if name not in self.reasons:
            return np.zeros(len(self), dtype=bool)
        return np.asarray(self.reasons[name] == Reason.OK)

    def get(self, name: str) -> Array:
        """The channel with NaN under its mask (n,); all NaN for a channel that was not logged."""
        return self.values[name] if name in self.values else np.full(len(self), np.nan)

    def stack(self, names: tuple[str, ...]) -> Array:
        """Several channels side by side (n, len(names)), NaN under each one's mask."""
        return np.stack([self.get(name) for name in names], axis=1)


@dataclass(frozen=True, slots=True)
class Trajectory:
    """A simulated motion on the run's grid: body velocity ``nu`` (n, 6) m/s and rad/s, pose ``eta`` (n, 6) m and rad (north-east-
    down, Euler zyx), NaN where ``reasons`` (n,) says why it is missing; ``stretch`` (n,) numbers the restart that a sample
    belongs to (-1: none)."""

    nu: Array
    eta: Array
    reasons: Codes
    stretch: NDArray[np.int64]

    def __post_init__(self) -> None:
        for name, dtype in (("nu", float), ("eta", float), ("reasons", np.uint8), ("stretch", np.int64)):
            object.__setattr__(self, name, frozen_array(getattr(self, name), dtype))

    @property
    def ok(self) -> Flags:
        """Where the motion was simulated (n,)."""
        return np.asarray(self.reasons == Reason.OK)


@dataclass(frozen=True, slots=True)
class SimResult:
    """A run's motion as the simulator has it: ``free`` from its first sample, ``windowed`` restarted from the measured state every
    ``window_s``; ``thruster_speed`` (n, k) rev/s as used, ``thrust`` (n, k) N at rest in the water, and what was assumed."""

    run_id: str
    vehicle: str
    vehicle_hash: str
    model: str
    effects: tuple[str, ...]
    window_s: float
    dt: float
    thrusters: tuple[str, ...]
    input_source: str
    free: Trajectory
    windowed: Trajectory
    thruster_speed: Array
    thrust: Array
    assumptions: tuple[str, ...] = ()
    stops: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "thruster_speed", frozen_array(self.thruster_speed))
        object.__setattr__(self, "thrust", frozen_array(self.thrust))


@dataclass(frozen=True, slots=True)
class ChannelError:
    """How far one simulated channel is from the measured one, over ``n`` samples (``coverage`` of the run).

    Errors are simulated minus measured, in ``unit``; ``iae`` in unit * s. ``baseline_rmse`` is the error of the predictor that
    says "no motion" (velocities) or "stays where the stretch began" (pose), ``skill`` is 1 - mse / mse(baseline). ``noise`` is the standard deviation of
    the sensor's white noise, in ``unit``: errors of that size say nothing of a simulator. ``intervals`` are (low, high) of 90 % of the errors and the
    skill, by name; none where the log is too short to tell.
    """

    channel: str
    unit: str
    mean_error: float
    iae: float
    mae: float
    rmse: float
    n: int
    coverage: float
    baseline_mae: float
    baseline_rmse: float
    skill: float | None
    extra: Mapping[str, float] = field(default_factory=dict)
    noise: float = 0.0
    intervals: Mapping[str, tuple[float, float]] = field(default_factory=dict)

    @property
    def misleads(self) -> bool:
        """Whether the simulator is further from the vehicle than the trivial predictor, by more than the sensor's noise."""
        return self.rmse**2 - self.baseline_rmse**2 > self.noise**2


@dataclass(frozen=True, slots=True)
class TrackError:
    """Errors of position along a track of ``n`` poses, m: rms from one start, after the best rigid alignment, and of the way made in ``step_s``; the last
    is None for a track that is shorter than that."""

    n: int
    ate: float
    ate_aligned: float
    rpe: float | None
    step_s: float


@dataclass(frozen=True, slots=True)
class Comparison:
    """A run beside a simulation of it: per axis the error of the free run and of the restarted windows, and of pose channels.
    An axis that the run does not hold is absent from the tables and named in ``not_measured``."""

    run: Run
    sim: SimResult
    free: Mapping[str, ChannelError]
    windowed: Mapping[str, ChannelError]
    pose: Mapping[str, ChannelError]
    not_measured: tuple[str, ...]
    other: Mapping[str, ChannelError] = field(default_factory=dict)
    other_name: str = ""
    other_nu: Array | None = None
    track: TrackError | None = None
