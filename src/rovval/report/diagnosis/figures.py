"""The pictures of a diagnosis: heat maps, whiskers, the ranking with its brackets, the manoeuvre's schedule, curves before and after."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rovval.core.units import in_degrees
from rovval.diagnose.result.diagnosis import Coherence, Diagnosis, HeatMap, ScheduleLeg, Trace
from rovval.report.common.numbers import estimate, per_cent
from rovval.report.diagnosis.sentences import plain
from rovval.report.diagnosis.sentences.words import group
from rovval.report.diagnosis.tables import MOST_RANKED
from rovval.report.drawings import columns, curves
from rovval.report.drawings.curves import Place
from rovval.report.drawings.drawing import Box, Dot, Drawing, Line, Shape, Text

MOST_REGIMES = 10


@dataclass(frozen=True, slots=True)
class Cell:
    """A coloured cell: its text, a smaller one under it, and how strong its colour is, from 0 to 0.5: words on it stay readable."""

    text: str
    small: str = ""
    alpha: float = 0.0


@dataclass(frozen=True, slots=True)
class Heat:
    """A table of coloured cells with its headings and, of each row, its name."""

    heads: Sequence[str]
    rows: Sequence[tuple[str, Sequence[Cell]]]


def heat_map(heat: HeatMap) -> Heat:
    """Regimes down, axes across; the colour is the share of the axis's gap, the small number the lift."""
    top = max((value for row in heat.share for value in row), default=0.0) or 1.0
    rows = []
    for j, regime in enumerate(heat.regimes):
        cells = [Cell(per_cent(share[j]), f"x {lift[j]:.1f}", _alpha(share[j], top)) for share, lift in zip(heat.share, heat.lift, strict=True)]
        rows.append((plain.regime(regime), cells))
    return Heat(heat.axes, rows)


def main_regimes(d: Diagnosis, heat: HeatMap) -> HeatMap | None:
    """The regimes that hold most of the gap beyond their time; None where all of them are few enough to be shown at once."""
    if len(heat.regimes) <= MOST_REGIMES:
        return None
    weight = [d.gap.axes[axis].share if axis in d.gap.axes else 0.0 for axis in heat.axes]

    def excess(j: int) -> float:
        return max(w * (s[j] - s[j] / x[j] if x[j] else 0.0) for w, s, x in zip(weight, heat.share, heat.lift, strict=True))

    kept = sorted(sorted(range(len(heat.regimes)), key=excess, reverse=True)[:MOST_REGIMES])
    share, lift = (tuple(tuple(row[j] for j in kept) for row in values) for values in (heat.share, heat.lift))
    return HeatMap(axes=heat.axes, regimes=tuple(heat.regimes[j] for j in kept), share=share, lift=lift)


def matrix(coherence: Coherence) -> Heat:
    """How alike the effects' signatures are in this log: 1 is not to be told apart."""
    rows = []
    for k, (effect, row) in enumerate(zip(coherence.effects, coherence.matrix, strict=True)):
        rows.append((effect, [Cell("·") if j == k else Cell(f"{v:.2f}", alpha=_alpha(abs(v), 1.0)) for j, v in enumerate(row)]))
    return Heat(coherence.effects, rows)


def whisker(value: float, low: float, high: float, null: float = 0.0, unit: str = "1") -> Drawing:
    """An interval on a line that shows the value of "no effect" as a tick."""
    width, height, ends = 170.0, 18.0, (min(low, null, value), max(high, null, value))
    span, middle = (ends[1] - ends[0]) or 1.0, height / 2

    def x(v: float) -> float:
        return 8.0 + (width - 16.0) * (v - ends[0]) / span

    shapes = (
        Line(4, middle, width - 4, middle, "axis"),
        Line(x(null), 2, x(null), height - 2, "base"),
        Box(x(low), middle - 3, max(x(high) - x(low), 1), 6, "span", 2),
        Dot(x(value), middle, 4, "dot"),
    )
    return Drawing(width, height, estimate(value, low, high, unit), shapes)


def schedule(legs: Sequence[ScheduleLeg]) -> Drawing | None:
    """The manoeuvre's thruster speeds over time, a lane a thruster; None for a manoeuvre without any."""
    names = list(dict.fromkeys(name for leg in legs for name in leg.thrusters))
    if not names:
        return None
    width, left, lane = 560.0, 62.0, 34.0
    end = max(leg.t_s + leg.duration_s for leg in legs) or 1.0
    peak = max((abs(v) for leg in legs for v in leg.thrusters.values()), default=0.0) or 1.0
    height = lane * len(names) + 24.0

    def x(t: float) -> float:
        return left + (width - left - 10) * t / end

    shapes: list[Shape] = []
    for k, name in enumerate(names):
        middle = lane * (k + 0.5)
        shapes += [Text(0, middle + 4, name), Line(left, middle, width - 10, middle, "axis")]
        for leg in legs:
            if speed := leg.thrusters.get(name, 0.0):
                tall, wide = (lane / 2 - 4) * speed / peak, x(leg.t_s + leg.duration_s) - x(leg.t_s)
                shapes.append(Box(x(leg.t_s), middle - max(tall, 0.0), wide, abs(tall), "step"))
                centre, below = x(leg.t_s) + wide / 2, middle + (14 if speed > 0 else -5)
                shapes += [Text(centre, below, f"{speed:g}", "m", "middle")] if wide > 34 else []
    for t in dict.fromkeys([0.0, *(leg.t_s for leg in legs), end]):
        shapes.append(Text(x(t), height - 6, f"{t:g}{' s' if t == end else ''}", "m", "middle" if t < end else "end"))
    rows = [(name, leg.t_s, leg.duration_s, speed) for leg in legs for name, speed in leg.thrusters.items()]
    heads = ("thruster", "from, s", "for, s", "speed, rpm")
    return Drawing(width, height, "thruster schedule, rpm", tuple(shapes), {h: columns.words(v) for h, v in zip(heads, zip(*rows, strict=True), strict=True)})


@dataclass(frozen=True, slots=True)
class Ranked:
    """An effect of the screen as a bar of ``width`` per cent, and what of each bracket stands beside it: its style and its words."""

    effect: str
    score: float
    width: float
    named: bool
    brackets: Sequence[tuple[str, str]]


def ranking(d: Diagnosis) -> list[Ranked]:
    """The best of the screen; a bracket joins the members of a group that this log cannot tell apart."""
    best = d.ranking[:MOST_RANKED]
    names, groups = [r.effect for r in best], [m for c in d.causes if len(m := group(c)) > 1]
    top = max((r.score for r in best), default=0.0) or 1.0
    full = 1.0 if 0.5 < top <= 1.0 else top
    members = [[names.index(m) for m in g if m in names] for g in groups]
    named = {c.effect for c in d.causes}
    return [
        Ranked(r.effect, r.score, 100.0 * max(0.0, min(1.0, r.score / full)), r.effect in named, [_bracket(k, m) for m in members])
        for k, r in enumerate(best)
    ]


def traces(d: Diagnosis) -> tuple[dict[str, Any], list[dict[str, Any]], list[Place]]:
    """The worst stretches, measured, nominal and corrected: time axes, what the script draws, and where."""
    axes, drawn, places = {}, [], []
    for k, trace in enumerate(d.traces):
        step = -(-len(trace.t_s) // curves.MOST_POINTS) or 1
        axes[f"trace{k}"] = curves.encode(np.array(trace.t_s, dtype=float)[::step])
        drawn.append(curves.plot(f"trace-{k}", _series(trace, step, bool(d.causes)), f"trace{k}"))
        places.append(Place(f"trace-{k}", trace.title or trace.axis, in_degrees(1.0, trace.unit)[1]))
    return axes, drawn, places


def _series(trace: Trace, step: int, corrected: bool) -> list[dict[str, Any]]:
    shown = {"measured": trace.measured, "nominal": trace.nominal} | ({"corrected": trace.corrected} if corrected else {})
    factor = in_degrees(1.0, trace.unit)[0]
    return [curves.series(key, key, np.array(values, dtype=float)[::step] * factor) for key, values in shown.items()]


def _bracket(k: int, members: Sequence[int]) -> tuple[str, str]:
    """What of a bracket round ``members`` stands in row ``k``."""
    if not members or not min(members) <= k <= max(members):
        return "", ""
    parts: Mapping[str, bool] = {"on": k in members, "top": k == min(members), "end": k == max(members)}
    css = " ".join(["in", *(name for name, here in parts.items() if here)])
    return css, "cannot be told apart" if parts["top"] and len(members) > 1 else ""


def _alpha(value: float, top: float) -> float:
    return 0.5 * max(0.0, min(value / top, 1.0))
