"""The rerun recording: sim and real in time and in 3-D, thrusters, both trajectories, on a layout that opens ready to look at.

World north-east-down (z down), body forward-starboard-down, angles and rates in degrees as people read them. What was not
measured is left out, and ``/notes`` says so.
"""

from __future__ import annotations

import errno
import shutil
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rovval.core.channels import AXES, POSE, VELOCITIES
from rovval.core.data import Array, Comparison, SimResult
from rovval.core.units import DEGREES
from rovval.report.comparison import words
from rovval.report.diagnosis.sentences.first_screen import first_screen
from rovval.report.drawings.hues import hues, rgb
from rovval.report.recording import diagnosed, pictures, world
from rovval.report.recording.layout import blueprint

if TYPE_CHECKING:
    from rovval.diagnose.result.diagnosis import Diagnosis
    from rovval.vehicle.model import Vehicle

ROOM = 1 << 20  # bytes; rerun does not say why it could not write, and on a disk with less room than a small recording needs that is why


def write(
    comparison: Comparison, path: Path, vehicle: Vehicle, corrected: SimResult | None = None, diagnosis: Diagnosis | None = None, log: Path | None = None
) -> None:
    """Write the recording to ``path``; ``corrected`` is a second simulation, with the effects that a ``diagnosis`` found, which is told beside it; pictures
    of cameras and sonars are taken from the ``log``."""
    import rerun as rr

    c, run = comparison, comparison.run
    seen = {topic: pictures.entity(topic) for topic in pictures.topics(log)}
    stream = rr.RecordingStream("rovval", recording_id=run.id, send_properties=False)
    layout = blueprint(c, "measured" if world.is_placed(c) else "free run", corrected is not None, max(vehicle.body.size), diagnosis is not None, seen)
    stream.save(path, default_blueprint=layout)
    banner = " SYNTHETIC" if words.synthetic(c) else ""
    stream.send_recording_name(f"{run.id} ({c.sim.model}){banner}")
    clock = [rr.TimeColumn("run_time", duration=run.t)]
    if run.t0_ns is not None:
        stamps = (run.t0_ns + np.round(run.t * 1e9).astype(np.int64)).astype("datetime64[ns]")
        clock.append(rr.TimeColumn("utc", timestamp=stamps))
    _curves(stream, clock, c, corrected)
    _thrusters(stream, clock, c.sim)
    notes = world.draw(stream, clock, c, vehicle, corrected)
    told = list(first_screen(diagnosis)) if diagnosis else []
    if log and seen:
        notes += pictures.draw(stream, run, log)
    if diagnosis:
        diagnosed.draw(stream, c, diagnosis, vehicle)
    lines = [f"# {run.id}", words.synthetic(c), *told, *words.sentences(c), *(f"- {n}" for n in notes)]
    document = rr.TextDocument("\n\n".join(line for line in lines if line), media_type=rr.MediaType.MARKDOWN)
    stream.log("/notes", document, static=True)
    try:
        stream.flush()
        stream.disconnect()
    except RuntimeError as error:  # rerun's own thread writes the file, and only tells that it could not
        full = shutil.disk_usage(path.parent).free < ROOM
        raise OSError(errno.ENOSPC if full else errno.EIO, f"the recording's writer stopped ({error})") from None


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
    stream.log(path, rr.SeriesLines(colors=[world.COLOURS[k] for k in sources], names=names, widths=widths), static=True)
    stream.send_columns(path, clock, rr.Scalars.columns(scalars=np.stack([*sources.values()], axis=1) * factor))


def _thrusters(stream: Any, clock: list[Any], sim: SimResult) -> None:
    import rerun as rr

    if not sim.thrusters:
        return
    for path, values, unit in (("speed", sim.thruster_speed * 60.0, "rpm"), ("force", sim.thrust, "N")):
        colours = [rgb(hue) for hue in hues(len(sim.thrusters))]
        stream.log(f"/thruster/{path}", rr.SeriesLines(colors=colours, names=[f"{t}, {unit}" for t in sim.thrusters]), static=True)
        stream.send_columns(f"/thruster/{path}", clock, rr.Scalars.columns(scalars=values))
