"""What the NumPy twin keeps of one run, and how it calls the effects' functions of the state."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rovval.effects.lanes import Lanes
from rovval.plant import geometry
from rovval.plant.codegen.spec import PER_THRUSTER, Hook, hooks
from rovval.plant.inputs import Inputs, Prepared
from rovval.plant.lowering import Lowered
from rovval.plant.model import Plant

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


@dataclass
class Run:
    """What stays the same through one run: the plant, its lowered lanes, the log."""

    plant: Plant
    lowered: Lowered
    inputs: Inputs
    prepared: Prepared
    start: Indices
    which: Indices
    gain: Array
    lanes: Lanes
    mass: Array  # (B, 6, 6) M_RB
    memory: Array  # (B, k) lagged speed
    filtered: Array  # (B, 6) filtered acceleration, of a platform whose engine takes added mass as a force
    before: Array | None = None  # (B, 6) velocity relative to the water at the step before

    def __post_init__(self) -> None:
        vehicle = self.plant.vehicle
        self.place = np.array([t.position for t in vehicle.thruster])
        self.jets, self.side = geometry.jets(vehicle), geometry.hull_side(vehicle)


def _call(run: Run, hook: Hook, names: Mapping[str, Any]) -> Any:
    """One effect's function of the state with its own rows and whatever else it asks for by name."""
    own = {row.partition(".")[2]: value for row, value in run.lowered.rows.items() if row.startswith(hook.effect + ".")}
    if hook.kind in PER_THRUSTER:
        own = {row: value[:, None] if value.ndim == 1 else value for row, value in own.items()}
    return hook.function(**{a: own[hook.row(a)] if a in own else names[a] for a in hook.arguments})


def chain(run: Run, kind: str, value: Array, names: Mapping[str, Array]) -> Array:
    """Speed or thrust (B, k) handed from one effect to the next."""
    spread = {n: v[:, None] if v.ndim == 1 else v for n, v in names.items()}
    for hook in hooks(True):
        if hook.kind == kind:
            value = _call(run, hook, {**spread, "n" if kind in ("speed", "acting") else "T": value})
    return value


def total(run: Run, kind: str, names: Mapping[str, Array], size: int) -> Array:
    """Sum (B, size) of what every effect of a kind returns."""
    out = np.zeros((len(run.start), size))
    for hook in hooks(True):
        if hook.kind == kind:
            parts = _call(run, hook, names)
            out = out + np.stack(np.broadcast_arrays(*parts, out[:, 0])[:size], axis=1)
    return out
