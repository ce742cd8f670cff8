"""Attitude of a log that tumbles on the grid: as one rotation, since roll and heading each jump where the pitch passes 90 degrees."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from rovval.alignment.resampling import resample
from rovval.core.channels import Resampling
from rovval.core.data import Array, Codes, RawLog, Reason, Series
from rovval.core.frames import euler_from_quaternion, smooth_quaternions, tumbles

EULER = ("phi", "theta", "psi")
Channel = tuple[Array, Codes, str]


def tumbling_attitude(raw: RawLog, bad: Mapping[str, Codes]) -> bool:
    """Whether the log holds a whole attitude, stamped together, that leaves the range of Euler angles. ``bad``: `Reason` of its samples, by channel."""
    if not all(name in raw.channels for name in EULER):
        return False
    t, pitch = raw.channels["phi"].t, raw.channels["theta"]
    together = all(np.array_equal(t, raw.channels[name].t) for name in EULER)
    return together and tumbles(pitch.values[bad["theta"] == Reason.OK])


def resampled_attitude(
    raw: RawLog, bad: Mapping[str, Codes], start: float, n: int, dt: float, gap_s: float, method: Resampling, held_s: float | None
) -> dict[str, Channel]:
    """Roll, pitch and yaw (n,) of one rotation on the grid, each with its codes and the method used, as `resample` gives those of a channel: the unit
    quaternion's components are averaged or interpolated, as near as neighbours are the same as the rotation between them (Markley et al. 2007)."""
    t, stamp = raw.channels["phi"].t, raw.channels["phi"].stamp
    code = np.max([bad[name] for name in EULER], axis=0).astype(np.uint8)
    euler = np.stack([np.where(code == Reason.OK, raw.channels[name].values, np.nan) for name in EULER], axis=1)
    parts = [
        resample(Series(t, np.nan_to_num(component), stamp), code, start, n, dt, gap_s, "mean" if method == "circular" else method, held_s)
        for component in smooth_quaternions(euler).T
    ]
    q = np.stack([values for values, _, _ in parts], axis=1)
    angles = euler_from_quaternion(q / np.linalg.norm(q, axis=1, keepdims=True))
    _, codes, said = parts[0]
    return {name: (angles[:, i].copy(), codes.copy(), said if said == "unchanged" else f"{said} of rotations") for i, name in enumerate(EULER)}
