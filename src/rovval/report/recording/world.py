"""The 3-D part of a recording: tracks, the vehicle as measured and as simulated, and its thrusts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rovval.core.channels import POSE
from rovval.core.data import Array, Comparison, SimResult
from rovval.core.frames import quaternion_from_euler
from rovval.report.common.numbers import listed
from rovval.report.comparison import words
from rovval.report.diagnosis.sentences.plain import title, titled
from rovval.report.drawings.hues import hues, rgb
from rovval.simulation.surroundings import Surroundings, surroundings

if TYPE_CHECKING:
    from rovval.vehicle.model import Vehicle

COLOURS = {  # the page's in the dark
    "measured": (238, 242, 246),
    "windows": (255, 143, 61),
    "free run": (90, 169, 240),
    "other": (172, 76, 144),
    "corrected": (31, 191, 143),
}
ARROW_RADIUS = 0.02  # of a vehicle's length: the shaft of an arrow of current or force
ARROW_SHARE = 1.2  # the strongest thrust is drawn this many vehicle lengths long
SPECK = 1e-3  # of its size: the vehicle where its pose is missing; of no size at all it is no transform to the viewer, which warns at every step


def is_placed(c: Comparison) -> bool:
    """Whether the measured vehicle has a place in the world."""
    return all(c.run.measured(n) for n in ("x", "y", "z"))


def draw(stream: Any, clock: list[Any], c: Comparison, vehicle: Vehicle, corrected: SimResult | None) -> list[str]:
    """Trajectories, the vehicle as measured and as simulated, and its thrusts; returns what had to be left out."""
    import rerun as rr

    run, notes = c.run, []
    stream.log("/world", rr.ViewCoordinates.RIGHT_HAND_Z_DOWN, static=True)
    placed = is_placed(c)
    tracks = {"free run": c.sim.free.eta[:, :3]}
    bodies = {"free run": c.sim.free.eta}
    if placed:
        measured = run.stack(POSE)
        level = [n for n in ("phi", "theta", "psi") if not run.measured(n)]
        for n in level:
            measured[:, POSE.index(n)] = 0.0
        if level:
            notes.append(f"Not measured: {listed(words.TITLES[n] for n in level)}; the vehicle is drawn with zero there.")
        tracks = {"measured": measured[:, :3], "windows": c.sim.windowed.eta[:, :3], **tracks}
        bodies = {"measured": measured, **bodies}
        if corrected is not None:
            tracks["corrected"] = corrected.windowed.eta[:, :3]
            bodies["corrected"] = corrected.windowed.eta
    else:
        missing = [n for n in ("x", "y", "z") if not run.measured(n)]
        notes.append(f"{listed(missing)} not measured: 3-D shows the simulated free run alone.")
    _compass(stream, next(iter(tracks.values())))
    for name, points in tracks.items():
        stretch = c.sim.windowed.stretch if name in ("windows", "corrected") else np.zeros(len(run), np.int64)
        strips = _strips(points, stretch)
        stream.log(f"/world/track/{_slug(name)}", rr.LineStrips3D(strips, colors=[COLOURS[name]], radii=-1.5), static=True)
    for name, eta in bodies.items():
        _body(stream, clock, f"/world/{_slug(name)}", eta, vehicle, COLOURS[name], solid=name == next(iter(bodies)))
    shown, eta = next(iter(bodies.items()))
    above = np.array([0.0, 0.0, -0.5 * vehicle.body.size[2]])
    _thrusts(stream, clock, f"/world/{_slug(shown)}/thrust", c.sim, vehicle)
    around = surroundings(run, corrected or c.sim, vehicle) if (corrected or c.sim).effects else Surroundings(None, {})
    if around.current is not None:
        largest = _arrow(stream, clock, "/world/current", around.current, eta[:, :3] + 2.0 * above, "current", vehicle)
        notes.append(f"Arrow of the current, as the simulation with effects has it: {largest:.3g} m/s at most.")
    for effect, force in around.forces.items():
        largest = _arrow(stream, clock, f"/world/{_slug(shown)}/force/{effect}", force, np.tile(above, (len(run), 1)), title(effect), vehicle)
        notes.append(f"Arrow of {titled(effect)}, drawn from the middle of the hull's top: {largest:.3g} N at most.")
    return notes


def _compass(stream: Any, track: Array) -> None:
    """North, east and down where the track begins, so that the view frames the dive and not the way to the surface."""
    import rerun as rr

    there = np.flatnonzero(np.isfinite(track).all(axis=1))
    start = track[there[0]] if len(there) else np.zeros(3)
    length = max(0.5, 0.12 * float(np.ptp(track[there], axis=0).max())) if len(there) else 0.5
    axes = rr.Arrows3D(origins=[start] * 3, vectors=length * np.eye(3), labels=["north", "east", "down"], radii=-1.0)
    stream.log("/world/compass", axes, static=True)


def _slug(name: str) -> str:
    return name.replace(" ", "_")


def _strips(points: Array, stretch: Any) -> list[Array]:
    """Unbroken pieces of a track: cut where it is missing and where a window begins."""
    there = np.isfinite(points).all(axis=1) & (stretch >= 0)
    cut = np.flatnonzero((there[1:] != there[:-1]) | (stretch[1:] != stretch[:-1])) + 1
    pieces = zip(np.split(points, cut), np.split(there, cut), strict=True)
    return [piece.astype(np.float32) for piece, ok in pieces if ok[0] and len(piece) > 1]


def _body(
    stream: Any, clock: list[Any], path: str, eta: Array, vehicle: Vehicle, colour: tuple[int, int, int], solid: bool
) -> None:
    """The vehicle's box along a pose; it shrinks to a speck where the pose is missing."""
    import rerun as rr

    fill = rr.components.FillMode.TransparentFillMajorWireframe if solid else rr.components.FillMode.MajorWireframe
    half = np.array(vehicle.body.size) / 2.0
    stream.log(path, rr.ViewCoordinates.RIGHT_HAND_Z_DOWN, static=True)
    stream.log(path, rr.Boxes3D(half_sizes=[half], colors=[colour], fill_mode=fill), static=True)
    there = np.asarray(np.isfinite(eta).all(axis=1))
    known = np.where(there[:, None], eta, 0.0)
    w_first = quaternion_from_euler(known[:, 3:])
    columns = rr.Transform3D.columns(
        translation=known[:, :3],
        quaternion=w_first[:, [1, 2, 3, 0]],
        scale=np.repeat(np.where(there, 1.0, SPECK)[:, None], 3, axis=1),
    )
    stream.send_columns(path, clock, columns)


def _arrow(stream: Any, clock: list[Any], path: str, vectors: Array, at: Array, label: str, vehicle: Vehicle) -> float:
    """An arrow along the run from ``at`` (n, 3) in the frame of the entity above, the longest `ARROW_SHARE` vehicle lengths long; the largest size, in
    the vectors' unit. Gone where the vector or its origin is missing."""
    import rerun as rr

    longest = max(vehicle.body.size)
    largest = float(np.nanmax(np.linalg.norm(vectors, axis=1)))
    there = np.asarray(np.isfinite(vectors).all(axis=1) & np.isfinite(at).all(axis=1))
    drawn = np.where(there[:, None], vectors, 0.0) * (ARROW_SHARE * longest / largest)
    stream.log(path, rr.Arrows3D.from_fields(colors=[COLOURS["corrected"]], radii=[ARROW_RADIUS * longest], labels=[label]), static=True)
    columns = rr.Arrows3D.columns(vectors=drawn, origins=np.where(there[:, None], at, 0.0))
    stream.send_columns(path, clock, columns)
    return largest


def _thrusts(stream: Any, clock: list[Any], path: str, sim: SimResult, vehicle: Vehicle) -> None:
    """Arrows at the thrusters, in the body frame of the entity above."""
    import rerun as rr

    known = {t.name: t for t in vehicle.thruster}
    columns = [j for j, name in enumerate(sim.thrusters) if name in known]
    if not columns:
        return
    units = [np.array(known[sim.thrusters[j]].direction) for j in columns]
    directions = np.stack([u / np.linalg.norm(u) for u in units])
    force = np.nan_to_num(sim.thrust[:, columns])
    longest = float(np.abs(force).max()) or 1.0
    vectors = force[:, :, None] * directions * (ARROW_SHARE * max(vehicle.body.size) / longest)
    shades = hues(len(sim.thrusters))
    origins = [known[sim.thrusters[j]].position for j in columns]
    still = rr.Arrows3D.from_fields(origins=origins, colors=[rgb(shades[j]) for j in columns], radii=[0.015], labels=[sim.thrusters[j] for j in columns])
    stream.log(path, still, static=True)
    lanes = np.full(len(force), len(columns))
    stream.send_columns(path, clock, rr.Arrows3D.columns(vectors=vectors.reshape(-1, 3)).partition(lanes))
