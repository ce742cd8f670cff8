"""The comparison as one HTML file: the answer first, then a table, then the curves to look at, then what it rests on."""

from __future__ import annotations

from html import escape
from typing import Any

import numpy as np

from rovval.comparison.error_growth import HORIZONS_S, horizons
from rovval.core.channels import AXES, POSE, VELOCITIES
from rovval.core.data import Array, Comparison
from rovval.core.frames import wrap
from rovval.core.units import DEGREES, in_degrees
from rovval.report.common import page, plots, svg, words
from rovval.report.common.words import number, quantity
from rovval.report.comparison import html_tables, windows
from rovval.report.comparison.json import versions


def text(comparison: Comparison, recording: bool = True) -> str:
    """The page; ``recording`` says that run.rrd lies beside it."""
    c, run = comparison, comparison.run
    pictures, places = _velocities(c)
    pose_pictures, pose_places = _pose(c)
    thruster_pictures, thruster_places = _thrusters(c)
    body = "".join(
        [
            page.head("Simulated against measured", run.id, words.synthetic(c), words.sentences(c), words.facts(c), html_tables.findings_note(c)),
            page.section("Error per axis", html_tables.axes(c), page.listing(words.notes(c)), lead="Simulated minus measured."),
            page.section(f"Beside {c.other_name}", html_tables.other(c), lead=_OTHER) if c.other else "",
            page.section("Velocities", page.switches(_keys(c)), places, lead=_how_drawn(c)) if pictures else "",
            page.section("How the error grows from a window's start", _horizons(c), lead=_HORIZON),
            page.section("Depth and attitude in the windows", html_tables.pose(c), pose_places),
            page.section("Thruster speed as used", thruster_places),
            page.section("Time stamps", html_tables.clock(c)),
            page.section("Findings in this log", html_tables.findings(c), anchor="findings"),
            page.section("Assumed, and where the simulation stopped", page.listing([*c.sim.assumptions, *c.sim.stops])),
            page.section("Recording", _RECORDING if recording else ""),
            page.footer(" · ".join(f"{k} {v}" for k, v in versions().items()) + f" · sha256 {run.sha256[:16]}"),
        ]
    )
    data = {"x": {"run": plots.times(len(run), run.dt)}, "plots": [*pictures, *pose_pictures, *thruster_pictures]}
    return page.page(f"{run.id} · rovval comparison", body, data)


_OTHER = "Free runs, over the rows that the log, our simulation and the other one have in common; the nearer one in bold."
_HORIZON = (
    "Root mean square over all windows. Flat from the first step: noise of the sensors, or motion too quick for the simulator. "
    "Climbing: a force that is wrong or missing."
)
_RECORDING = (
    "<p>Everything in time and in 3-D, both trajectories and the thrusts, is in <code>run.rrd</code> beside this file:</p>"
    "<pre>rerun run.rrd</pre><p class='note'>The viewer comes with <code>rerun-sdk</code>, which rovval has installed. "
    "The numbers are in <code>report.json</code>.</p>"
)


def _keys(c: Comparison) -> dict[str, str]:
    keys = {"measured": "measured", "windowed": f"simulated, {windows.label(c)}", "free": "simulated, free run"}
    return keys | ({"other": c.other_name} if c.other_nu is not None else {})


def _how_drawn(c: Comparison) -> str:
    k = plots.bucket(len(c.run))
    thinned = "" if k == 1 else f" Drawn as the lowest and highest of every {k} rows ({number(k * c.run.dt)} s), so that peaks stay."
    return "Drag to zoom into all of them, double-click for the whole run, press a name to hide its curve. The strip under each plot is the error." + thinned


def _velocities(c: Comparison) -> tuple[list[dict[str, Any]], str]:
    pictures, places = [], []
    for j, (axis, name) in enumerate(zip(AXES, VELOCITIES, strict=True)):
        if axis in c.not_measured:
            continue
        factor, unit = in_degrees(1.0, "rad/s" if j > 2 else "m/s")
        real, free, windowed = (v * factor for v in (c.run.get(name), c.sim.free.nu[:, j], c.sim.windowed.nu[:, j]))
        curves = [plots.series("measured", "measured", real)]
        if c.other_nu is not None:
            curves.append(plots.series("other", c.other_name, c.other_nu[:, j] * factor))
        curves += [plots.series("free", "free run", free), plots.series("windowed", "windows", windowed)]
        errors = [plots.series("free", "free run", free - real), plots.series("windowed", "windows", windowed - real)]
        pictures += [plots.plot(f"v-{axis}", curves, bare=True), plots.plot(f"v-{axis}-error", errors, error=True)]
        row = c.windowed.get(axis)
        note = "" if row is None else f"{quantity(row.rmse, row.unit)} rms in windows"
        places.append(page.canvas(f"v-{axis}", axis, unit, note, error=True))
    return pictures, f'<div class="plots">{"".join(places)}</div>'


def _pose(c: Comparison) -> tuple[list[dict[str, Any]], str]:
    pictures, places = [], []
    for name, row in c.pose.items():
        factor, unit = in_degrees(1.0, row.unit)
        measured, simulated = c.run.get(name), c.sim.windowed.eta[:, POSE.index(name)]
        if row.unit == "rad":
            measured, simulated = _unwrapped(measured, simulated)
        curves = [
            plots.series("measured", "measured", measured * factor),
            plots.series("windowed", "windows", simulated * factor),
        ]
        pictures.append(plots.plot(f"p-{name}", curves))
        places.append(page.canvas(f"p-{name}", words.TITLES[name], unit, f"{quantity(row.rmse, row.unit)} rms", "short"))
    return pictures, f'<div class="plots">{"".join(places)}</div>' if places else ""


def _unwrapped(measured: Array, simulated: Array) -> tuple[Array, Array]:
    """Angles without jumps at half a turn: the measured one followed round, the simulated one drawn beside it."""
    there = np.isfinite(measured)
    followed = np.full(len(measured), np.nan)
    followed[there] = np.unwrap(measured[there])
    gap = simulated - measured
    return followed, np.where(np.isfinite(gap), followed + wrap(np.nan_to_num(gap)), np.nan)


def _thrusters(c: Comparison) -> tuple[list[dict[str, Any]], str]:
    names = c.sim.thrusters
    if not names or not np.isfinite(c.sim.thruster_speed).any():
        return [], ""
    hues = [round(360 * j / len(names) + 15) % 360 for j in range(len(names))]
    curves = [
        plots.series("thruster", name, c.sim.thruster_speed[:, j] * 60.0, hue=hues[j]) for j, name in enumerate(names)
    ]
    legend = " ".join(f'<span style="color:hsl({h} 55% 50%)">{escape(n)}</span>' for n, h in zip(names, hues, strict=True))
    place = page.canvas("thrusters", "thruster speed", "rpm", "", "short")
    return [plots.plot("thrusters", curves)], f'<p class="note">{legend}</p><div class="plots wide">{place}</div>'


def _horizons(c: Comparison) -> str:
    panels = []
    for axis, curve in horizons(c).items():
        row = c.windowed[axis]
        factor, unit = (DEGREES, "deg/s") if row.unit == "rad/s" else (1.0, row.unit)
        marks = [(t, v * factor) for s in HORIZONS_S if (p := curve.at(s)) is not None for t, v in [p]]
        panels.append(svg.horizon(axis, unit, curve.seconds, curve.rms * factor, row.baseline_rmse * factor, marks))
    return f'<div class="panels">{"".join(panels)}</div>' if panels else ""
