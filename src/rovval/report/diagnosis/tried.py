"""The effects that were tried, on the page: those weighed against each other by re-simulation, and the screen of the whole library."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape
from typing import Any

from rovval.report.common.numbers import number
from rovval.report.diagnosis import glue as page
from rovval.report.diagnosis.parts import axis_bar
from rovval.report.diagnosis.words import group

MOST, MOST_RANKED = 8, 16  # of a round, of the screen
_WEIGHED = "Each was fitted by re-simulation. Bar: the part of the squared gap that it closes on held-out windows. Evidence: twice the log Bayes factor."
_SCREEN = "Score: the part of the squared gap that is gone on held-out windows"


def section(d: Mapping[str, Any]) -> str:
    """The finalists, weighed against each other, and the screen of the whole library; folded away where there were finalists."""
    weighed, slop = finalists(d), (d.get("detection") or {}).get("slop")
    beside = "" if slop is None else f", calibration slop free beside the effect (slop alone: {number(slop, 2)}); small differences say nothing"
    screen = ranking(d)
    if weighed and screen:
        screen = f"<details><summary>The screen that chose them: the whole library</summary><p>{_SCREEN}{beside}.</p>{screen}</details>"
        return page.section("Effects weighed against each other", *weighed, screen, lead=_WEIGHED)
    return page.section("All effects tried", screen, lead=f"{_SCREEN}{beside}.")


def rounds(document: Mapping[str, Any]) -> list[tuple[str, Sequence[Mapping[str, Any]]]]:
    """Every round that had finalists, with what it asked: on their own, beside what was found, or that it named none."""
    found = [str(c["effect"]) for c in document.get("causes") or ()]
    titled = []
    for k, rows in enumerate(document.get("finalists") or ()):
        beside = f"Beside {', '.join(found[:k])}" if k and found else "On its own"
        title = beside if k < len(found) else f"{beside}: none was named, for too little gain, evidence or size beyond slop"
        titled += [(title, rows[:MOST])] if rows else []
    return titled


def finalists(document: Mapping[str, Any]) -> list[str]:
    """A table a round: effect, what it closes of the gap, evidence, and whether it was named or stands beside the one that was."""
    causes = {str(c["effect"]): group(c) for c in document.get("causes") or ()}
    alike = {name: lead for lead, members in causes.items() for name in members[1:]}
    tables = []
    for title, rows in rounds(document):
        cells = []
        for row in rows:
            name = str(row["effect"])
            said = "<b>named</b>" if name in causes else f"cannot be told from {escape(alike[name])}" if name in alike else ""
            cells.append([f"<code>{escape(name)}</code>", axis_bar(row.get("gain")), number(row.get("evidence"), 2), said])
        tables.append(f"<h3>{escape(title)}</h3>" + page.table(["effect", "closes of the squared gap", "evidence", ""], cells, left=(0, 1, 3)))
    return tables


def ranking(document: Mapping[str, Any]) -> str:
    """Every effect's score as a bar; a bracket joins the members of a group that this log cannot tell apart."""
    ranked = list(document.get("ranking") or ())
    causes = list(document.get("causes") or ())
    groups = [m for m in (group(c) for c in causes) if len(m) > 1]
    chosen = {str(c["effect"]) for c in causes}
    shown = ranked[:MOST_RANKED]
    best = max((r.get("score") or 0.0 for r in shown), default=0.0) or 1.0
    names = [str(r["effect"]) for r in shown]
    rows = []
    for k, r in enumerate(shown):
        score, name = r.get("score") or 0.0, names[k]
        width = max(0.0, min(1.0, score / (1.0 if 0.5 < best <= 1.0 else best))) * 100
        css = "hit" if name in chosen else ""
        braces = "".join(_brace(k, [names.index(m) for m in g if m in names]) for g in groups)
        rows.append(
            f'<tr class="{css}"><th scope="row"><code>{escape(name)}</code></th>'
            f'<td class="bar"><i style="width:{width:.1f}%"></i></td>'
            f"<td>{number(r.get('score'), 2)}</td>{braces}</tr>"
        )
    rest = f'<p class="note">{len(ranked) - len(shown)} more below.</p>' if len(ranked) > len(shown) else ""
    return f'<div class="scroll"><table class="rank"><tbody>{"".join(rows)}</tbody></table></div>{rest}' if rows else ""


def _brace(k: int, members: Sequence[int]) -> str:
    """One cell of a bracket's column."""
    if not members or not min(members) <= k <= max(members):
        return '<td class="brace"></td>'
    css = " ".join(w for w, is_it in (("on", k in members), ("top", k == min(members)), ("end", k == max(members))) if is_it)
    label = "cannot be told apart" if k == min(members) and len(members) > 1 else ""
    return f'<td class="brace in {css}"><span>{label}</span></td>'

