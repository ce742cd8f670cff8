"""The rerun recording: sim and real in time and in 3-D, thrusters, both trajectories, on a layout that opens ready to look at.

World north-east-down (z down), body forward-starboard-down, angles and rates in degrees as people read them. What was not
measured is left out, and ``/notes`` says so.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rovval.channels import AXES, POSE, VELOCITIES
from rovval.data import Array, Comparison, SimResult
from rovval.frames import quaternion_from_euler
from rovval.report import words
from rovval.report.layout import blueprint
from rovval.units import DEGREES

if TYPE_CHECKING:
    from rovval.vehicle.model import Vehicle

COLOURS = {
    "measured": (225, 230, 235),
    "windows": (255, 150, 60),
    "free run": (90, 170, 250),
    "other": (199, 146, 224),
    "corrected": (80, 205, 140),
}
ARROW_SHARE = 1.2  # the strongest thrust is drawn this many vehicle lengths long


def write(comparison: Comparison, path: Path, vehicle: Vehicle, corrected: SimResult | None = None) -> None:
    """Write the recording to ``path``; ``corrected`` is a second simulation, with the effects that a diagnosis found."""
    import rerun as rr

    c, run = comparison, comparison.run
    stream = rr.RecordingStream("rovval", recording_id=run.id, send_properties=False)
    stream.save(path, default_blueprint=blueprint(c, "measured" if is_placed(c) else "free run", corrected is not None))
    banner = " SYNTHETIC" if words.synthetic(c) else ""
    stream.send_recording_name(f"{run.id} ({c.sim.model}){banner}")
    clock = [rr.TimeColumn("run_time", duration=run.t)]
    if run.t0_ns is not None:
        stamps = (run.t0_ns + np.round(run.t * 1e9).astype(np.int64)).astype("datetime64[ns]")
        clock.append(rr.TimeColumn("utc", timestamp=stamps))
    _curves(stream, clock, c, corrected)
    _thrusters(stream, clock, c.sim)
    notes = _world(stream, clock, c, vehicle, corrected)
    lines = [f"# {run.id}", words.synthetic(c), *words.sentences(c), *(f"- {n}" for n in notes)]
    document = rr.TextDocument("\n\n".join(line for line in lines if line), media_type=rr.MediaType.MARKDOWN)
    stream.log("/notes", document, static=True)
    stream.flush()
    stream.disconnect()


def _curves(stream: Any, clock: list[Any], c: Comparison, corrected: SimResult | None) -> None:
    """Velocities, errors and pose: one entity an axis, one line a source."""
    for j, (axis, name) in enumerate(zip(AXES, VELOCITIES, strict=True)):
        factor, unit = (DEGREES, "deg/s") if j > 2 else (1.0, "m/s")
        sources = {"windows": c.sim.windowed.nu[:, j], "free run": c.sim.free.nu[:, j]}
        if corrected is not None:
            sources["corrected"] = corrected.windowed.nu[:, j]
        if c.other_nu is not None and axis in c.other:
            sources["other"] = c.other_nu[:, j]
        if axis in c.not_measured:
            _lines(stream, clock, f"/velocity/{axis}", sources, factor, unit, c.other_name)
            continue
        real = c.run.get(name)
        _lines(stream, clock, f"/velocity/{axis}", {"measured": real, **sources}, factor, unit, c.other_name)
        errors = {k: v - real for k, v in sources.items()}
        _lines(stream, clock, f"/error/{axis}", errors, factor, unit, c.other_name)
    for name in c.pose:
        j = POSE.index(name)
        factor, unit = (DEGREES, "deg") if j > 2 else (1.0, "m")
        sources = {"measured": c.run.get(name), "windows": c.sim.windowed.eta[:, j], "free run": c.sim.free.eta[:, j]}
        if corrected is not None:
            sources["corrected"] = corrected.windowed.eta[:, j]
        _lines(stream, clock, f"/pose/{words.TITLES[name].replace(' ', '_')}", sources, factor, unit, c.other_name)


def _lines(
    stream: Any, clock: list[Any], path: str, sources: dict[str, Array], factor: float, unit: str, other: str
) -> None:
    import rerun as rr

    names = [f"{other if key == 'other' else key}, {unit}" for key in sources]
    widths = [2.2 if key == "measured" else 1.4 for key in sources]
    stream.log(path, rr.SeriesLines(colors=[COLOURS[k] for k in sources], names=names, widths=widths), static=True)
    stream.send_columns(path, clock, rr.Scalars.columns(scalars=np.stack([*sources.values()], axis=1) * factor))


def _thrusters(stream: Any, clock: list[Any], sim: SimResult) -> None:
    import rerun as rr

    if not sim.thrusters:
        return
    for path, values, unit in (("speed", sim.thruster_speed * 60.0, "rpm"), ("force", sim.thrust, "N")):
        stream.log(f"/thruster/{path}", rr.SeriesLines(names=[f"{t}, {unit}" for t in sim.thrusters]), static=True)
        stream.send_columns(f"/thruster/{path}", clock, rr.Scalars.columns(scalars=values))


def is_placed(c: Comparison) -> bool:
    """Whether the measured vehicle has a place in the world."""
    return all(c.run.measured(n) for n in ("x", "y", "z"))


def _world(stream: Any, clock: list[Any], c: Comparison, vehicle: Vehicle, corrected: SimResult | None) -> list[str]:
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
            notes.append(f"Not measured: {words.listed(words.TITLES[n] for n in level)}; the vehicle is drawn with zero there.")
        tracks = {"measured": measured[:, :3], "windows": c.sim.windowed.eta[:, :3], **tracks}
        bodies = {"measured": measured, **bodies}
        if corrected is not None:
            tracks["corrected"] = corrected.windowed.eta[:, :3]
    else:
        missing = [n for n in ("x", "y", "z") if not run.measured(n)]
        notes.append(f"{words.listed(missing)} not measured: 3-D shows the simulated free run alone.")
    _compass(stream, next(iter(tracks.values())))
    for name, points in tracks.items():
        stretch = c.sim.windowed.stretch if name in ("windows", "corrected") else np.zeros(len(run), np.int64)
        strips = _strips(points, stretch)
        stream.log(f"/world/track/{_slug(name)}", rr.LineStrips3D(strips, colors=[COLOURS[name]], radii=-1.5), static=True)
    for name, eta in bodies.items():
        _body(stream, clock, f"/world/{_slug(name)}", eta, vehicle, COLOURS[name], solid=name == next(iter(bodies)))
    _thrusts(stream, clock, f"/world/{_slug(next(iter(bodies)))}/thrust", c.sim, vehicle)
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
    """The vehicle's box along a pose; it shrinks to nothing where the pose is missing."""
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
        scale=np.repeat(there.astype(float)[:, None], 3, axis=1),
    )
    stream.send_columns(path, clock, columns)


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
    origins = [known[sim.thrusters[j]].position for j in columns]
    still = rr.Arrows3D.from_fields(origins=origins, colors=[(255, 90, 80)], radii=[0.015])
    stream.log(path, still, static=True)
    lanes = np.full(len(force), len(columns))
    stream.send_columns(path, clock, rr.Arrows3D.columns(vectors=vectors.reshape(-1, 3)).partition(lanes))
