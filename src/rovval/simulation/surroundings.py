"""What the effects of a simulation do to the vehicle from outside, along its motion: the water that carries it, and the forces on its hull."""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rovval import effects
from rovval.core.channels import VELOCITIES
from rovval.core.data import Array, Run, SimResult
from rovval.core.frames import rotation_from_euler
from rovval.plant import Plant, parse_settings
from rovval.plant.codegen.spec import LOGGED
from rovval.plant.inputs import prepare
from rovval.plant.lowering import Lowered, lower
from rovval.simulation.actuation import recorded_actuation
from rovval.vehicle.model import Vehicle


@dataclass(frozen=True, slots=True)
class Surroundings:
    """Along the windows of a simulation: ``current`` (n, 3) north, east, down, m/s, None where the water is at rest; ``forces`` (n, 3) in body axes, N, by
    the effect that makes them. NaN where nothing was simulated."""

    current: Array | None
    forces: Mapping[str, Array]


def surroundings(run: Run, sim: SimResult, vehicle: Vehicle) -> Surroundings:
    """Of the effects that ``sim`` was given, along its windows."""
    plant = Plant(vehicle, sim.model)
    lowered = lower(plant.nominal, plant.slots, plant.index, plant.null, parse_settings(plant, sim.effects)[None])
    names = _state(run, sim, vehicle)
    water = _acting(lowered, "water", names)
    current = np.sum(list(water.values()), axis=0) if water else np.zeros((len(run), 3))
    body = np.einsum("nji,nj->ni", rotation_from_euler(sim.windowed.eta[:, 3:]), current)
    names |= {name: names[name[0]] - body[:, i] for i, name in enumerate(("ur", "vr", "wr"))}
    names |= {name: current[:, i] for i, name in enumerate(("cn", "ce", "cd"))}
    return Surroundings(current if water else None, _acting(lowered, "wrench", names))


def _state(run: Run, sim: SimResult, vehicle: Vehicle) -> dict[str, Array]:
    """The simulated motion and the log, by the names by which effects ask for them."""
    nu, eta = sim.windowed.nu, sim.windowed.eta
    rotation = rotation_from_euler(eta[:, 3:])
    ground = np.einsum("nij,nj->ni", rotation, nu[:, :3])
    log = prepare(recorded_actuation(run, vehicle).inputs, vehicle).log
    names = {"t": run.t, **{n: nu[:, i] for i, n in enumerate(VELOCITIES)}, **{n: eta[:, i] for i, n in enumerate("xyz")}}
    names |= {f"r{i + 1}{j + 1}": rotation[:, i, j] for i in range(3) for j in range(3)}
    return names | {n: ground[:, i] for i, n in enumerate(("vn", "ve", "vd"))} | {n: log[:, i] for i, n in enumerate(LOGGED)}


def _acting(lowered: Lowered, kind: str, names: Mapping[str, Array]) -> dict[str, Array]:
    """The first three components (n, 3) of what each active effect of a kind returns along the motion; those that do nothing are left out."""
    found = {}
    for name in sorted(lowered.active):
        function = getattr(effects.module(name), kind, None)
        if function is None:
            continue
        own = {row.partition(".")[2]: value for row, value in lowered.rows.items() if row.startswith(f"{name}.")}
        parts = function(**{a: own[a] if a in own else names[a] for a in inspect.signature(function).parameters})
        vector = np.stack(np.broadcast_arrays(*parts[:3], names["t"])[:3], axis=1) + 0.0 * names["x"][:, None]
        if np.nanmax(np.abs(vector), initial=0.0) > 0.0:
            found[name] = np.asarray(vector)
    return found
