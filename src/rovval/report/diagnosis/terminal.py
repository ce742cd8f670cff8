"""A diagnosis as text for a terminal."""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import wrap

from rovval.diagnose.result.diagnosis import Candidate, Cause, Diagnosis
from rovval.report.common.numbers import MISSING, estimate, interval, number, per_cent, probability, quantity
from rovval.report.diagnosis import tables
from rovval.report.diagnosis.sentences import recalibration, words
from rovval.report.diagnosis.sentences.first_screen import FirstScreen, first_screen
from rovval.report.diagnosis.sentences.plain import left_of, titled
from rovval.report.diagnosis.sentences.sentence import also, verdict

WIDTH = 80  # columns
MOST_RANKED = 8


def text(d: Diagnosis) -> str:
    """The sentence first, then where, which, how far, and what this log cannot answer."""
    parts = _lines(f"SYNTHETIC DATA: {d.synthetic}") if d.synthetic else []
    parts += [f"{d.run}: {verdict(d)}", *_screen(first_screen(d))]
    parts += _block("also", also(d))
    parts += _block("gap by axis", _axes(d)) + _block("where", words.where(d))
    parts += ["", *_lines(pushed)] if (pushed := words.disturbances(d)) else []
    for cause in d.causes:
        parts += _block("cause: " + " | ".join(titled(name) for name in words.group(cause)), _cause(cause))
    parts += _block("how probable", [f"{probability(p):>6}  {kind}" for kind, p in tables.models(d)])
    parts += _block(recalibration.TITLE.lower(), _calibration(d))
    parts += _block("sensors", [f"{f.fault or f.check}: {estimate(f.value, f.low, f.high, f.unit)}" for f in d.parity if f.significant])
    parts += _block("harm", tables.harm(d))
    steps = tables.steps(d)
    for title, candidates in steps:
        parts += _block(f"effects tried by simulation: {title}", _weighed(candidates))
    ranking = [] if steps else d.ranking[:MOST_RANKED]
    parts += _block("first look at the library", [f"{number(r.score, 2):>7}  {titled(r.effect)}" for r in ranking])
    parts += _block("not testable in this log", [f"{names}: {why}" for names, why in tables.not_testable(d)])
    return "\n".join([*parts, "", words.SCOPE, *_lines(words.SQUARED)]) + "\n"


def _screen(said: FirstScreen) -> list[str]:
    """The first screen: the answer, and the four others with their questions before them."""
    named = {"where": said.where, "which": said.which, "how far": said.how_far, "next": said.next}
    rows = [_lines(text, f"  {name:<8}  ", " " * 12) for name, text in named.items() if text]
    return [*_lines(said.what), *(line for row in rows for line in row)]


def _block(title: str, lines: list[str]) -> list[str]:
    """A heading, and its lines indented; those too long for the terminal run on."""
    return ["", title, *(part for line in lines for part in _lines(line, "  ", "    "))] if lines else []


def _lines(text: str, first: str = "", rest: str = "") -> list[str]:
    """A line, folded where it is too long for the terminal; a number stays with its per cent."""
    if len(first + text) <= WIDTH:
        return [first + text]
    kept = text.replace(" %", "\N{NO-BREAK SPACE}%")
    lines = wrap(kept, WIDTH, initial_indent=first, subsequent_indent=rest, break_long_words=False, break_on_hyphens=False)
    return [line.replace("\N{NO-BREAK SPACE}", " ") for line in lines]


def _axes(d: Diagnosis) -> list[str]:
    known = d.gap.calibrated
    rows = [("axis", "rms", *(("calibration",) if known else ()), "sensor noise", "share")]
    for axis, row in d.gap.axes.items():
        left = (MISSING if row.calibrated_rms is None else quantity(row.calibrated_rms, row.unit),) if known else ()
        rows.append((axis, quantity(row.rms, row.unit), *left, quantity(row.floor_rms, row.unit), per_cent(row.share)))
    return ["  ".join((r[0].ljust(6), *(c.rjust(13) for c in r[1:]))) for r in rows] if len(rows) > 1 else []


def _cause(cause: Cause) -> list[str]:
    lines = [words.parameter(name, p) for name, p in words.moved(cause.parameters).items()] + words.beside(cause)
    axes = ", ".join(f"{axis} {left_of(v)}" for axis, v in cause.shrinkage.axes.items())
    lines += [words.shrinks(cause), *([f"what is left of the error by axis: {axes}"] if axes else []), f"probability {probability(cause.probability)}"]
    return lines + ([f"begins at {number(cause.onset_s)} s"] if cause.onset_s is not None else [])


def _calibration(d: Diagnosis) -> list[str]:
    found = d.calibration
    if found is None:
        return []
    rows = [
        (name, quantity(p.was, p.unit), quantity(p.value, p.unit), interval(p.low, p.high, p.unit), recalibration.off_by(p))
        for name, p in found.parameters.items()
    ]
    widths = [max(len(row[i]) for row in rows) for i in range(4)]
    said = ["  ".join([r[0].ljust(widths[0]), *(c.rjust(w) for c, w in zip(r[1:4], widths[1:], strict=True)), r[4]]).rstrip() for r in rows]
    axes = ", ".join(f"{axis} {left_of(v)}" for axis, v in found.shrinkage.axes.items())
    return [*said, recalibration.far(found), f"what is left of the error by axis: {axes}", "to calibrate the file:", f"  {found.command}"]


def _weighed(candidates: Sequence[Candidate]) -> list[str]:
    lines = [f"{left_of(c.gain):>9}  {number(c.evidence, 2):>8}  {titled(c.effect)}" for c in candidates]
    return [f"{'rms left':>9}  {'evidence':>8}", *lines]
