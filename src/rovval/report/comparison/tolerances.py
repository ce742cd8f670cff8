"""Stated tolerances on the page: which are kept, and the tube round the measured motion that a tolerance of an error allows."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from rovval.comparison.tolerance import Tolerance
from rovval.core.channels import AXES, VELOCITIES
from rovval.core.data import Comparison
from rovval.report.common.numbers import MISSING, listed, per_cent, quantity

LEAD = (
    "Stated with --fail-above. A tolerance in the unit of the motion is drawn as a tube round the measured curve; the share of the rows of which the "
    "simulation lies in it stands beside."
)


class Judged(NamedTuple):
    """A tolerance, its value and limit, the share of rows inside its tube, and whether it is kept."""

    name: str
    value: str
    limit: str
    inside: str
    kept: bool


def rows(c: Comparison, tolerances: Sequence[Tolerance]) -> list[Judged]:
    """Every tolerance; one of what was not measured is not kept."""
    return [_judged(c, t) for t in tolerances]


def sentence(judged: Sequence[Judged]) -> str:
    """Whether all are kept; empty where none was stated."""
    if not judged:
        return ""
    beyond = [j.name for j in judged if not j.kept]
    few = "The tolerance is kept" if len(judged) == 1 else f"All {len(judged)} tolerances are kept"
    return f"Tolerance exceeded: {listed(beyond)}." if beyond else f"{few}."


def tube(tolerances: Sequence[Tolerance], axis: str) -> Tolerance | None:
    """The narrowest tolerance of an axis that is in the unit of its motion."""
    return min((t for t in tolerances if t.axis == axis and t.of.unit == "same"), key=lambda t: t.limit, default=None)


def inside(c: Comparison, tolerance: Tolerance) -> float | None:
    """Share of the compared rows of which the simulation lies within the tube."""
    name, trajectory = VELOCITIES[AXES.index(tolerance.axis)], c.sim.windowed if tolerance.windowed else c.sim.free
    ok = c.run.ok(name) & trajectory.ok
    error = trajectory.nu[ok, AXES.index(tolerance.axis)] - c.run.get(name)[ok]
    return float(np.mean(np.abs(error) <= tolerance.limit)) if len(error) else None


def _judged(c: Comparison, t: Tolerance) -> Judged:
    row, value = t.row(c), t.value(c)
    unit = t.of.unit_of(row.unit) if row else "1"
    share = per_cent(inside(c, t)) if t.of.unit == "same" else MISSING
    bound = f"{'at least' if t.more_is_better else 'at most'} {quantity(t.limit, unit)}"
    return Judged(str(t), quantity(value, unit), bound, share, value is not None and t.keeps(value))
