"""The pictures of a diagnosis as HTML: heat maps, whiskers, matrix, schedule. No script is needed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape
from typing import Any

from rovval.report.common.numbers import number, per_cent
from rovval.report.diagnosis import svg
from rovval.report.diagnosis import words as dw

_MOST_REGIMES = 10


def heat_maps(document: dw.Document) -> str:
    """The regimes that hold most of the gap beyond their time, and, folded away, all of them."""
    heat = document.get("heatmap") or {}
    axes, regimes, share, lift = (heat.get(k) or [] for k in ("axes", "regimes", "share", "lift"))
    if len(regimes) <= _MOST_REGIMES:
        return heat_map(heat)
    rows = (document.get("gap") or {}).get("axes") or {}
    weight = [(rows.get(a) or {}).get("share") or 0.0 for a in axes]

    def excess(j: int) -> float:
        return max(w * (s[j] - s[j] / x[j] if x[j] else 0.0) for w, s, x in zip(weight, share, lift, strict=True))

    kept = sorted(sorted(range(len(regimes)), key=excess, reverse=True)[:_MOST_REGIMES])
    some = {key: [[row[j] for j in kept] for row in values] for key, values in (("share", share), ("lift", lift))}
    few = heat_map({"axes": axes, "regimes": [regimes[j] for j in kept], **some})
    note = '<p class="note">Share of the axis\'s gap in each regime; x: how many times its part of the time.</p>'
    return f"{few}{note}<details><summary>All {len(regimes)} regimes</summary>{heat_map(heat)}</details>"


def heat_map(heat: Mapping[str, Any]) -> str:
    """Regimes down, axes across; the colour is the share of the axis's gap, the small number the lift."""
    axes, regimes, share, lift = (heat.get(k) or [] for k in ("axes", "regimes", "share", "lift"))
    top = max((v for row in share for v in row if v is not None), default=0.0) or 1.0
    rows = []
    for j, regime in enumerate(regimes):
        cells = []
        for i in range(len(axes)):
            value = share[i][j] if i < len(share) and j < len(share[i]) else None
            times = lift[i][j] if i < len(lift) and j < len(lift[i]) else None
            small = "" if times is None else f"<small>x {times:.1f}</small>"
            cells.append(_cell(value, top, f"{per_cent(value)}{small}" if value is not None else "–"))
        rows.append(f'<tr><th scope="row">{escape(str(regime))}</th>{"".join(cells)}</tr>')
    head = "".join(f'<th scope="col">{escape(str(a))}</th>' for a in axes)
    return _heat(f"<tr><th></th>{head}</tr>", rows) if rows else ""


def matrix(coherence: Mapping[str, Any]) -> str:
    """How alike the effects' signatures are in this log: 1 is not to be told apart."""
    effects, values = coherence.get("effects") or [], coherence.get("matrix") or []
    rows = []
    for k, (effect, row) in enumerate(zip(effects, values, strict=False)):
        cells = "".join(
            _cell(None, 1.0, "·") if j == k or v is None else _cell(abs(v), 1.0, f"{v:.2f}") for j, v in enumerate(row)
        )
        rows.append(f'<tr><th scope="row"><code>{escape(str(effect))}</code></th>{cells}</tr>')
    head = "".join(f'<th scope="col" class="up"><code>{escape(str(e))}</code></th>' for e in effects)
    return _heat(f"<tr><th></th>{head}</tr>", rows) if rows else ""


def whisker(value: float | None, low: float | None, high: float | None, null: float = 0.0) -> str:
    """An interval on a line that shows the value of "no effect" as a tick."""
    if value is None or low is None or high is None:
        return ""
    w, h, ends = 170.0, 18.0, (min(low, null, value), max(high, null, value))
    span = (ends[1] - ends[0]) or 1.0

    def x(v: float) -> float:
        return 8.0 + (w - 16.0) * (v - ends[0]) / span

    parts = [svg.line(4, h / 2, w - 4, h / 2, "axis"), svg.line(x(null), 2, x(null), h - 2, "base")]
    parts.append(f'<rect x="{x(low):.1f}" y="{h / 2 - 3:.1f}" width="{max(x(high) - x(low), 1):.1f}" height="6" rx="2" class="span"/>')
    parts.append(f'<circle cx="{x(value):.1f}" cy="{h / 2:.1f}" r="4" class="dot"/>')
    return f'<span class="whisker">{svg.svg(w, h, f"{number(value)}, {number(low)} to {number(high)}", *parts)}</span>'


def schedule(steps: Sequence[Mapping[str, Any]]) -> str:
    """The manoeuvre's thruster speeds over time, a lane a thruster."""
    names = list(dict.fromkeys(n for s in steps for n in (s.get("thrusters") or {})))
    if not names:
        return ""
    w, left, lane = 560.0, 62.0, 34.0
    end = max(s["t_s"] + s["duration_s"] for s in steps) or 1.0
    peak = max((abs(v) for s in steps for v in (s.get("thrusters") or {}).values()), default=0.0) or 1.0
    height = lane * len(names) + 24.0
    parts = []
    for k, name in enumerate(names):
        middle = lane * (k + 0.5)
        parts += [svg.text(0, middle + 4, name), svg.line(left, middle, w - 10, middle, "axis")]
        for s in steps:
            speed = (s.get("thrusters") or {}).get(name, 0.0)
            if not speed:
                continue
            x1, x2 = (left + (w - left - 10) * t / end for t in (s["t_s"], s["t_s"] + s["duration_s"]))
            tall = (lane / 2 - 4) * speed / peak
            y = middle - max(tall, 0.0)
            parts.append(f'<rect x="{x1:.1f}" y="{y:.1f}" width="{x2 - x1:.1f}" height="{abs(tall):.1f}" class="step"/>')
            label = middle + (14 if speed > 0 else -5)
            parts.append(svg.text((x1 + x2) / 2, label, f"{speed:g}", "m", "middle") if x2 - x1 > 34 else "")
    for t in dict.fromkeys([0.0, *(s["t_s"] for s in steps), end]):
        x = left + (w - left - 10) * t / end
        parts.append(svg.text(x, height - 6, f"{t:g}{' s' if t == end else ''}", "m", "middle" if t < end else "end"))
    return f'<div class="flight">{svg.svg(w, height, "thruster schedule, rpm", *parts)}</div>'


def tiles(entries: Mapping[str, tuple[str, str]]) -> str:
    """The three questions and their answers, side by side."""
    items = "".join(
        f"<div><dt>{escape(k)}</dt><dd>{escape(big)}</dd><dd class='sub'>{escape(small)}</dd></div>"
        for k, (big, small) in entries.items()
        if big
    )
    return f'<dl class="tiles">{items}</dl>' if items else ""


def axis_bar(share: float | None) -> str:
    """A share from 0 to 1 as a bar, red to the other side when negative."""
    if share is None:
        return "–"
    css = "track wide over" if share < 0 else "track wide"
    return f'<span class="{css}"><i style="width:{min(abs(share), 1) * 100:.0f}%"></i></span> {per_cent(share)}'


def _cell(value: float | None, top: float, content: str) -> str:
    alpha = 0.0 if value is None else 0.6 * max(0.0, min(value / top, 1.0))
    return f'<td style="background:rgba(var(--heat),{alpha:.2f})">{content}</td>'


def _heat(head: str, rows: Sequence[str]) -> str:
    return f'<div class="scroll"><table class="heat"><thead>{head}</thead><tbody>{"".join(rows)}</tbody></table></div>'
