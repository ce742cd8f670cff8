"""Errors of the simulated track beside the measured one, as evo states them: absolute trajectory error and relative pose error.

Sturm, Engelhard, Endres, Burgard and Cremers 2012 (IROS), "A benchmark for the evaluation of RGB-D SLAM systems", equations 1 to 5; alignment by Umeyama
1991, without scale. Numbers are those of `evo_ape` (with and without ``--align``) and `evo_rpe --delta N --delta_unit f`, part translation.
"""

from __future__ import annotations

import numpy as np

from rovval.core.data import Array, Run, SimResult, TrackError
from rovval.core.frames import rotation_from_euler

STEP_S = 10.0  # over which the relative error is stated: the windows of a comparison (chosen)
FEWEST = 3  # poses: fewer fix no alignment


def track_error(run: Run, sim: SimResult) -> TrackError | None:
    """Of the free run, on the rows that have all of the pose; None where hardly any has, as in a log without positions."""
    names = ("x", "y", "z", "phi", "theta", "psi")
    if not all(run.measured(name) for name in names):
        return None
    measured, simulated = run.stack(names), sim.free.eta
    rows = sim.free.ok & np.isfinite(measured).all(axis=1) & np.isfinite(simulated).all(axis=1)
    for name in names:
        rows &= run.ok(name)
    if rows.sum() < FEWEST:
        return None
    truth, found, step = measured[rows], simulated[rows], round(STEP_S / run.dt)
    return TrackError(
        n=int(rows.sum()),
        ate=absolute_error(truth[:, :3], found[:, :3]),
        ate_aligned=absolute_error(truth[:, :3], aligned(truth[:, :3], found[:, :3])),
        rpe=relative_error(truth, found, step) if len(truth) > step else None,
        step_s=STEP_S,
    )


def absolute_error(measured: Array, simulated: Array) -> float:
    """Root mean square distance (m) of positions (n, 3)."""
    return float(np.sqrt(np.mean(np.sum((simulated - measured) ** 2, axis=1))))


def aligned(measured: Array, simulated: Array) -> Array:
    """Simulated positions (n, 3) turned and moved as a rigid body to where they are nearest to the measured ones (Umeyama 1991, equations 34 to 43)."""
    to, at = measured.mean(axis=0), simulated.mean(axis=0)
    u, _, vt = np.linalg.svd((measured - to).T @ (simulated - at) / len(measured))
    mirror = np.diag([1.0, 1.0, np.sign(np.linalg.det(u) * np.linalg.det(vt))])
    return np.asarray((simulated - at) @ (u @ mirror @ vt).T + to)


def relative_error(measured: Array, simulated: Array, step: int) -> float:
    """Root mean square error (m) of the way made in ``step`` poses, one after the other, each seen from the body at its start: poses (n, 6), position in
    m and Euler angles in rad. Seen from the body at its end, as the paper has it, it is as long."""
    first = np.arange(0, len(measured) - step, step)
    ways = [np.einsum("nji,nj->ni", rotation_from_euler(p[first, 3:]), p[first + step, :3] - p[first, :3]) for p in (measured, simulated)]
    return absolute_error(*ways)
