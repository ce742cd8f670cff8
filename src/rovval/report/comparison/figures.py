"""The pictures of a comparison: curves of velocity, pose and thruster speed, and how the error grows from a window's start."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil
from typing import Any

import numpy as np

from rovval.comparison.error_growth import HORIZONS_S, ErrorGrowth, error_growth
from rovval.comparison.tolerance import Tolerance
from rovval.core.channels import AXES, POSE, VELOCITIES
from rovval.core.data import Array, Comparison
from rovval.core.frames import wrap
from rovval.core.units import in_degrees
from rovval.report.common.numbers import number, per_cent, quantity
from rovval.report.comparison import tolerances
from rovval.report.comparison.words import TITLES
from rovval.report.drawings import columns, curves
from rovval.report.drawings.curves import Place
from rovval.report.drawings.drawing import Curve, Dot, Drawing, Line, Shape, Text, round_up
from rovval.report.drawings.hues import hues

Pictures = tuple[list[dict[str, Any]], list[Place]]  # what the script draws, and where


def velocities(c: Comparison, limits: Sequence[Tolerance] = ()) -> Pictures:
    """Measured and simulated velocity of each measured axis, in the tube of its tolerance, its error in a strip below."""
    pictures, places = [], []
    for j, (axis, name) in enumerate(zip(AXES, VELOCITIES, strict=True)):
        if axis in c.not_measured:
            continue
        factor, unit = in_degrees(1.0, "rad/s" if j > 2 else "m/s")
        real, free, windowed = (v * factor for v in (c.run.get(name), c.sim.free.nu[:, j], c.sim.windowed.nu[:, j]))
        drawn = [curves.series("measured", "measured", real)]
        if c.other_nu is not None:
            drawn.append(curves.series("other", c.other_name, c.other_nu[:, j] * factor))
        drawn += [curves.series("free", "free run", free), curves.series("windowed", "windows", windowed)]
        both = (("free", "free run", free - real), ("windowed", "windows", windowed - real))
        errors = [curves.difference(key, label, error, f"v-{axis}", len(drawn) - 2 + k) for k, (key, label, error) in enumerate(both)]
        tube = tolerances.tube(limits, axis)
        width = None if tube is None else tube.limit * factor
        pictures += [curves.plot(f"v-{axis}", drawn, tube=width, bare=True), curves.plot(f"v-{axis}-error", errors, error=True)]
        row = c.windowed.get(axis)
        note = "" if row is None else f"{quantity(row.rmse, row.unit)} rms in windows"
        note += "" if tube is None else f"; {per_cent(tolerances.inside(c, tube))} in the tube of {tube}"
        places.append(Place(f"v-{axis}", axis, unit, note, error=True))
    return pictures, places


def pose(c: Comparison) -> Pictures:
    """Depth and attitude, measured and in the windows."""
    pictures, places = [], []
    for name, row in c.pose.items():
        factor, unit = in_degrees(1.0, row.unit)
        measured, simulated = c.run.get(name), c.sim.windowed.eta[:, POSE.index(name)]
        if row.unit == "rad":
            measured, simulated = _unwrapped(measured, simulated)
        drawn = [curves.series("measured", "measured", measured * factor), curves.series("windowed", "windows", simulated * factor)]
        pictures.append(curves.plot(f"p-{name}", drawn))
        places.append(Place(f"p-{name}", TITLES[name], unit, f"{quantity(row.rmse, row.unit)} rms", "short"))
    return pictures, places


def thrusters(c: Comparison) -> tuple[list[dict[str, Any]], list[Place], dict[str, int]]:
    """The speed of every thruster as the simulation used it, and the hue (degrees on the colour circle) of each; empty without any."""
    names = c.sim.thrusters
    if not names or not np.isfinite(c.sim.thruster_speed).any():
        return [], [], {}
    shades = dict(zip(names, hues(len(names)), strict=True))
    drawn = [curves.series("thruster", name, c.sim.thruster_speed[:, j] * 60.0, hue=shades[name]) for j, name in enumerate(names)]
    return [curves.plot("thrusters", drawn)], [Place("thrusters", "thruster speed", "rpm", css="short")], shades


def growth_panels(c: Comparison) -> list[Drawing]:
    """A panel an axis: RMS error against the time since a window's start."""
    panels = []
    for axis, curve in error_growth(c).items():
        row = c.windowed[axis]
        factor, unit = in_degrees(1.0, row.unit)
        marks = [(t, v * factor) for s in HORIZONS_S if (p := curve.at(s)) is not None for t, v in [p]]
        panels.append(panel(axis, unit, curve, factor, row.baseline_rmse * factor, marks))
    return panels


@dataclass(frozen=True, slots=True)
class _Frame:
    """The sheet of a panel (pixels), and the time (s) and the value at its upper right corner."""

    end: float
    high: float
    width: float = 330.0
    height: float = 165.0
    left: float = 46.0
    right: float = 14.0
    top: float = 30.0
    bottom: float = 24.0

    def x(self, t: float) -> float:
        return self.left + (self.width - self.left - self.right) * t / self.end

    def y(self, v: float) -> float:
        return self.height - self.bottom - (self.height - self.top - self.bottom) * v / self.high


def panel(title: str, unit: str, curve: ErrorGrowth, factor: float, baseline: float, marks: Sequence[tuple[float, float]]) -> Drawing:
    """RMS error times ``factor`` against time, ``marks`` (time, value) as dots, and the error ``baseline`` of "no motion" dashed where it fits in."""
    peak = max(float(curve.rms.max()) * factor, 1e-12)
    fits = baseline <= 3.0 * peak
    f = _Frame(float(curve.seconds[-1]) or 1.0, round_up(max(peak, baseline if fits else 0.0) * 1.06))
    edge = f.width - f.right
    shapes: list[Shape] = [Text(0, 13, title, "b"), Text(f.width, 13, f"rms, {unit}", "m", "end"), *_axes(f)]
    points = tuple((f.x(float(t)), f.y(float(v) * factor)) for t, v in zip(curve.seconds, curve.rms, strict=True))
    shapes += [Line(f.left, f.y(baseline), edge, f.y(baseline), "base")] if fits else []
    shapes += [Curve(points, "growth"), *_marked(f, marks)]
    if fits:
        shapes.append(Text(edge, f.y(baseline) - 4, "no motion", "m", "end"))
    else:
        shapes.append(Text(edge, f.top - 1, f"no motion: {number(baseline, 2)}", "m", "end"))
    values = columns.against_time(float(curve.seconds[-1]) / max(len(curve.rms) - 1, 1), {f"rms, {unit}": curve.rms * factor})
    return Drawing(f.width, f.height, f"{title}: error against time since the window's start", tuple(shapes), values)


def _axes(f: _Frame) -> list[Shape]:
    """Three levels with their values, and the times of the marks."""
    shapes: list[Shape] = []
    for v in (0.0, f.high / 2.0, f.high):
        shapes += [Line(f.left, f.y(v), f.width - f.right, f.y(v), "grid"), Text(f.left - 6, f.y(v) + 4, f"{v:g}", "m", "end")]
    last = ceil(f.end)
    for t in (0.0, *(m for m in (1.0, 2.0, 5.0, last) if m <= last)):
        shapes.append(Text(min(f.x(t), f.width - f.right), f.height - 7, f"{t:g} s" if t == last else f"{t:g}", "m", "middle"))
    return shapes


def _marked(f: _Frame, marks: Sequence[tuple[float, float]]) -> list[Shape]:
    """A dot and its number at each mark; a number that its neighbour's crowds out is left off."""
    shapes: list[Shape] = []
    for k, (t, v) in enumerate(marks):
        x, y = f.x(t), f.y(v)
        shapes.append(Dot(x, y, 3, "growth-mark"))
        crowded = 0 < k < len(marks) - 1 and x - f.x(marks[k - 1][0]) < 40.0
        if crowded and y > f.height - f.bottom - 22.0:
            continue
        shapes.append(Text(x, y + 17 if crowded or y < f.top + 12 else y - 8, number(v, 2), "", "end" if t > 0.9 * f.end else "middle"))
    return shapes


def _unwrapped(measured: Array, simulated: Array) -> tuple[Array, Array]:
    """Angles without jumps at half a turn: the measured one followed round, the simulated one drawn beside it."""
    there = np.isfinite(measured)
    followed = np.full(len(measured), np.nan)
    followed[there] = np.unwrap(measured[there])
    gap = simulated - measured
    return followed, np.where(np.isfinite(gap), followed + wrap(np.nan_to_num(gap)), np.nan)
