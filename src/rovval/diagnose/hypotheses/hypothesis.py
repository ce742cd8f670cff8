"""What competes for a gap: the parameters of an effect that are set free, and where they begin."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from rovval.diagnose.criteria import PRIOR_WIDTH
from rovval.diagnose.residuals.perturbations import Columns, Direction
from rovval.effects import Effect, load
from rovval.plant import Plant


@dataclass(frozen=True, slots=True)
class Hypothesis:
    """``name`` as in the contract (``thruster_degraded[HFP]``); ``slots`` all of its parameters; ``columns`` of the linearisation that it
    sets free, with their prior ``sd``; ``at`` where a starting point moves slots to; ``label`` tells starting points apart. ``evident``: the forces that
    are missing show it, whatever the linearisation promises."""

    name: str
    label: str
    slots: tuple[int, ...]
    columns: tuple[int, ...]
    sd: tuple[float, ...]
    at: tuple[tuple[int, float], ...] = ()
    directions: tuple[Direction, ...] = ()
    evident: bool = False

    @property
    def effect(self) -> Effect:
        """The effect of the library that it sets free, whatever its axis or thruster."""
        return load(self.name.partition("[")[0])

    @property
    def of(self) -> str:
        """The axis, thruster or sensor that it belongs to, as its name has it: ``[HFP]``; empty for the vehicle."""
        return self.name.removeprefix(self.effect.name)

    @property
    def whole(self) -> bool:
        """Whether it begins with its full size, well away from nothing, and not with a slope."""
        return any(d.slot < 0 for d in self.directions)


def columns_of(library: Sequence[Hypothesis]) -> Columns:
    """What a linearisation has to hold for every hypothesis of a library."""
    plain = {c for h in library if not h.directions for c in h.columns}
    return Columns(tuple(sorted(plain)), tuple(d for h in library for d in h.directions))


def beginning(plant: Plant, label: str, slots: tuple[int, ...], own: tuple[int, ...], at: tuple[tuple[int, float], ...], next_id: int) -> Hypothesis:
    """A hypothesis whose slots ``own`` are free (-1: the whole change) where the others are moved to ``at``."""
    directions = tuple(Direction(next_id + i, at, slot) for i, slot in enumerate(own))
    sd = tuple(PRIOR_WIDTH * (plant.slots[s].parameter.typical if s >= 0 else 0.5) for s in own)
    return Hypothesis(label.partition("@")[0], label, slots, tuple(d.id for d in directions), sd, at, directions)
