"""The diagnosis in a few sentences, read off the document."""

from __future__ import annotations

from typing import Any


def sentence(document: dict[str, Any]) -> str:
    """Gap, where, cause or group, shrinkage with its interval, what is left and what to fly next."""
    parts = [_gap(document), _where(document), _cause(document), _harm(document), _left(document), _next(document)]
    return " ".join(p for p in parts if p)


def _gap(document: dict[str, Any]) -> str:
    axes = document["gap"]["axes"]
    if not axes:
        return "Nothing was measured on any axis."
    axis, row = max(axes.items(), key=lambda item: item[1]["share"])
    times = row["rms"] / row["floor_rms"] if row["floor_rms"] > 0 else float("inf")
    size = f"{row['rms']:.3g} {row['unit']} rms in {document['window_s']:g}-s windows"
    floor = f", {times:.1f} times the sensor noise" if times < 1e4 else ""
    return f"Gap: largest in {axis} ({size}{floor}; {100 * row['share']:.0f} % of the weighted gap)."


def _where(document: dict[str, Any]) -> str:
    where = document["gap"]["where"]
    if document["verdict"] == "no_gap" or not where:
        return ""
    return "Where: " + "; ".join(
        f"{100 * s['share']:.0f} % of the {s['axis']} gap at {s['regime']} ({100 * s['time_share']:.0f} % of the time)" for s in where[:2]
    ) + "."


def _cause(document: dict[str, Any]) -> str:
    verdict = document["verdict"]
    if verdict == "no_gap":
        return (
            f"No gap beyond noise and a calibration slop of {100 * document['calibration_slop']:g} %: "
            "no effect of the library explains anything that such slop does not."
        )
    if verdict == "unknown":
        return f"Unknown effect: {document['left']['text']}."
    words = []
    for cause in document["causes"]:
        rivals = [g for g in cause["group"] if g != cause["effect"]]
        values = ", ".join(
            f"{name} = {p['value']:.3g} [{p['low']:.3g}, {p['high']:.3g}] {p['unit']}".rstrip(" 1") for name, p in list(cause["parameters"].items())[:3]
        )
        s = cause["shrinkage"]
        onset = f" from {cause['onset_s']:.0f} s on" if cause["onset_s"] is not None else ""
        other = f" or, indistinguishable in this log, {', '.join(rivals)}" if rivals else ""
        words.append(
            f"{cause['effect']}{onset} ({values}; probability {cause['probability']:.2f}){other}; by itself it shrinks the gap by "
            f"{100 * s['total']:.0f} % [{100 * s['low']:.0f}, {100 * s['high']:.0f}] on held-out windows"
        )
    together = document["shrinkage"]
    total = f" Together: {100 * together['total']:.0f} % [{100 * together['low']:.0f}, {100 * together['high']:.0f}]." if len(words) > 1 else ""
    return f"Cause: {'; and '.join(words)}.{total}"


def _harm(document: dict[str, Any]) -> str:
    if not document["causes"] or not document["harm"]:
        return ""
    return "Worse with it: " + ", ".join(f"{h['axis']} by {100 * h['change']:.0f} %" for h in document["harm"]) + "."


def _left(document: dict[str, Any]) -> str:
    return f"Left: {document['left']['text']}." if document["verdict"] == "partly_explained" and document["left"] else ""


def _next(document: dict[str, Any]) -> str:
    plan = document["next_experiment"]
    return f"To decide between {', '.join(plan['separates'])}: fly {plan['manoeuvre']}." if plan else ""
