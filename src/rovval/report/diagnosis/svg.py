"""Small drawings as inline SVG: they need no script and take their colours from the page."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from math import ceil, floor, log10

from rovval.core.data import Array
from rovval.report.common.numbers import number


def text(x: float, y: float, words: str, css: str = "", anchor: str = "start") -> str:
    """One line of text."""
    return f'<text x="{x:.1f}" y="{y:.1f}" class="{css}" text-anchor="{anchor}">{escape(words)}</text>'


def line(x1: float, y1: float, x2: float, y2: float, css: str) -> str:
    """One straight line."""
    return f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" class="{css}"/>'


def svg(width: float, height: float, label: str, *parts: str) -> str:
    """The drawing, with a label for those who cannot see it."""
    inner = "".join(parts)
    return f'<svg viewBox="0 0 {width:g} {height:g}" role="img" aria-label="{escape(label)}">{inner}</svg>'


def round_up(value: float) -> float:
    """The next of 1, 2, 2.5, 5 times a power of ten."""
    if value <= 0.0:
        return 1.0
    power = 10.0 ** floor(log10(value))
    return next(m * power for m in (1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0) if m * power >= value * (1 - 1e-9))


def horizon(title: str, unit: str, seconds: Array, rms: Array, baseline: float, marks: Sequence[tuple[float, float]]) -> str:
    """RMS error against the time since a window's start, with the error of "no motion" as a dashed line where it fits in."""
    w, h, left, right, top, bottom = 330.0, 165.0, 46.0, 14.0, 30.0, 24.0
    peak = max(float(rms.max()), 1e-12)
    shown = baseline <= 3.0 * peak
    high = round_up(max(peak, baseline if shown else 0.0) * 1.06)
    end = float(seconds[-1]) or 1.0

    def at(t: float, v: float) -> tuple[float, float]:
        return left + (w - left - right) * t / end, h - bottom - (h - top - bottom) * v / high

    parts = [text(0, 13, title, "b"), text(w, 13, f"rms, {unit}", "m", "end")]
    for v in (0.0, high / 2.0, high):
        y = at(0.0, v)[1]
        parts += [line(left, y, w - right, y, "grid"), text(left - 6, y + 4, f"{v:g}", "m", "end")]
    for t in (0.0, *(m for m in (1.0, 2.0, 5.0, ceil(end)) if m <= ceil(end))):
        x = min(at(t, 0.0)[0], w - right)
        parts.append(text(x, h - 7, f"{t:g} s" if t == ceil(end) else f"{t:g}", "m", "middle"))
    labels = []
    if shown:
        y = at(0.0, baseline)[1]
        parts.append(line(left, y, w - right, y, "base"))
        labels.append(text(w - right, y - 4, "no motion", "m", "end"))
    else:
        labels.append(text(w - right, top - 1, f"no motion: {number(baseline, 2)}", "m", "end"))
    points = " ".join(f"{x:.1f},{y:.1f}" for x, y in (at(float(t), float(v)) for t, v in zip(seconds, rms, strict=True)))
    parts.append(f'<polyline points="{points}" fill="none" stroke="var(--windowed)" stroke-width="2"/>')
    for k, (t, v) in enumerate(marks):
        x, y = at(t, v)
        parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="var(--windowed)"/>')
        crowded = 0 < k < len(marks) - 1 and x - at(marks[k - 1][0], 0.0)[0] < 40.0  # its neighbour's number is in the way
        if crowded and y > h - bottom - 22.0:
            continue
        side = "end" if t > 0.9 * end else "middle"
        parts.append(text(x, y + 17 if crowded or y < top + 12 else y - 8, number(v, 2), "", side))
    return svg(w, h, f"{title}: error against time since the window's start", *parts, *labels)
