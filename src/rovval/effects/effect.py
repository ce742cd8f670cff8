"""What an effect is: everything that an engineer, the plant and the diagnosis have to know of one, stated in its own file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Literal

Place = Literal["vehicle", "input", "water", "wrench", "sensor"]
Kind = Literal["", "weight", "drag", "speed"]


@dataclass(frozen=True, slots=True)
class Parameter:
    """One number of an effect. ``typical`` is the 1-sigma prior size of its departure from ``null``; ``low`` and ``high`` are
    refused beyond, never clipped. ``sized`` says that low, high and typical are for a BlueROV2 and grow with the vehicle's
    weight, surge drag or thruster speed (`plant.slots`). ``target`` sets a parameter of an effect that is neither per axis nor per
    thruster apart, as a hypothesis of its own: ``time_offset[velocity]``, ``p["delay[velocity]"]``. ``needs``: the channel without which it
    does nothing and is refused."""

    name: str
    unit: str
    low: float
    high: float
    null: float
    typical: float
    source: str
    sized: Kind = ""
    target: str = ""
    needs: str = ""

    def __post_init__(self) -> None:
        if not self.low <= self.null <= self.high or not self.low < self.high or not self.typical > 0:
            raise ValueError(f"parameter {self.name}: needs low <= null <= high, low < high and typical > 0")


@dataclass(frozen=True, slots=True)
class Effect:
    """One effect as an engineer reads it: where it enters, its equation with source, its parameters, what one sees, what it is
    confused with and what separates it. ``needs``: channels without which it cannot be tested; ``within``: what a channel has to
    come below, in its unit, for it to act at all. ``grid``: start points for parameters that linearisation at the null value
    cannot see (``onset`` as a fraction of the run); ``where``: parameters that begin where a channel stood at the onset;
    ``levers``: coordinates of the point where a force acts, which it cannot see either, the one ahead first. ``apart``: each
    parameter may well be at work without the others, as an offset along one of three axes, and is tried by itself, too.
    ``refines``: parameters that only refine the others, which are tried without them as well; of an effect that is also
    ``apart`` they say of one axis what the others say of all, and are tried one by one only. ``competes`` False: a tolerance
    that healthy vehicles have, which a diagnosis takes into account and never names."""

    name: str
    title: str
    place: Place
    equation: str
    parameters: tuple[Parameter, ...]
    signature: str
    confused_with: tuple[str, ...]
    separates: str
    per: Literal["", "axis", "thruster"] = ""
    axes: tuple[str, ...] = ()
    needs: tuple[str, ...] = ()
    within: Mapping[str, float] = field(default_factory=dict)
    grid: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    where: Mapping[str, str] = field(default_factory=dict)
    levers: tuple[str, ...] = ()
    apart: bool = False
    refines: tuple[str, ...] = ()
    competes: bool = True

    def __post_init__(self) -> None:
        object.__setattr__(self, "within", MappingProxyType(dict(self.within)))
        object.__setattr__(self, "grid", MappingProxyType(dict(self.grid)))
        object.__setattr__(self, "where", MappingProxyType(dict(self.where)))

    @property
    def begins(self) -> bool:
        """Whether it has an onset of its own."""
        return any(p.name == "onset" for p in self.parameters)

    @property
    def searched(self) -> bool:
        """Whether it begins or turns at a time or place that a diagnosis searches for: a fit from the null value cannot find it."""
        return bool(self.grid) or self.begins

    def of_one_axis(self, parameter: str) -> bool:
        """Whether a parameter says of one axis what another says of all."""
        return self.apart and parameter in self.refines
