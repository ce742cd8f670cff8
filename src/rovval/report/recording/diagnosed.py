"""What a diagnosis adds to a recording: its words as a log, lanes of what holds when, and the force that the simulator misses, as measured and as explained."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import numpy as np

from rovval.comparison.missing_force import WINDOW_S, missing_force
from rovval.core.channels import AXES, VELOCITIES
from rovval.core.data import Comparison, Reason, Run
from rovval.report.diagnosis.sentences.first_screen import first_screen
from rovval.report.diagnosis.sentences.plain import holds, regime, titled
from rovval.report.diagnosis.sentences.sentence import also
from rovval.report.recording.world import COLOURS

if TYPE_CHECKING:
    from rovval.diagnose.result.diagnosis import Diagnosis
    from rovval.vehicle.model import Vehicle

LOG, LANES, FORCE = "/log", "/state", "/force"
NOTHING = "-"  # the state of a lane on which nothing holds


def draw(stream: Any, c: Comparison, d: Diagnosis, vehicle: Vehicle) -> None:
    """Everything of a diagnosis ``d`` that has a place in the time of the run of ``c``."""
    _log(stream, c.run, d)
    _lanes(stream, c.run, d)
    _forces(stream, c, d, vehicle)


def _log(stream: Any, run: Run, d: Diagnosis) -> None:
    """The first screen and what belongs to it at the run's start, what changes at its time, and the findings of the log."""
    import rerun as rr

    lines = [(0.0, said, "INFO") for said in (*first_screen(d), *also(d)) if said]
    lines += [(0.0, f"finding: {finding}", "WARN") for finding in run.findings]
    lines += [(t, "the gap changes its level", "WARN") for t in d.gap.change_points_s]
    lines += [(c.onset_s, f"{titled(c.effect)} begins", "ERROR") for c in d.causes if c.onset_s is not None]
    for t, text, level in sorted(lines, key=lambda line: line[0]):
        stream.set_time("run_time", duration=t)
        stream.log(LOG, rr.TextLog(text, level=level))


def _lanes(stream: Any, run: Run, d: Diagnosis) -> None:
    """A lane a cause, a lane a regime that holds most of the gap, one a channel that is not measured throughout, and one of the gap's level."""
    for c in d.causes:
        at_work = run.t >= (c.onset_s or 0.0)
        _lane(stream, run, f"cause/{_slug(c.effect)}", np.where(at_work, titled(c.effect), NOTHING), "corrected")
    for s in d.gap.where:
        flags = holds(run, s.regime)
        if flags is not None:
            _lane(stream, run, f"where/{s.axis}_{_slug(s.regime)}", np.where(flags, f"{s.axis}: {regime(s.regime)}", NOTHING), "windows")
    if d.gap.change_points_s:
        level = np.searchsorted(np.array(d.gap.change_points_s), run.t, side="right")
        _lane(stream, run, "gap_level", np.array([f"level {k + 1}" for k in level]), "free run")
    for name, codes in run.reasons.items():
        if (codes != Reason.OK).any():
            words = np.array([Reason(k).name.lower().replace("_", " ") if k else NOTHING for k in codes.tolist()])
            _lane(stream, run, f"log/{_slug(name)}", words, "other")


def _lane(stream: Any, run: Run, path: str, states: Any, colour: str) -> None:
    """A lane of states (n,), written where they change: one colour for what holds, a gap where nothing does."""
    import rerun as rr

    known = [str(s) for s in np.unique(states)]
    shown = rr.StateConfiguration(values=known, colors=[COLOURS[colour]] * len(known), visible=[s != NOTHING for s in known])
    stream.log(f"{LANES}/{path}", shown, static=True)
    at = np.flatnonzero(np.r_[True, states[1:] != states[:-1]])
    clock = [rr.TimeColumn("run_time", duration=run.t[at])]
    stream.send_columns(f"{LANES}/{path}", clock, rr.StateChange.columns(state=[str(s) for s in states[at]]))


def _forces(stream: Any, c: Comparison, d: Diagnosis, vehicle: Vehicle) -> None:
    """Per measured axis the force that the simulator misses, real minus simulated, and the part that the causes explain."""
    import rerun as rr

    from rovval.simulation import simulate

    short = simulate(c.run, vehicle, c.sim.model, window_s=WINDOW_S)
    rows, force = missing_force(short, c.run.stack(VELOCITIES), vehicle)
    sources = {"measured": force}
    if d.settings:
        mended = simulate(c.run, vehicle, c.sim.model, d.settings, WINDOW_S)
        sources["corrected"] = missing_force(short, mended.windowed.nu, vehicle)[1]
    names = {"measured": "missing: real minus simulated", "corrected": "explained by the causes"}
    clock = [rr.TimeColumn("run_time", duration=c.run.t[rows])]
    for j, axis in enumerate(AXES):
        if axis in c.not_measured:
            continue
        unit = "N m" if j > 2 else "N"
        lines = rr.SeriesLines(colors=[COLOURS[k] for k in sources], names=[f"{names[k]}, {unit}" for k in sources], widths=[1.6] * len(sources))
        stream.log(f"{FORCE}/{axis}", lines, static=True)
        stream.send_columns(f"{FORCE}/{axis}", clock, rr.Scalars.columns(scalars=np.stack([f[:, j] for f in sources.values()], axis=1)))


def _slug(name: str) -> str:
    return re.sub(r"\W+", "_", name).strip("_")
