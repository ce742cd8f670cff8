"""A diagnosis in sentences, for every format: the gap, where, which, how far, what is left, what to fly next."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from rovval.core.units import in_degrees
from rovval.report.common.numbers import listed, number, per_cent, quantity
from rovval.report.diagnosis.sentence import alone, beside_slop, nothing, undecided

Document = Mapping[str, Any]
VERDICTS = {
    "no_gap": "no gap beyond noise and slop",
    "explained": "explained",
    "partly_explained": "partly explained",
    "unknown": "unknown effect",
}
SCOPE = "Every number is about this simulator, this log and this library of effects."
SQUARED = "Shares of the gap, and by how much it shrinks, are of squared errors: 75 % less is half the rms."


def names(items: Sequence[str], link: str = "or") -> str:
    """a, b or c."""
    words = list(items)
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} {link} {words[-1]}" if words else ""


def group(cause: Mapping[str, Any]) -> list[str]:
    """The cause and what this log cannot tell from it, the cause first."""
    return list(dict.fromkeys([str(cause["effect"]), *cause.get("group", ())]))


def interval(entry: Mapping[str, Any] | None) -> str:
    """66 % (58 % to 72 %)."""
    if not entry or entry.get("total") is None:
        return "-"
    low, high = entry.get("low"), entry.get("high")
    return per_cent(entry["total"]) + (f" ({per_cent(low)} to {per_cent(high)})" if low is not None and high is not None else "")


def shrinks(cause: Document) -> str:
    """By how much the squared gap shrinks with a cause, or that its motion stays as it is."""
    entry = cause.get("shrinkage") or {}
    held = " on held-out windows" if entry.get("held_out") else ""
    return alone(cause) or (f"the squared gap shrinks by {interval(entry)}{held}" if entry.get("total") is not None else "")


def rms_change(axis: Mapping[str, Any] | None, share: float) -> str:
    """An axis's rms before and with a cause that takes ``share`` of its squared error: 0.074 to 0.040 m/s."""
    if not axis or axis.get("rms") is None:
        return "-"
    before, unit = in_degrees(axis["rms"], axis.get("unit", "1"))
    return f"{number(before, 2)} to {number(before * max(1.0 - share, 0.0) ** 0.5, 2)} {unit}"


def span(entry: Mapping[str, Any] | None) -> str:
    """58 to 72 %."""
    return f"{per_cent(entry['low']).removesuffix(' %')} to {per_cent(entry['high'])}" if entry else ""


def parameter(name: str, entry: Mapping[str, Any]) -> str:
    """loss = 0.31 (0.26 to 0.36)."""
    factor, unit = in_degrees(1.0, entry.get("unit", "1"))
    values = [entry.get(k) for k in ("value", "low", "high")]
    value, low, high = (None if v is None else v * factor for v in values)
    span = f" ({number(low)} to {number(high)})" if low is not None and high is not None else ""
    return f"{name} = {number(value)}{span}{'' if unit == '1' else f' {unit}'}"


def sentences(document: Document) -> list[str]:
    """The answer, in the order in which it is asked for; the engine's own sentence comes first where it wrote one."""
    own = document.get("sentence")
    if own and document.get("answer"):
        return [own]
    said = [own] if own else [s for s in (_gap(document), _which(document), _far(document)) if s]
    if not own and len(said) > 1:
        said = [" ".join(said)]
    said += [f"What is left: {text.rstrip('.')}." for text in [left(document)] if text]
    said += [f"Fly next: {text}" for text in [next_flight(document)] if text]
    return said or [f"Verdict: {VERDICTS.get(document.get('verdict', ''), 'none')}."]


def headline(document: Document) -> list[str]:
    """The same with the answer itself in front, where the engine says which of its sentences that is."""
    said, answer = sentences(document), str(document.get("answer") or "")
    rest = " ".join(said).replace(answer, "").replace("  ", " ").strip() if answer else ""
    return [answer, rest] if answer and rest else said


def verdict(document: Document) -> str:
    """The verdict in a few words."""
    if undecided(document):
        return "no cause named"
    said = str(document.get("verdict", ""))
    return VERDICTS.get(said, said)


def left(document: Document) -> str:
    """What the effects found do not explain."""
    rest = document.get("left") or {}
    if rest.get("text"):
        return str(rest["text"])
    axes, depends = rest.get("axes") or (), rest.get("depends_on") or ()
    where = f"in {listed(axes)}" if axes else ""
    return " ".join(w for w in (where, f"depending on {listed(depends)}" if depends else "") if w)


def next_flight(document: Document) -> str:
    """The manoeuvre that would decide between the members of a group."""
    nxt, flight = document.get("next_experiment") or {}, document.get("manoeuvre") or {}
    what = nxt.get("manoeuvre") or flight.get("name") or ""
    apart = nxt.get("separates") or ()
    if not what:
        return ""
    tells = f", which tells {names(apart, 'and')} apart" if apart else ""
    return f"{what.rstrip('.')}{tells}."


def where(document: Document, most: int = 5) -> list[str]:
    """The slices that matter most, in words."""
    slices = (document.get("gap") or {}).get("where") or ()
    return [_slice(s) for s in slices[:most]]


def run(document: Document) -> str:
    """The run or the runs that it is about."""
    about = document.get("run", "")
    return str(about) if isinstance(about, str) else ", ".join(map(str, about))


def facts(document: Document) -> dict[str, Any]:
    """The line under the title."""
    slop, window = document.get("calibration_slop"), document.get("window_s")
    return {
        "verdict": verdict(document),
        "vehicle": document.get("vehicle", ""),
        "model": document.get("model", ""),
        "windows": "" if window is None else f"{window:g} s",
        "calibration slop": "" if slop is None else per_cent(slop),
    }


def _slice(s: Mapping[str, Any], with_lift: bool = True) -> str:
    time = s.get("time_share")
    when = "" if time is None else f", {per_cent(time)} of the time"
    lift = s.get("lift")
    factor = "" if lift is None or not with_lift else f" (lift {number(lift, 2)})"
    axis = f"{s['axis']} gap" if s.get("axis") else "gap"
    return f"{per_cent(s.get('share'))} of the {axis} is at {s.get('regime', '')}{when}{factor}"


def _gap(document: Document) -> str:
    axes = (document.get("gap") or {}).get("axes") or {}
    if document.get("verdict") == "no_gap":
        return nothing(document)
    if not axes:
        return ""
    worst = max(axes, key=lambda a: axes[a].get("share") or 0.0)
    row = axes[worst]
    share = f", {per_cent(row['share'])} of the whole gap" if row.get("share") is not None else ""
    slices = (document.get("gap") or {}).get("where") or ()
    at = f"; {_slice(slices[0], with_lift=False)}" if slices else ""
    return f"The gap is largest in {worst} ({quantity(row['rms'], row.get('unit', '1'))} rms{share}){at}."


def _which(document: Document) -> str:
    causes = document.get("causes") or ()
    if document.get("verdict") == "unknown":
        return "No effect of the library explains it: the cause is unknown."
    if not causes:
        return ""
    parts = []
    for cause in causes:
        members = group(cause)
        others = f" (this log cannot tell it from {names(members[1:])})" if members[1:] else ""
        onset = f" from {number(cause['onset_s'])} s on" if cause.get("onset_s") is not None else ""
        parts.append(f"{members[0]}{onset}{others}")
    return f"Cause: {listed(parts)}."


def _far(document: Document) -> str:
    s = document.get("shrinkage") or {}
    if s.get("total") is None or not document.get("causes"):
        return ""
    explainable = f", {per_cent(s['of_explainable'])} of what is above the noise" if s.get("of_explainable") is not None else ""
    held = " on stretches held out" if s.get("held_out") else ""
    return f"With it the squared gap shrinks by {interval(s)}{held}{explainable}. {beside_slop(document)}".rstrip()
