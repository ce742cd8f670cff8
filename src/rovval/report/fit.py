"""A fit to be read in a terminal, or as a page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from rovval.core.counts import counted
from rovval.core.units import in_degrees
from rovval.report import calibration as calibration_page
from rovval.report.common.numbers import interval, number, per_cent, share
from rovval.report.common.page import render
from rovval.report.common.terminal import fitted
from rovval.report.common.versions import foot

MOST_PAIRS = 5  # correlated pairs that are named
FAR = 2.0  # standard deviations of the prior from which a departure is told


def text(document: Mapping[str, Any]) -> str:
    """A fit of chosen parameters (rovval.fit/1) or a calibration (rovval.calibration/1)."""
    return fitted(calibration(document) if is_calibration(document) else tuned(document))


def html(document: Mapping[str, Any]) -> str:
    """The page of either, self-contained."""
    if is_calibration(document):
        return calibration_page.html(document)
    return render(
        "fit.html", title=f"{document['run']} · rovval fit", eyebrow="Fit", name=document["run"], banner="",
        said=[f"{counted(len(document['parameters']), 'parameter')} tuned."], facts={key: document[key] for key in ("vehicle", "model", "windows")},
        parameters=document["parameters"], text=text(document), footer=foot(),
    )  # fmt: skip


def is_calibration(document: Mapping[str, Any]) -> bool:
    """Whether a document is of a calibration, and not of chosen parameters."""
    return document.get("schema") == "rovval.calibration/1"


def calibration(document: Mapping[str, Any]) -> str:
    """The unknowns of a calibration beside the file, which of them go together, and errors of free runs, predicted ones among them."""
    rows = document["unknowns"]
    shown = {key: row for key, row in rows.items() if row["shown"]}
    lines = [f"{document['run']}: {document['vehicle']}, {len(rows)} unknowns, of which these logs show {len(shown)}", ""]
    lines += _beside_file(shown)
    if held := [key for key in rows if key not in shown]:
        lines += ["", f"Held by their prior, since these logs hardly show them: {', '.join(held)}."]
    if pairs := document["correlations"]:
        said = "; ".join(f"{' and '.join(pair['of'])} ({number(pair['value'], 2)})" for pair in pairs[:MOST_PAIRS])
        lines += ["", f"Seen together only (correlation): {said}."]
        lines += ["Of forces, a log shows their ratio to the mass: what separates them is a manoeuvre with less of one of the two."]
    lines += ["", *_errors(document["free_run"])]
    for option in document["options"]:
        verdict = "predicts every run left out better and is in the vehicle" if option["accepted"] else "does not predict every run left out better and is not"
        gain = ", ".join("one left sane limits" if one is None else f"{one:+.1f}" for one in option["gain"])
        lines.append(f"{option['name']}: {verdict} (twice the log likelihood of each: {gain}).")
    if not document["converged"]:
        lines.append("The search had not settled when it ended: give longer logs, or a vehicle's file that is nearer.")
    lines += [f"Left out: {why}" for why in document["left_out"]]
    return "\n".join([*lines, ""])


def _beside_file(rows: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """A line an unknown: a factor of the file's number, or an offset to it."""
    if not rows:
        return ["These logs show none of them: nothing in them moves enough."]
    width = max(map(len, rows))
    lines = [f"{'unknown':{width}}  {'beside file':>11}   90 % interval"]
    for key, row in rows.items():
        value, unit = in_degrees(row["value"], row["unit"])
        said = f"x {number(value)}" if row["kind"] == "factor" else f"{number(value)} {unit}"
        far = f"  {abs(row['moved']):.1f} standard deviations of its prior away" if abs(row["moved"]) > FAR else ""
        lines.append(f"{key:{width}}  {said:>11}   {interval(row['low'], row['high'], row['unit'])}{far}")
    return lines


def _errors(rows: Sequence[Mapping[str, Any]]) -> list[str]:
    """Mean absolute error of free runs by axis: as given, calibrated, and predicted by a calibration without the run."""
    lines = [f"{'free run, mean absolute error':30}  {'as given':>9}  {'calibrated':>10}  {'predicted':>9}"]
    for row in rows:
        given, after = (number(in_degrees(row[k], row["unit"])[0]) for k in ("given", "calibrated"))
        left = "-" if row["left_out"] is None else number(in_degrees(row["left_out"], row["unit"])[0])
        lines.append(f"{row['run'][:18]:18} {row['axis']:5} {in_degrees(0.0, row['unit'])[1]:5}  {given:>9}  {after:>10}  {left:>9}")
    return [*lines, "(predicted: by a calibration that had not seen the run)", ""]


def tuned(document: Mapping[str, Any]) -> str:
    """The parameters of a fit (rovval.fit/1) with their intervals, what the logs cannot determine, and what becomes of the gap."""
    rows, shrunk = document["parameters"], document["shrinkage"]
    lines = [f"{document['run']}: {document['vehicle']}, model {document['model']}, {document['windows']} windows of {document['window_s']:g} s"]
    if rows:
        lines.append(f"The squared gap {changes(shrunk)} on held-out windows with {counted(len(rows), 'parameter')} tuned.")
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
