"""A hypothesis: the parameters of one effect, set free, and the initial point of their fit."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from rovval.diagnose.criteria import PRIOR_WIDTH
from rovval.diagnose.problem.prior import wide_sd
from rovval.diagnose.problem.problem import Problem
from rovval.diagnose.residuals.perturbations import Columns, DisplacedColumn
from rovval.diagnose.residuals.ridge import Prior
from rovval.effects import Effect, load
from rovval.plant import Plant

START_SCALE = -1  # in place of a slot: the factor on all that the initial point sets, from 0 (no effect) to 1 (all of it)
START_SCALE_TYPICAL = 0.5  # typical size of that factor: half of what the initial point sets


@dataclass(frozen=True, slots=True)
class Hypothesis:
    """One effect, on one axis or thruster, as the cause of the gap, with one initial point.

    Attributes:
        name: effect and target as in ``--effect``: ``inflow_loss``, ``thruster_degraded[HFP]``.
        label: the name with its initial point, ``waves@3``; unique in a library.
        slots: places of all its parameters in the plant's parameters beta.
        columns: columns of the linearisation that it sets free: slots, and the ids of ``displaced``.
        sd: (len(columns),) standard deviations of their wide prior, in the parameters' units.
        at: (slot, value) that the initial point sets before anything is fitted.
        displaced: columns whose sensitivities are taken at the initial point, not at no effect; empty where it begins at no effect.
        evident: whether the forces that the nominal vehicle lacks show it, so that it is fitted whatever its linearisation promises.
    """

    name: str
    label: str
    slots: tuple[int, ...]
    columns: tuple[int, ...]
    sd: tuple[float, ...]
    at: tuple[tuple[int, float], ...] = ()
    displaced: tuple[DisplacedColumn, ...] = ()
    evident: bool = False

    @property
    def effect(self) -> Effect:
        """The effect of the library, whatever its axis or thruster."""
        return load(self.name.partition("[")[0])

    @property
    def of(self) -> str:
        """The axis, thruster or sensor that it belongs to, as its name has it: ``[HFP]``; empty for the vehicle."""
        return self.name.removeprefix(self.effect.name)

    @property
    def target(self) -> str:
        """The same without brackets: ``HFP``."""
        return self.of.strip("[]")

    def is_one_with(self, other: Hypothesis) -> bool:
        """Whether both are one cause: the same one, or one is what the other is where its own size is nothing (`Effect.includes`)."""
        return self.of == other.of and (self.name == other.name or other.effect.name == self.effect.includes or self.effect.name == other.effect.includes)

    @property
    def axes(self) -> tuple[str, ...]:
        """The axes that it belongs to: one, or those of a group; none for what is of no axis."""
        effect = self.effect
        return effect.groups.get(self.target, (self.target,)) if effect.per == "axis" else ()

    @property
    def from_full_size(self) -> bool:
        """Whether its fit begins with all of the effect at once, away from no effect, where no slope shows it."""
        return any(d.slot == START_SCALE for d in self.displaced)


def columns_of(library: Sequence[Hypothesis]) -> Columns:
    """What a linearisation has to hold for every hypothesis of a library."""
    moved = dict.fromkeys(d for h in library for d in h.displaced)
    plain = {c for h in library for c in h.columns} - {d.id for d in moved}
    return Columns(tuple(sorted(plain)), tuple(moved))


def from_nothing(plant: Plant, name: str, label: str, slots: tuple[int, ...]) -> Hypothesis:
    """A hypothesis that begins at no effect, with all of its ``slots`` free."""
    return Hypothesis(name, label, slots, slots, tuple(wide_sd(plant, slots).values()))


def displaced(plant: Plant, label: str, slots: tuple[int, ...], free: tuple[int, ...], at: tuple[tuple[int, float], ...], next_id: int) -> Hypothesis:
    """A hypothesis that begins where ``at`` sets some of its ``slots``, with the others ``free``, or with `START_SCALE`; its columns are
    numbered from ``next_id`` on."""
    directions = tuple(DisplacedColumn(next_id + i, at, slot) for i, slot in enumerate(free))
    sd = tuple(PRIOR_WIDTH * (plant.slots[s].parameter.typical if s != START_SCALE else START_SCALE_TYPICAL) for s in free)
    return Hypothesis(label.partition("@")[0], label, slots, tuple(d.id for d in directions), sd, at, directions)


def at_full_size(plant: Plant, label: str, slots: tuple[int, ...], values: Mapping[str, float], next_id: int) -> Hypothesis:
    """A hypothesis that begins with all of an effect at once: its parameters where ``values`` has them by name, held within their bounds."""
    own = [(slot, plant.slots[slot].parameter) for slot in slots]
    at = tuple((slot, p.within(values[p.name])) for slot, p in own if p.name in values)
    return displaced(plant, label, slots, (START_SCALE,), at, next_id)


def prior_of(problem: Problem, h: Hypothesis) -> Prior:
    """The wide prior of a hypothesis: of its columns, and of those of its parameters that have a tolerance, wherever it begins."""
    within = wide_sd(problem.plant, [s for s in h.slots if s in problem.tolerance.sd])
    return Prior(within | dict(zip(h.columns, h.sd, strict=True)))
