"""Some sources log the heading from where the vehicle began and the position in a room's axes: find the constant between them.

Over stretches of about a second and a half, the way covered in the room is the body velocity turned by the heading plus that
constant; least squares over the plane has it in closed form. Nothing dynamic enters, only that a velocity is a rate of position.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from rovval.core.data import Series
from rovval.core.errors import Finding
from rovval.core.frames import rotation_from_euler

WAY_S = 1.5
NEEDED = ("x", "y", "phi", "theta", "psi", "u", "v", "w")
LARGEST_MISFIT_RATIO = 0.7  # the misfit must fall below this part of itself, or be small already
SMALL_MISFIT = 0.2


def with_heading_zero(series: Mapping[str, Series]) -> tuple[dict[str, Series], Finding]:
    """The log with its heading turned into the position's axes, and what was found of it."""
    out = dict(series)
    if not all(n in series for n in NEEDED):
        return out, Finding("heading_zero", "psi", "the heading counts from the start; no position to find its zero by")
    room, dead = _ways(series)
    angle = float(np.angle(np.vdot(dead, room)))
    size = float(np.median(np.abs(room)))
    before, after = (float(np.median(np.abs(room - dead * turn))) / max(size, 1e-9) for turn in (1.0, np.exp(1j * angle)))
    told = f"{np.degrees(angle):.1f} deg between heading and position (misfit {before:.2f} of the way covered, {after:.2f} once turned)"
    if after > max(LARGEST_MISFIT_RATIO * before, SMALL_MISFIT):
        return out, Finding("heading_zero", "psi", f"{told}; not clear enough, left as logged")
    out["psi"] = Series(series["psi"].t, series["psi"].values + angle, series["psi"].stamp)
    return out, Finding("heading_zero", "psi", f"{told}; added to the heading")


def _ways(series: Mapping[str, Series]) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
    """Ways covered over each stretch as x + iy (m): by position, and by velocity turned by the attitude as logged."""
    t = series["x"].t
    columns = {n: np.interp(t, series[n].t, np.unwrap(s.values) if n in ("phi", "theta", "psi") else s.values) for n, s in series.items() if n in NEEDED}
    euler = np.stack([columns[n] for n in ("phi", "theta", "psi")], axis=1)
    world = np.einsum("nij,nj->ni", rotation_from_euler(euler), np.stack([columns[n] for n in "uvw"], axis=1))
    way = np.concatenate((np.zeros((1, 3)), np.cumsum(0.5 * (world[1:] + world[:-1]) * np.diff(t)[:, None], axis=0)))
    k = max(1, min(len(t) - 1, round(WAY_S / float(np.median(np.diff(t))))))
    room: NDArray[np.complex128] = np.asarray(columns["x"] + 1j * columns["y"], dtype=np.complex128)
    dead: NDArray[np.complex128] = np.asarray(way[:, 0] + 1j * way[:, 1], dtype=np.complex128)
    return room[k:] - room[:-k], dead[k:] - dead[:-k]
