"""What a comparison says in sentences, the same in every format: where the gap is largest, and whether the simulator beats predicting no motion."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from rovval.core.data import ChannelError, Comparison
from rovval.report.common.numbers import duration, listed, number, per_cent, quantity

SHORT_S = 60.0  # s: a shorter log holds six windows of 10 s, too few manoeuvres to judge a simulator by
LINEAR = ("surge", "sway", "heave")
TITLES = {"z": "depth", "phi": "roll angle", "theta": "pitch angle", "psi": "heading"}

NO_VELOCITY = "No velocity was measured in this log, so there is no error per axis; what was measured of the pose is compared below."


def synthetic(comparison: Comparison) -> str:
    """The banner of a made-up log, or "" for a real one."""
    text = comparison.run.properties.get("synthetic", "")
    return f"SYNTHETIC DATA: {text}" if text else ""


def relative(row: ChannelError) -> float | None:
    """RMS error over the RMS error of the trivial predictor: below 1 the simulator is better than none."""
    return row.rmse / row.baseline_rmse if row.baseline_rmse > 0.0 else None


def verdict(comparison: Comparison) -> str:
    """The answer in words, see `sentences`."""
    return " ".join(sentences(comparison))


def sentences(comparison: Comparison) -> list[str]:
    """One sentence, and what must be said beside it: the axes with the largest gap, and whether the simulator does better than predicting no motion."""
    return [s for s in (short(comparison), *_answer(comparison)) if s]


def short(comparison: Comparison) -> str:
    """What to know first of a log of less than a minute; empty for a longer one."""
    run = comparison.run
    if len(run) * run.dt > SHORT_S - 0.5 * run.dt:
        return ""
    return f"Only {duration(run.duration_s)} of log: under a minute, these numbers say little of how good the simulator is."


def _answer(comparison: Comparison) -> list[str]:
    table, where = comparison.windowed, f"over {windows(comparison)}"
    if not table:
        table, where = comparison.free, "over the free run"
    if not table:
        return [s for s in (_pose_only(comparison), shortened(comparison)) if s]
    lines, turns = [a for a in table if a in LINEAR], [a for a in table if a not in LINEAR]
    worst = [max(group, key=lambda a: table[a].rmse) for group in (lines, turns) if group]
    gaps = " and, turning, in ".join(_gap(a, table[a]) for a in worst)
    said = [f"{where.capitalize()}, the simulator is furthest from the vehicle in {gaps}; {_skill(table)}."]
    if less := shortened(comparison):
        said.append(less)
    if comparison.sim.stops:
        said.append(f"The simulation left sane limits, and the rows after that are not counted: {comparison.sim.stops[0]}.")
    if comparison.other:
        said.append(_beside(comparison))
    if comparison.not_measured:
        said.append(f"Not measured in this log: {listed(comparison.not_measured)}.")
    return said


def _pose_only(comparison: Comparison) -> str:
    """For a log without velocities: the pose channels that it has; of a simulation alone, that it is one."""
    if not comparison.pose:
        return "Nothing was measured beside this simulation."
    gaps = listed([f"{TITLES[name]} ({quantity(row.rmse, row.unit)} rms)" for name, row in comparison.pose.items()])
    return (
        f"No velocity was measured in this log. In {windows(comparison)}, started from the measured pose, "
        f"the simulator differs from the vehicle in {gaps}."
    )


def _gap(axis: str, row: ChannelError) -> str:
    share = relative(row)
    if share is None:
        return f"{axis} ({quantity(row.rmse, row.unit)} rms)"
    motion = f"{number(share, 2)} times" if share > 2 else f"{per_cent(share)} of"
    return f"{axis} ({quantity(row.rmse, row.unit)} rms, {motion} the recorded motion)"


def _beside(comparison: Comparison) -> str:
    rows, name = comparison.other, comparison.other_name
    ours = [a for a in rows if rows[a].extra.get("ours_mae", rows[a].mae) < rows[a].mae]
    theirs = [a for a in rows if a not in ours]
    if not theirs or not ours:
        near, far = ("ours", name) if ours else (name, "ours")
        return f"In free run {near} is nearer to the vehicle than {far} on every shared axis (MAE)."
    return f"In free run ours is nearer to the vehicle than {name} in {listed(ours)}, {name} in {listed(theirs)} (MAE)."


def _skill(table: Mapping[str, ChannelError]) -> str:
    """Whether the simulator beats predicting no motion; an axis on which it is behind by no more than the sensor's noise counts for neither."""
    judged = [a for a in table if table[a].skill is not None]
    if not judged:
        return "the vehicle never moved, so there is no skill to speak of"
    worse = [a for a in judged if table[a].misleads]
    better = [a for a in judged if a not in worse and (table[a].skill or 0.0) > 0.0]
    noisy = [a for a in judged if a not in worse and a not in better]
    said = list[str]()
    for word, axes in (("worse", worse), ("better", better)):
        where = "on every measured axis" if axes == judged and len(axes) > 1 else f"in {listed(axes)}"
        than = "" if said else " than predicting no motion"
        said += [f"{word}{than} {where}"] if axes else []
    does = [f"it does {' and '.join(said)}"] if said else []
    hidden = [f"in {listed(noisy)} motion and error are hardly more than the sensor's noise"] if noisy else []
    return ", ".join(does + hidden)


def track(comparison: Comparison) -> str:
    """How far the simulated track leads from the measured one; empty where positions were not logged."""
    found = comparison.track
    if found is None:
        return ""
    way = "" if found.rpe is None else f"; error of the way made in {found.step_s:g} s {number(found.rpe)} m rms (RPE)"
    apart = f"{number(found.ate)} m rms from one start, {number(found.ate_aligned)} m once turned and moved onto it (ATE)"
    return f"track, simulated from its first row on: {apart}{way}; as evo states them"


def notes(comparison: Comparison) -> list[str]:
    """What a reader must know beside the numbers: rows that could not be compared, and how they were counted."""
    result = []
    for axis in comparison.windowed.keys() ^ comparison.free.keys():
        form = "free run" if axis in comparison.windowed else "windows"
        result.append(f"{axis}: measured, but no row of the {form} could be compared")
    result.append(
        f"{windows(comparison)}, each restarted from the measured state; RMS over all their rows, the first one included"
    )
    result += [said] if (said := track(comparison)) else []
    result.append("no motion: the error of predicting zero velocity; skill = 1 - MSE / MSE(no motion)")
    return result


def facts(comparison: Comparison) -> dict[str, Any]:
    """The line under the title: what was compared with what."""
    run, sim = comparison.run, comparison.sim
    return {
        "log": run.source,
        "length": f"{duration(run.duration_s)} at {1.0 / run.dt:g} Hz",
        "vehicle": f"{sim.vehicle} ({sim.vehicle_hash})",
        "model": sim.model,
        "effects": ", ".join(sim.effects) or "none (nominal)",
        "thruster input": sim.input_source,
        "profile": run.profile,
    }


def longest_s(c: Comparison) -> float:
    """Length of the longest window (s): the one asked for, or less where no unbroken stretch of log and simulation is as long."""
    rows = int(np.bincount(c.sim.windowed.stretch[c.sim.windowed.stretch >= 0], minlength=1).max())
    whole = rows * c.run.dt > c.sim.window_s - 1.5 * c.run.dt
    return c.sim.window_s if whole or not rows else (rows - 1) * c.run.dt


def windows(c: Comparison) -> str:
    """windows of 10 s; windows of at most 4.9 s; one window of 4.9 s."""
    length, asked = longest_s(c), c.sim.window_s
    if length == asked:
        return f"windows of {asked:g} s"
    many = len(np.unique(c.sim.windowed.stretch[c.sim.windowed.stretch >= 0])) > 1
    return f"{'windows of at most' if many else 'one window of'} {length:.3g} s"


def shortened(c: Comparison) -> str:
    """What was done where windows of the length asked for do not fit; empty where they do."""
    length, asked = longest_s(c), c.sim.window_s
    if length == asked:
        return ""
    if c.run.duration_s < asked:
        return f"This log is shorter than a window of {asked:g} s: it is simulated in {windows(c)}, restarted from the measured state."
    return f"No unbroken stretch is as long as a window of {asked:g} s: it is simulated in {windows(c)}."
