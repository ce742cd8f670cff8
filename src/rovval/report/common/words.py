"""Numbers and findings in words, the same in every format: three digits that mean something, and a verdict in one sentence."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from math import floor, isfinite, log10
from typing import Any

from rovval.core.data import ChannelError, Comparison
from rovval.core.units import in_degrees
from rovval.report.comparison import windows

LINEAR = ("surge", "sway", "heave")
TITLES = {"z": "depth", "phi": "roll angle", "theta": "pitch angle", "psi": "heading"}

NO_VELOCITY = "No velocity was measured in this log, so there is no error per axis; what was measured of the pose is compared below."


def number(value: float | None, digits: int = 3) -> str:
    """A number with so many significant digits and no exponent while it stays readable: 0.0712, 12.3, 1240."""
    if value is None or not isfinite(value):
        return "-"
    if value == 0.0:
        return "0"
    size = floor(log10(abs(float(f"{value:.{digits - 1}e}"))))
    if not -5 <= size < 7:
        return f"{value:.{digits - 1}e}"
    return f"{value:.{max(0, digits - 1 - size)}f}"


def per_cent(share: float | None) -> str:
    """A share as a percentage: 64 %, 0.3 %, -30 %."""
    if share is None or not isfinite(share):
        return "-"
    value = 100.0 * share
    return f"{value:.1f} %" if 0.05 <= abs(value) < 0.95 else f"{value:.0f} %".replace("-0 %", "0 %")


def listed(words: Iterable[str]) -> str:
    """surge, sway and yaw."""
    items = list(words)
    return items[0] if len(items) == 1 else f"{', '.join(items[:-1])} and {items[-1]}" if items else ""


def quantity(value: float, unit: str) -> str:
    """Value and unit as people read them."""
    shown, name = in_degrees(value, unit)
    return f"{number(shown)} {name}".removesuffix(" 1")


def duration(seconds: float) -> str:
    """90 s, 12 min 5 s, 1 h 20 min."""
    whole = round(seconds)
    if whole < 120:
        return f"{seconds:.0f} s" if seconds >= 10 else f"{seconds:.1f} s"
    if whole < 7200:
        return f"{whole // 60} min {whole % 60} s".removesuffix(" 0 s")
    return f"{whole // 3600} h {whole % 3600 // 60} min"


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
    table, where = comparison.windowed, f"over {windows.label(comparison)}"
    if not table:
        table, where = comparison.free, "over the free run"
    if not table:
        return [s for s in (_pose_only(comparison), windows.shortened(comparison)) if s]
    lines, turns = [a for a in table if a in LINEAR], [a for a in table if a not in LINEAR]
    worst = [max(group, key=lambda a: table[a].rmse) for group in (lines, turns) if group]
    gaps = " and, turning, in ".join(_gap(a, table[a]) for a in worst)
    said = [f"{where.capitalize()}, the simulator is furthest from the vehicle in {gaps}; {_skill(table)}."]
    if short := windows.shortened(comparison):
        said.append(short)
    if comparison.sim.stops:
        said.append(f"The simulation left sane limits, and the rows after that are not counted: {comparison.sim.stops[0]}.")
    if comparison.other:
        said.append(_beside(comparison))
    if comparison.not_measured:
        said.append(f"Not measured in this log: {listed(comparison.not_measured)}.")
    return said


def _pose_only(comparison: Comparison) -> str:
    """For a log without velocities: the pose channels that it has."""
    gaps = listed([f"{TITLES[name]} ({quantity(row.rmse, row.unit)} rms)" for name, row in comparison.pose.items()])
    return (
        f"No velocity was measured in this log. In {windows.label(comparison)}, started from the measured pose, "
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
    judged = [a for a in table if table[a].skill is not None]
    worse = [a for a in judged if (table[a].skill or 0.0) <= 0.0]
    if not judged:
        return "the vehicle never moved, so there is no skill to speak of"
    if not worse:
        return f"it does better than predicting no motion {'on every measured axis' if len(judged) > 1 else f'in {judged[0]}'}"
    if len(worse) == len(judged):
        return f"it does worse than predicting no motion {'on every measured axis' if len(judged) > 1 else f'in {judged[0]}'}"
    better = listed(a for a in judged if a not in worse)
    return f"it does worse than predicting no motion in {listed(worse)} and better in {better}"


def notes(comparison: Comparison) -> list[str]:
    """What a reader must know beside the numbers: rows that could not be compared, and how they were counted."""
    result = []
    for axis in comparison.windowed.keys() ^ comparison.free.keys():
        form = "free run" if axis in comparison.windowed else "windows"
        result.append(f"{axis}: measured, but no row of the {form} could be compared")
    result.append(
        f"{windows.label(comparison)}, each restarted from the measured state; RMS over all their rows, the first one included"
    )
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
