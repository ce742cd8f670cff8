"""What is in a log, as a page of text and as a document for programs."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import Any

from rovval.core.counts import counted
from rovval.ingest.inspection.inspect import Inspection
from rovval.ingest.inspection.matches import Match
from rovval.ingest.inspection.stamps_of_table import Stamps
from rovval.ingest.inspection.summary import FieldSummary, Rhythm, TopicSummary
from rovval.report.common.terminal import fitted

SCHEMA = "rovval.inspection/1"
WIDEST = 44  # characters of a column's name that the page shows
MOST_GONE = 6  # channels that a profile misses, of which the page names no more


def page(found: Inspection, fields: bool = True) -> str:
    """Text for a terminal: the file, its clocks, each topic with its fields (unless ``fields`` is False), the profiles, and what to do next."""
    lines = [f"{found.path}: {found.format}" + "".join(f", {k} {v}" for k, v in found.contents.facts.items())]
    lines += [f"  {finding}" for finding in found.findings]
    for topic in found.contents.topics.values():
        lines += ["", *_topic(topic, found.stamps.get(topic.name), fields)]
    return fitted("\n".join([*lines, "", *_profiles(found)]))


def document(found: Inspection) -> dict[str, Any]:
    """The same for programs: every topic, field, clock, reading of the stamps, profile and finding."""
    return {
        "schema": SCHEMA, "file": str(found.path), "format": found.format, "facts": dict(found.contents.facts),
        "topics": [_topic_document(t) for t in found.contents.topics.values()],
        "stamps": [
            {"topic": topic, "kind": s.kind, "columns": list(s.columns),
             "unit": s.unit, "since": s.since, "date_order": s.date_order, "sure": s.sure, "why": s.why}
            | _rhythm(s.rhythm)
            for topic, several in found.stamps.items()
            for s in several
        ],
        "profiles": [
            {"name": m.profile, "fits": m.profile in found.fits, "finds": {n: [list(p) for p in at] for n, at in m.found.items()},
             "lacks": list(found.lacking[m.profile]), "misses": list(m.gone), "misses_optional": list(m.optional_gone)}
            for m in found.matches
        ],
        "findings": [str(f) for f in found.findings],
    }  # fmt: skip


def moment(seconds: float, calendar: bool) -> str:
    """A stamp as people read it: date and time in UTC, or seconds."""
    return f"{datetime.fromtimestamp(seconds, UTC):%Y-%m-%d %H:%M:%S} UTC" if calendar else f"{seconds:.6g} s"


def _topic(topic: TopicSummary, stamps: tuple[Stamps, ...] | None, fields: bool) -> list[str]:
    what = f"{topic.name} ({topic.kind})" if topic.kind else topic.name or "table"
    lines = [f"{what}: {topic.rows} {'rows' if stamps is not None else 'messages'}"]
    for name, rhythm in topic.clocks.items():
        lines.append(f"  {name:<7} {_said(rhythm)}")
    if topic.record_minus_header_s is not None:
        lines.append(f"  record minus header: {topic.record_minus_header_s:.4g} s in the median")
    for s in stamps or ():
        how = f"{s.kind} {', '.join(s.columns)}" + (f" in {s.unit}" if s.kind in ("elapsed", "epoch") else "") + (f", {s.date_order}" if s.date_order else "")
        lines.append(f"  stamps {'are' if s.sure else 'may be'} {how}: {s.why}")
        lines.append(f"    {_said(s.rhythm)}")
    if stamps == ():
        lines.append("  no column rises with the rows: which one is time?")
    if fields:
        width = min(WIDEST, max((len(a) for a in topic.fields), default=0))
        lines += [_field(f, width) for f in topic.fields.values()]
        lines += [f"  {a:<{width}}  left out: {why}" for a, why in topic.left_out.items()]
    return lines


def _said(r: Rhythm) -> str:
    span = r.last_s - r.first_s
    text = f"{moment(r.first_s, r.since_1970)}, {span:.6g} s, {r.rate_hz:.4g} Hz, period {r.period_s:.4g} s"
    if r.largest_gap_s > 1.5 * r.period_s:
        text += f", largest gap {r.largest_gap_s:.4g} s (after {r.gap_after_s:.6g} s)"
    return text + (f", goes back or repeats {r.backwards} times" if r.backwards else "")


def _field(f: FieldSummary, width: int) -> str:
    name = f.address if len(f.address) <= WIDEST else f.address[: WIDEST - 3] + "..."
    unit = f" [{f.unit}]" if f.unit else ""
    if f.low is not None and f.high is not None:
        what = f"{f.low:.6g} always" if f.constant else f"{f.low:.6g} to {f.high:.6g}"
    else:
        what = "text: " + ", ".join(repr(e) for e in f.examples[:3]) if f.present else "empty"
    return f"  {name:<{width}}{unit}  {what}" + (f"; {f.missing} missing" if f.missing and f.present else "")


def _profiles(found: Inspection) -> list[str]:
    if not found.matches:
        return [f"no built-in profile is for {found.format}", _next(found)]
    lines = ["profiles of this format"]
    return [*lines, *(_match(m, found.lacking[m.profile]) for m in found.matches), _next(found)]


def _match(m: Match, lacking: tuple[str, ...]) -> str:
    lacking = tuple(f"no {g.removeprefix('not ')} in it" if g.startswith("not ") else g for g in lacking)
    gone = ", ".join(lacking[:MOST_GONE]) + (f" and {len(lacking) - MOST_GONE} more" if len(lacking) > MOST_GONE else "")
    said = f"{'does not read it' if lacking else 'reads it'}: finds {counted(len(m.found), 'channel')}" + (f" ({', '.join(m.found)})" if m.found else "")
    return f"  {m.profile}: {said}" + (f"; wants {gone}" if gone else "")


def _next(found: Inspection) -> str:
    if len(found.fits) == 1:
        return f"next: rovval compare {found.path}"
    if found.fits:
        return f"next: rovval compare {found.path} --profile {found.fits[0]} (or another of {', '.join(found.fits)})"
    return f"next: rovval profile propose {found.path} > my_log.toml"


def _topic_document(t: TopicSummary) -> dict[str, Any]:
    fields = [
        {"address": f.address, "type": "text" if f.texts and f.low is None else "number", "unit": f.unit, "present": f.present, "missing": f.missing,
         "low": f.low, "high": f.high, "examples": list(f.examples)}
        for f in t.fields.values()
    ]  # fmt: skip
    clocks = {n: _rhythm(r) for n, r in t.clocks.items()}
    return {"topic": t.name, "type": t.kind, "rows": t.rows, "clocks": clocks, "record_minus_header_s": t.record_minus_header_s, "fields": fields,
            "left_out": dict(t.left_out)}  # fmt: skip


def _rhythm(r: Rhythm) -> dict[str, Any]:
    return {
        "first_s": r.first_s, "last_s": r.last_s, "since_1970": r.since_1970, "rate_hz": r.rate_hz, "period_s": r.period_s,
        "largest_gap_s": r.largest_gap_s, "largest_gap_after_s": r.gap_after_s, "backwards": r.backwards,
    }  # fmt: skip
