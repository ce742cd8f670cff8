"""A fit to be read in a terminal."""

from __future__ import annotations

from typing import Any


def text(document: dict[str, Any]) -> str:
    """The document to be read in a terminal."""
    rows, shrunk = document["parameters"], document["shrinkage"]
    lines = [f"{document['run']}: {document['vehicle']}, model {document['model']}, {document['windows']} windows of {document['window_s']:g} s"]
    if rows:
        lines.append(f"The squared gap {_changes(shrunk)} on held-out windows with {len(rows)} parameter{'s' if len(rows) > 1 else ''} tuned.")
        width = max(map(len, rows))
        lines += ["", f"{'tuned':{width}}       was      value   90 % interval"]
    for name, row in rows.items():
        unit = "" if row["unit"] == "1" else f" {row['unit']}"
        note = "  rests at its bound" if row["at_bound"] else "" if row["differs"] else "  not distinguishable from what it was"
        lines.append(f"{name:{width}}  {row['was']:8.3g}  {row['value']:9.3g}   [{row['low']:.3g}, {row['high']:.3g}]{unit}{note}")
    if document["undetermined"]:
        lines += ["", "These logs cannot determine (left as they were):", *(f"  {u['parameter']}: {u['why']}" for u in document["undetermined"])]
    if document["harm"]:
        lines += ["", "Worse with it, in squared error: " + ", ".join(f"{h['axis']} by {100 * h['change']:.0f} %" for h in document["harm"]) + "."]
    if rows and shrunk["low"] <= 0:
        lines += ["", "Not shown to be better on held-out windows: use fewer parameters, shorter windows or more logs before using this vehicle."]
    lines += [f"Left out: {why}" for why in document["left_out"]]
    if not rows:
        lines += ["", "Nothing was tuned. Next: a log that moves on the axes, or turns the thrusters, that these parameters act on."]
    return "\n".join([*lines, ""])


def _changes(shrunk: dict[str, Any]) -> str:
    verb, sign = ("shrinks", 1) if shrunk["total"] >= 0 else ("grows", -1)
    ends = sorted(100 * sign * shrunk[end] for end in ("low", "high"))
    return f"{verb} by {100 * sign * shrunk['total']:.0f} % [{ends[0]:.0f}, {ends[1]:.0f}]"
