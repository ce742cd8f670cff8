"""The run as a table in Parquet: a row a sample, null where missing, for pandas, polars, DuckDB and MATLAB."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import polars as pl

from rovval.core.channels import POSE, VELOCITIES, channel
from rovval.export.content import Content
from rovval.storage.atomic import drafts

SUFFIX = ".parquet"


def write(content: Content, path: Path) -> tuple[Path, ...]:
    """One file; what the axes are stands in its metadata. Raises as `drafts` does."""
    about = {"run": content.run.id, "source": content.run.source, "sha256": content.run.sha256, "axes": AXES}
    table(content).write_parquet(made := io.BytesIO(), compression="zstd", metadata=about)
    with drafts(path) as [draft]:
        draft.write_bytes(made.getbuffer())  # not by polars, whose own error tells of a full disk as of a damaged file
    return (path,)


AXES = "body forward-starboard-down, world north-east-down (SNAME), SI and radians; thruster speeds in rev/s"


def table(content: Content) -> pl.DataFrame:
    """``t [s]``, ``utc`` where the log knows it, every channel with its unit, and of a simulation the same with ``sim_`` (free run) and
    ``simw_`` (restarted in windows) before them."""
    run, sim = content.run, content.sim
    columns: dict[str, pl.Series] = {"t [s]": pl.Series(run.t)}
    if run.t0_ns is not None:
        columns["utc"] = pl.Series(content.stamps_ns).cast(pl.Datetime("ns", "UTC"))
    for name, values in run.values.items():
        columns[f"{name} [{channel(name).unit}]"] = _nulls(values)
    for prefix, trajectory in () if sim is None else (("sim", sim.free), ("simw", sim.windowed)):
        for names, block in ((VELOCITIES, trajectory.nu), (POSE, trajectory.eta)):
            columns |= {f"{prefix}_{n} [{channel(n).unit}]": _nulls(block[:, i]) for i, n in enumerate(names)}
    for k, name in enumerate(() if sim is None else sim.thrusters):
        columns |= {f"sim_n:{name} [rev/s]": _nulls(sim.thruster_speed[:, k]), f"sim_thrust:{name} [N]": _nulls(sim.thrust[:, k])}  # type: ignore[union-attr]
    return pl.DataFrame(columns)


def _nulls(values: np.ndarray[tuple[int], np.dtype[np.float64]]) -> pl.Series:
    return pl.Series(values).fill_nan(None)
