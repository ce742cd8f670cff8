"""A simulation in one parquet file: a row a sample of the run's grid, and what was simulated in the file's own metadata."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rovval.core.channels import POSE, VELOCITIES
from rovval.core.data import SimResult, Trajectory
from rovval.core.errors import BadInput
from rovval.storage.atomic import drafts

if TYPE_CHECKING:
    import polars as pl

SCHEMA = "rovval.simulation/1"
FACTS = (
    "run_id",
    "vehicle",
    "vehicle_hash",
    "model",
    "effects",
    "window_s",
    "dt",
    "thrusters",
    "input_source",
    "assumptions",
    "stops",
)
LISTS = ("effects", "thrusters", "assumptions", "stops")


def save_simulation(sim: SimResult, path: Path) -> None:
    """Write ``sim``, whole or not at all."""
    import io

    import polars as pl

    columns: dict[str, Any] = {"t_s": np.arange(len(sim.free.ok)) * sim.dt}
    for form in ("free", "windowed"):
        trajectory: Trajectory = getattr(sim, form)
        columns |= {f"{form}:{name}": trajectory.nu[:, i] for i, name in enumerate(VELOCITIES)}
        columns |= {f"{form}:{name}": trajectory.eta[:, i] for i, name in enumerate(POSE)}
        columns |= {f"{form}:reason": trajectory.reasons, f"{form}:stretch": trajectory.stretch}
    for j, name in enumerate(sim.thrusters):
        columns |= {f"n:{name}": sim.thruster_speed[:, j], f"thrust:{name}": sim.thrust[:, j]}
    facts = {"schema": SCHEMA} | {name: getattr(sim, name) for name in FACTS}
    pl.DataFrame(columns).write_parquet(table := io.BytesIO(), compression="zstd", metadata={"rovval": json.dumps(facts)})
    with drafts(path) as [draft]:
        draft.write_bytes(table.getvalue())


def load_simulation(path: Path) -> SimResult:
    """Read what `save` wrote, exactly. Raises `BadInput` for any other file."""
    import polars as pl

    try:
        facts = json.loads(pl.read_parquet_metadata(path)["rovval"])
        table = pl.read_parquet(path)
    except (OSError, KeyError, ValueError, pl.exceptions.PolarsError) as error:
        raise BadInput(
            f"{path}: not a simulation of rovval: {error}", "make one with `rovval simulate --out FILE.parquet`"
        ) from None
    if facts.pop("schema", None) != SCHEMA or set(facts) != set(FACTS):
        raise BadInput(f"{path}: not of schema {SCHEMA!r}", "make it again with `rovval simulate`")
    facts |= {name: tuple(facts[name]) for name in LISTS}
    speed, thrust = (
        np.stack([table[f"{kind}:{name}"].to_numpy() for name in facts["thrusters"]], axis=1) for kind in ("n", "thrust")
    )
    return SimResult(
        **facts, free=_trajectory(table, "free"), windowed=_trajectory(table, "windowed"), thruster_speed=speed, thrust=thrust
    )


def _trajectory(table: pl.DataFrame, form: str) -> Trajectory:
    nu, eta = (np.stack([table[f"{form}:{name}"].to_numpy() for name in names], axis=1) for names in (VELOCITIES, POSE))
    return Trajectory(nu, eta, table[f"{form}:reason"].to_numpy(), table[f"{form}:stretch"].to_numpy())
