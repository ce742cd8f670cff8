"""A profile held against a log, as a page of text and as a document: what matched, the first rows in SI, what is left over."""

from __future__ import annotations

from typing import Any

from rovval.core.channels import channel
from rovval.core.counts import counted
from rovval.core.data import Run, Series
from rovval.core.units import in_degrees
from rovval.ingest.inspection.check import Check
from rovval.ingest.profile import ATTITUDE
from rovval.report.inspection import moment

SCHEMA = "rovval.profile_check/1"
FIRST = 4  # values of a channel that are shown
MOST_LEFT = 20  # fields left over that the page names


def page(check: Check, run: Run) -> str:
    """Text for a terminal."""
    raw = check.raw
    seconds = max(float(s.t[-1]) for s in raw.channels.values()) - min(float(s.t[0]) for s in raw.channels.values())
    begin = "" if raw.t0_ns is None else f" from {moment(raw.t0_ns * 1e-9, True)}"
    lines = [f"{check.profile.name} reads {raw.source}: {counted(len(raw.channels), 'channel')}, {seconds:.6g} s{begin}"]
    lines += [f"  zone of the stamps: {zone}"] if (zone := raw.properties.get("timezone")) else []
    lines += ["", "channel, from where, unit; the first values in SI (angles in degrees), range"]
    lines += [_channel(check, name, series) for name, series in raw.channels.items()]
    gone = [f"{n} (optional)" for n in check.match.optional_gone] + list(check.match.gone)
    lines += ["", "not found: " + ", ".join(gone)] if gone else []
    lines += ["", "markers: " + ", ".join(f"{m.name!r} at {m.t_s:g} s" for m in raw.markers[:MOST_LEFT])] if raw.markers else []
    left = [" ".join(place).strip() for place in check.left_over]
    more = f" and {len(left) - MOST_LEFT} more" if len(left) > MOST_LEFT else ""
    lines += ["", f"left over, mapped to nothing: {', '.join(left[:MOST_LEFT])}{more}"] if left else ["", "left over: nothing"]
    findings = [f"  {f}" for f in run.findings]
    return "\n".join([*lines, "", *(["findings, of reading it and of bringing it to 10 Hz", *findings] if findings else ["no findings"])])


def document(check: Check, run: Run) -> dict[str, Any]:
    """The same for programs; values in SI."""
    return {
        "schema": SCHEMA, "profile": check.profile.name, "file": check.raw.source, "t0_ns": check.raw.t0_ns,
        "channels": {
            name: {"unit": channel(name).unit, "samples": len(s.t), "from": [list(p) for p in check.match.found.get(_key(check, name), ())],
                   "first_t_s": s.t[:FIRST].tolist(), "first": s.values[:FIRST].tolist(), "low": float(s.values.min()), "high": float(s.values.max())}
            for name, s in check.raw.channels.items()
        },
        "not_found": list(check.match.gone), "not_found_optional": list(check.match.optional_gone),
        "left_over": [list(p) for p in check.left_over], "findings": [str(f) for f in run.findings],
        "markers": [{"t_s": m.t_s, "name": m.name} for m in check.raw.markers],
    }  # fmt: skip


def _channel(check: Check, name: str, series: Series) -> str:
    scale, unit = in_degrees(1.0, channel(name).unit)
    values = ", ".join(f"{v * scale:.4g}" for v in series.values[:FIRST])
    places = check.match.found.get(_key(check, name), ())
    place = ", ".join(" ".join(p).strip() for p in places[:1]) + (", ..." if len(places) > 1 else "")
    return f"  {name:<10} {place} [{_logged(check, name)}] -> {values}, ... {unit}; {series.values.min() * scale:.4g} to {series.values.max() * scale:.4g}"


def _key(check: Check, name: str) -> str:
    """The channel of the match that a channel of the log came from: a quaternion gives three."""
    return ATTITUDE if name in ("phi", "theta", "psi") and ATTITUDE in check.match.found else name


def _logged(check: Check, name: str) -> str:
    """The unit that the profile says of a channel."""
    source = check.profile.source_of(_key(check, name))
    return source.unit if source else "?"
