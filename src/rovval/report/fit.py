"""A fit to be read in a terminal."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rovval.core.units import in_degrees
from rovval.report.common.numbers import interval, number, per_cent, share


def text(document: Mapping[str, Any]) -> str:
    """The parameters of a fit (rovval.fit/1) with their intervals, what the logs cannot determine, and what becomes of the gap."""
    rows, shrunk = document["parameters"], document["shrinkage"]
    lines = [f"{document['run']}: {document['vehicle']}, model {document['model']}, {document['windows']} windows of {document['window_s']:g} s"]
    if rows:
        lines.append(f"The squared gap {changes(shrunk)} on held-out windows with {len(rows)} parameter{'s' if len(rows) > 1 else ''} tuned.")
        lines += ["", *_table(rows)]
    if document["undetermined"]:
        lines += ["", "These logs cannot determine (left as they were):", *(f"  {u['parameter']}: {u['why']}" for u in document["undetermined"])]
    if document["harm"]:
        lines += ["", "Worse with it, in squared error: " + ", ".join(f"{h['axis']} by {per_cent(h['change'])}" for h in document["harm"]) + "."]
    if rows and shrunk["low"] <= 0:
        lines += ["", "Not shown to be better on held-out windows: use fewer parameters, shorter windows or more logs before using this vehicle."]
    lines += [f"Left out: {why}" for why in document["left_out"]]
    if not rows:
        lines += ["", "Nothing was tuned. Next: a log that moves on the axes, or turns the thrusters, that these parameters act on."]
    return "\n".join([*lines, ""])


def changes(shrunk: Mapping[str, float]) -> str:
    """shrinks by 34 % [10, 50]; grows by as much where ``total`` is negative."""
    if shrunk["total"] >= 0:
        return f"shrinks by {share(shrunk['total'], shrunk['low'], shrunk['high'])}"
    return f"grows by {share(-shrunk['total'], -shrunk['high'], -shrunk['low'])}"


def _table(rows: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """A line a parameter."""
    width = max(map(len, rows))
    lines = [f"{'tuned':{width}}  {'was':>8}  {'value':>9}   90 % interval"]
    for name, row in rows.items():
        note = "  rests at its bound" if row["at_bound"] else "" if row["differs"] else "  not distinguishable from what it was"
        was, value = (number(in_degrees(row[k], row["unit"])[0]) for k in ("was", "value"))
        lines.append(f"{name:{width}}  {was:>8}  {value:>9}   {interval(row['low'], row['high'], row['unit'])}{note}")
    return lines
