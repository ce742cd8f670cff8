"""What an effect is: everything that an engineer, the plant and the diagnosis have to know of one, stated in its own file.

Nothing outside `rovval.effects` decides by the name of an effect: it asks for the properties that are defined here.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from math import nextafter
from types import MappingProxyType
from typing import Literal, get_args

from rovval.vehicle.model import Vehicle

Place = Literal["vehicle", "input", "water", "wrench", "sensor"]
Growth = Literal["", "weight", "length", "drag", "speed"]
Role = Literal[
    "size", "onset", "period", "further period", "direction", "datum", "level", "bottom", "extent", "anchor", "lever", "threshold"
]  # fmt: skip
Error = Literal["additive", "factor", "delay"]
Stage = Literal["", "position", "mounting", "scale", "bias", "filter", "delay"]
Family = Literal["", "drag", "thrust", "allocation", "mass", "trim"]
TOGETHER = {"translation": ("surge", "sway", "heave"), "rotation": ("roll", "pitch", "yaw")}  # axes that one wrong estimate of a hull has off alike
GROWS = {  # what sized parameters go by
    "weight": "the weight", "length": "the cube root of the weight", "drag": "the drag at 1 m/s ahead", "speed": "the thrusters' speed at 1 m/s ahead",
}  # fmt: skip
STAGES: tuple[str, ...] = get_args(Stage)
FAMILIES: tuple[str, ...] = get_args(Family)[1:]
SIZES = ("size", "lever", "threshold")  # roles of parameters that have a null value of their own; the others only place an effect


@dataclass(frozen=True, slots=True)
class Tolerance:
    """By how much a parameter of a healthy vehicle or sensor may be off: the standard deviation of its prior, before anything is blamed.

    ``sd`` is in the parameter's unit, a number or a function of (parameter as this vehicle has it, vehicle, axis or thruster). Of a ``calibrated``
    one it is per unit of the declared calibration tolerance (`--calibration-slop`, relative, 0.05 by default); of others, which are a matter of
    mounting and sensors, it is as it stands. ``source`` says where it comes from. ``loop_gain``: under an autopilot that steadies the axis, or roll
    or pitch for a parameter that belongs to none, it widens by (1 + loop gain) to this power, since the motion shows that much less of the coefficient.
    """

    sd: float | Callable[[Parameter, Vehicle, str], float]
    source: str
    calibrated: bool = True
    loop_gain: float = 0.0

    def of(self, parameter: Parameter, vehicle: Vehicle, target: str, calibration: float) -> float:
        """Standard deviation in the parameter's unit, for a vehicle, an axis or thruster, and a relative calibration tolerance."""
        sd = self.sd(parameter, vehicle, target) if callable(self.sd) else self.sd
        return calibration * sd if self.calibrated else sd

    def widened(self, sd: float, target: str, gain: Mapping[str, float]) -> float:
        """``sd`` under an autopilot with the loop ``gain`` of each axis that it steadies."""
        own = gain.get(target, 0.0) if target else max(gain["roll"], gain["pitch"])
        return sd * (1.0 + own) ** self.loop_gain if self.loop_gain else sd


@dataclass(frozen=True, slots=True)
class Parameter:
    """One number of an effect.

    - ``name``, ``unit`` (SI, rad), ``source``: where its range comes from.
    - ``low``, ``high``: refused beyond, never clipped. ``null``: the value at which it changes nothing, to the last bit. ``typical``: standard
      deviation of its departure from ``null`` where the effect is at work.
    - ``sized``: low, high, null, typical and starts are those of a BlueROV2 and grow with the vehicle's weight, its length (vehicles of one shape: the cube
      root of the weight), surge drag or thruster speed (`plant.slots`).
    - ``target`` sets a parameter of an effect that is neither per axis nor per thruster apart, as a hypothesis of its own:
      ``time_offset[velocity]``, ``p["delay[velocity]"]``.
    - ``needs``: the channel without which it does nothing and is refused.
    - ``role``: what it says of the effect. ``size``: how strong it is; ``onset``: when it begins (s since the run's start); ``period`` (s) and
      ``direction`` (rad from north) of a swing, and ``further period`` (s) of another one that comes with it; ``datum``: the depth (m) at which what
      changes with depth is zero; ``level``: a depth (m) from which others are counted; ``bottom``: the depth (m) of the seabed; ``extent``: how
      far it reaches or how long it takes; ``anchor``: a coordinate of a point that it is tied to; ``lever``: a coordinate, body axes, of the point
      where its force acts; ``threshold``: the shaft speed below which it acts, for which the search begins at speeds that the log holds.
    - ``starts``: values from which the search begins, for what a linearisation at the null value cannot see.
    - ``instead_of``: the channel in whose place it stands: free only where a log does not hold that, and without the one or the other the effect is refused.
    - ``channel``: of an anchor, the channel that holds the vehicle's own coordinate; the search begins where the vehicle was.
    - ``tolerance``: how far off it is in a healthy vehicle or log; None: not at all.
    - ``vanishes_at``: the bound at which nothing is left of what it scales (a coefficient, a thruster's thrust): an answer that rests there is one,
      at any other bound the search would have gone on.
    - ``genuine_from``: the least value at which the effect is what its name says.
    - ``error``: how a sensor's parameter enters what it measures: added, as a factor, or as a delay, which its opposite undoes.
    """

    name: str
    unit: str
    low: float
    high: float
    null: float
    typical: float
    source: str
    sized: Growth = ""
    target: str = ""
    needs: str = ""
    instead_of: str = ""
    role: Role = "size"
    starts: tuple[float, ...] = ()
    channel: str = ""
    tolerance: Tolerance | None = None
    vanishes_at: Literal["", "low", "high"] = ""
    genuine_from: float | None = None
    error: Error = "additive"

    def __post_init__(self) -> None:
        if not self.low <= self.null <= self.high or not self.low < self.high or not self.typical > 0:
            raise ValueError(f"parameter {self.name}: needs low <= null <= high, low < high and typical > 0")
        if (self.role == "anchor") != bool(self.channel):
            raise ValueError(f"parameter {self.name}: an anchor, and nothing else, names the channel of its coordinate")

    @property
    def delays(self) -> bool:
        """Whether it delays something by as much as it is large, or by ever more."""
        return self.role == "size" and self.unit in ("s", "s/s")

    @property
    def places(self) -> bool:
        """Whether it only places an effect in time or space: it has no null value of its own, and is no departure."""
        return self.role not in SIZES

    def within(self, value: float) -> float:
        """The value, or the bound that it is beyond; short of a bound at which a parameter that stands in a channel's place would be none."""
        high = nextafter(self.high, self.low) if self.instead_of and self.high == self.null else self.high
        return min(max(value, self.low), high)


@dataclass(frozen=True, slots=True)
class Effect:
    """One effect, as an engineer reads it and as the diagnosis needs it.

    To read: ``title``; ``place`` where it enters; ``equation`` in plain mathematics and ``symbols``, each with what it is, its unit and frame;
    ``parameters``; ``signature``: what one sees in a log; ``confused_with``: effects that look alike and what ``separates`` them; ``literature``.

    What the engine asks:

    - ``per``: its parameters belong to each axis of ``axes``, to each thruster, or to the vehicle (empty).
    - ``groups``: names of several of its ``axes`` that may well depart as one, each a hypothesis of its own (``added_mass[translation]``) beside the axes
      by themselves; their parameters are relative departures, and 1 + departure multiplies.
    - ``needs``: channels without which it cannot be tested; ``needs_one_of``: channels of which one will do; ``within``: what a channel has to come
      below, in its unit, for it to act at all.
    - ``separable``: each parameter may well be at work without the others, as an offset along one of three axes, and is tried by itself, too.
    - ``refines``: parameters that only refine the others, which are tried without them as well; of an effect that is also ``separable`` they are
      other forms of it (of one axis what the others say of all), and are tried one by one only.
    - ``far``: sizes, in typical ones, of initial points well away from the null value, of every parameter in turn.
    - ``competes`` False: a diagnosis never names it; `unnamed` says why.
    - ``wanders``: its value drifts by nature, so that it does not hold still speaks in no way against it.
    - ``lasts``: it grows for as long as it lasts, so that one that began before the log is still told from its like by that.
    - ``held``: it pulls towards a point as a tether does that is caught there, so that its search begins where a spring would hold the vehicle, too.
    - ``towed``: it brakes across the line along which it pulls, so that its search begins where such a line is seen in the forces that are missing, too.
    - ``continues``: the effect that imitates it as far as that goes, and which it exceeds (a dead thruster is one that is half reversed).
    - ``includes``: the effect that it is where its own size is nothing; parameters of the same name are the same. That one is searched for from there, too.
    - ``family``: the name by which `rovval fit` tunes it along with others of its kind.
    - ``option``: by what name `rovval fit` asks for it in addition, alone or with others: every vehicle has it to some degree, and no file.
    - ``in_file``: whether it is a number of the vehicle's file that is off, rather than something that no file holds.
    - ``absent_in``: platforms whose equations lack what it scales: there is nothing to take away.
    - ``stage``: where on the way from the true motion into the log a sensor's effect acts.
    """

    name: str
    title: str
    place: Place
    equation: str
    parameters: tuple[Parameter, ...]
    signature: str
    confused_with: tuple[str, ...]
    separates: str
    symbols: Mapping[str, str] = field(default_factory=dict)
    literature: tuple[str, ...] = ()
    per: Literal["", "axis", "thruster"] = ""
    axes: tuple[str, ...] = ()
    groups: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    needs: tuple[str, ...] = ()
    needs_one_of: tuple[str, ...] = ()
    within: Mapping[str, float] = field(default_factory=dict)
    separable: bool = False
    refines: tuple[str, ...] = ()
    far: tuple[float, ...] = ()
    competes: bool = True
    wanders: bool = False
    lasts: bool = False
    held: bool = False
    towed: bool = False
    continues: str = ""
    includes: str = ""
    family: Family = ""
    absent_in: tuple[str, ...] = ()
    option: str = ""
    in_file: bool = False
    stage: Stage = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "symbols", MappingProxyType(dict(self.symbols)))
        object.__setattr__(self, "groups", MappingProxyType(dict(self.groups)))
        object.__setattr__(self, "within", MappingProxyType(dict(self.within)))

    def has(self, role: Role) -> bool:
        """Whether one of its parameters has that role."""
        return any(p.role == role for p in self.parameters)

    def names_of(self, role: Role) -> tuple[str, ...]:
        """Names of the parameters with that role, in order."""
        return tuple(p.name for p in self.parameters if p.role == role)

    @property
    def unnamed(self) -> str:
        """Why a diagnosis never names it; "" where it competes."""
        if self.competes:
            return ""
        if any(p.tolerance for p in self.parameters):
            return "a tolerance of healthy vehicles: a diagnosis takes it into account and never names it as a cause"
        return "for missions and simulations: no diagnosis names it as a cause"

    @property
    def begins(self) -> bool:
        """Whether it has an onset of its own."""
        return self.has("onset")

    @property
    def searched(self) -> bool:
        """Whether it begins or turns at a time or place that a diagnosis searches for: a fit from the null value cannot find it."""
        return self.begins or any(p.starts for p in self.parameters)

    def is_another_form(self, parameter: str) -> bool:
        """Whether a parameter is another form of the effect, as of one axis what another parameter says of all."""
        return self.separable and parameter in self.refines
