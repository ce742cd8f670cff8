"""The tables of the comparison's page. Degrees stand small under radians."""

from __future__ import annotations

from collections import Counter
from html import escape

from rovval.comparison import metrics
from rovval.core.channels import AXES
from rovval.core.data import ChannelError, Comparison
from rovval.core.units import DEGREE_UNITS, DEGREES
from rovval.report.common import page, words
from rovval.report.common.words import number, per_cent
from rovval.report.comparison import windows
from rovval.report.comparison.table import skill

_DASH = "–"


def axes(c: Comparison) -> str:
    """Free run and windows side by side, with the error relative to the motion as a bar."""
    if len(c.not_measured) == len(AXES):
        return f'<p class="lead">{words.NO_VELOCITY}</p>'
    over = (
        f'<tr class="over"><th></th><th></th><th class="first l" colspan="5">Free run</th>'
        f'<th class="first l" colspan="4">{windows.label(c).capitalize()}</th><th class="first"></th><th></th></tr>'
    )
    header = ["axis", "unit", "mean error", "MAE", "RMSE", "IAE", "skill", "RMS", "IAE", "skill", "of the motion", "no motion", "rows"]
    rows = []
    for axis in dict.fromkeys((*c.free, *c.windowed)):
        free, windowed = c.free.get(axis), c.windowed.get(axis)
        row = next(r for r in (free, windowed) if r is not None)
        cells = [escape(axis), _unit(row)]
        cells += [_value(free, n) for n in ("mean_error", "mae", "rmse", "iae")] + [_skill(free)]
        cells += [_value(windowed, n) for n in ("rmse", "iae")] + [_skill(windowed), _bar(windowed or row)]
        rows.append([*cells, _value(row, "baseline_rmse"), f"{row.n}<small>{per_cent(row.coverage)}</small>"])
    rows += [[escape(axis), *["not measured"], *[""] * 11] for axis in c.not_measured]
    return page.table(header, rows, over=over, left=(0, 1, 10))


def other(c: Comparison) -> str:
    """The other simulator and ours on the same rows."""
    name = escape(c.other_name)
    header = ["axis", "unit", f"MAE, {name}", "MAE, ours", "ours in windows", f"RMSE, {name}", "RMSE, ours", f"skill, {name}", "rows"]
    rows = []
    for axis, row in c.other.items():
        pairs = []
        for theirs, mine in ((row.mae, row.extra.get("ours_mae")), (row.rmse, row.extra.get("ours_rmse"))):
            nearer = mine is not None and mine < theirs
            pairs.append((_plain(theirs, row.unit, not nearer), _plain(mine, row.unit, nearer)))
        windows = _plain(row.extra.get("ours_windowed_mae"), row.unit)
        rows.append([escape(axis), _unit(row), *pairs[0], windows, *pairs[1], _skill(row), str(row.n)])
    return page.table(header, rows, left=(0, 1))


def pose(c: Comparison) -> str:
    """Depth and attitude of the windows."""
    header = ["", "unit", "mean error", "MAE", "RMSE", "skill", "stays where it began", "rows"]
    rows = [
        [
            words.TITLES[name],
            _unit(row),
            *(_value(row, n) for n in ("mean_error", "mae", "rmse")),
            _skill(row),
            _value(row, "baseline_rmse"),
            f"{row.n}<small>{per_cent(row.coverage)}</small>",
        ]
        for name, row in c.pose.items()
    ]
    return page.table(header, rows, left=(0, 1)) if rows else ""


def clock(c: Comparison) -> str:
    """What the stamps are worth."""
    k = c.run.clock
    offset = "could not be had" if k.offset_s is None else f"{number(k.offset_s)} s (positive: navigation is stamped late)"
    facts = {
        "stamps taken from": f"{k.stamp} clock",
        "samples matched to the grid": f"{k.matched} of {k.samples}",
        "largest gap": f"{number(k.largest_gap_s)} s",
        "offset between thrusters and navigation": offset,
        "its correlation": "" if k.correlation is None else number(k.correlation),
        "note": k.note,
    }
    return page.table(["", ""], [[escape(a), escape(b)] for a, b in facts.items() if b], left=(0, 1))


def findings(c: Comparison) -> str:
    """Facts about the log that its reader should know."""
    items = "".join(
        f"<li><code>{escape(f.code)}</code><span>{escape(f.where)}: {escape(f.detail)}</span></li>" for f in c.run.findings
    )
    return f'<ul class="findings">{items}</ul>' if items else '<p class="lead">None.</p>'


def findings_note(c: Comparison) -> str:
    """How many there are and of which kinds, with the way to them; "" for none."""
    kinds = Counter(f.code.replace("_", " ") for f in c.run.findings)
    if not kinds:
        return ""
    said = ", ".join(f"{kind} ({count})" if count > 1 else kind for kind, count in kinds.items())
    some = f"{kinds.total()} finding{'s'[: kinds.total() > 1]} in this log"
    return f'<p class="note"><a href="#findings">{some}</a>: {escape(said)}.</p>'


def _unit(row: ChannelError) -> str:
    small = f"<small>{DEGREE_UNITS[row.unit]}</small>" if row.unit in DEGREE_UNITS else ""
    return f"{row.unit}{small}"


def _value(row: ChannelError | None, name: str) -> str:
    if row is None:
        return _DASH
    unit = f" {metrics.get('iae').unit_of(row.unit)}" if name == "iae" else ""
    value = getattr(row, name)
    degrees = unit.replace("rad", "deg")
    small = f"<small>{number(value * DEGREES)}{degrees}</small>" if row.unit in DEGREE_UNITS else ""
    return f"{number(value)}{unit}{small}"


def _plain(value: float | None, unit: str, best: bool = False) -> str:
    if value is None:
        return _DASH
    small = f"<small>{number(value * DEGREES)}</small>" if unit in DEGREE_UNITS else ""
    return (f'<span class="best">{number(value)}</span>' if best else number(value)) + small


def _skill(row: ChannelError | None) -> str:
    if row is None or row.skill is None:
        return _DASH
    return f'<span class="neg">{skill(row.skill)}</span>' if row.skill <= 0 else skill(row.skill)


def _bar(row: ChannelError) -> str:
    share = words.relative(row)
    if share is None:
        return _DASH
    css = "track over" if share >= 1 else "track"
    label = per_cent(share) if share < 10 else f"{number(share, 2)} x"
    return f'<span class="{css}"><i style="width:{min(share, 1) * 100:.0f}%"></i></span> {label}'
