"""A diagnosis as one HTML file (templates/diagnosis.html): the answer, then where, before and after, which, how far, and what to fly next."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from rovval.diagnose.result.diagnosis import AxisGap, Cause, Diagnosis, Interval
from rovval.report.common.drawing import Drawing
from rovval.report.common.numbers import MISSING, listed, number, per_cent, per_cents, probability
from rovval.report.common.page import render
from rovval.report.common.versions import versions
from rovval.report.diagnosis import figures, recalibration, tables, words
from rovval.report.diagnosis.no_cause import undecided, unexplained
from rovval.report.diagnosis.sentence import facts, headline, next_flight

WHICH = {
    "unknown": "No effect of the library removes enough of the gap on held-out data to be named. The least bad one is not a cause.",
    "no_gap": "Nothing to blame: what is left is within noise and tolerance.",
}
SEEN = "None is named; the answer at the top says what was seen all the same."


class Tile(NamedTuple):
    """One of the answers at the top: its question, itself in a word, and what belongs to it in small print."""

    question: str
    answer: str
    small: str


class Gain(NamedTuple):
    """Of one axis, the share by which its squared error shrinks, with its interval and its rms before and after."""

    axis: str
    share: float
    interval: str
    rms: str


def text(d: Diagnosis, recording: bool = False) -> str:
    """The page; ``recording`` says that run.rrd lies beside it."""
    axes, drawn, places = figures.traces(d)
    main = figures.main_regimes(d, d.heatmap) if d.heatmap else None
    return render(
        "diagnosis.html",
        {"x": axes, "plots": drawn},
        title=f"{d.run} · rovval diagnosis",
        eyebrow="Diagnosis",
        name=d.run,
        banner=f"SYNTHETIC DATA: {d.synthetic}" if d.synthetic else "",
        said=headline(d),
        facts=facts(d),
        d=d,
        tiles=[] if d.verdict == "no_gap" else [_where(d), _which(d), _how_far(d), _next(d)],
        heat=figures.heat_map(d.heatmap) if d.heatmap else None,
        main_heat=figures.heat_map(main) if main else None,
        where=words.where(d),
        changes=words.changes(d),
        disturbances=words.disturbances(d),
        keys={"measured": "measured", "nominal": "nominal simulator"} | ({"corrected": "with the effects found"} if d.causes else {}),
        traces=places,
        causes=[_cause(c, d.gap.axes) for c in d.causes],
        which=SEEN if undecided(d) else WHICH.get(d.verdict, ""),
        calibration=_calibration(d),
        steps=_steps(d),
        weighed=tables.WEIGHED,
        screen=tables.screen(d),
        ranking=figures.ranking(d),
        coherence=figures.matrix(d.coherence) if d.coherence else None,
        whiskers=[figures.whisker(f.value, f.low, f.high, unit=f.unit) for f in d.parity],
        models=tables.models(d),
        harm=tables.harm(d),
        left=unexplained(d),
        next_flight=next_flight(d),
        flight=figures.schedule(d.manoeuvre.schedule) if d.manoeuvre else None,
        not_testable=tables.not_testable(d),
        recording=recording,
        footer=" · ".join([words.SCOPE, words.SQUARED, *(f"{k} {v}" for k, v in versions().items())]),
    )


def _where(d: Diagnosis) -> Tile:
    worst = max(d.gap.axes, key=lambda axis: d.gap.axes[axis].share, default="")
    at = next((f", most at {one.regime}" for one in d.gap.where if one.axis == worst), "")
    return Tile("Where", worst, f"{per_cent(d.gap.axes[worst].share)} of the gap{at}" if worst else "")


def _which(d: Diagnosis) -> Tile:
    off = f"{len(d.calibration.beyond)} coefficients of the file" if d.calibration else ""
    if not d.causes:
        return Tile("Which", "unknown", f"no library effect explains it{f'; {off} are off at once' if off else ''}")
    first = words.group(d.causes[0])
    more = [f"or {listed(first[1:], 'or')}"] if first[1:] else []
    more += [f"and {', '.join(c.effect for c in d.causes[1:])}"] if d.causes[1:] else []
    more += [f"beside {off}"] if off else []
    return Tile("Which", first[0], "; ".join(more))


def _how_far(d: Diagnosis) -> Tile:
    s = d.shrinkage
    if not d.causes:
        return Tile("How far", "", "")
    small = f"squared gap, {per_cents(s.low, s.high)}{', held out' if s.held_out else ''}"
    small += f"; {per_cent(d.calibration.shrinkage.total)} smaller with the coefficients tuned" if d.calibration else ""
    return Tile("How far", "unchanged" if words.unmoved(s) else f"{per_cent(s.total)} smaller", small)


def _next(d: Diagnosis) -> Tile:
    plan = d.next_experiment
    return Tile("Next", d.manoeuvre.name if d.manoeuvre else plan.manoeuvre if plan else "", "")


def _cause(cause: Cause, gap: Mapping[str, AxisGap]) -> dict[str, Any]:
    """A cause with its parameters and what it does axis by axis."""
    said = [f"probability {probability(cause.probability)}"]
    said += [f"begins at {number(cause.onset_s)} s"] if cause.onset_s is not None else []
    parameters = [(name, p, figures.whisker(p.value, p.low, p.high, p.null or 0.0, p.unit)) for name, p in words.moved(cause.parameters).items()]
    gains = _gains(cause.shrinkage.axes, cause.shrinkage.axes_interval, gap)
    return {"members": words.group(cause), "said": ", ".join([*said, words.shrinks(cause)]), "parameters": parameters, "gains": gains}


def _gains(axes: Mapping[str, float], spans: Mapping[str, Interval], gap: Mapping[str, AxisGap]) -> list[Gain]:
    """Axis by axis, what becomes of the squared error."""
    intervals = {axis: per_cents(spans[axis].low, spans[axis].high) if axis in spans else MISSING for axis in axes}
    return [Gain(axis, share, intervals[axis], words.rms_change(gap.get(axis), share)) for axis, share in axes.items()]


def _calibration(d: Diagnosis) -> dict[str, Any] | None:
    """A file that is off in many coefficients: what was tuned, how far it is off, what shrinks, and the command that writes it."""
    found = d.calibration
    if found is None:
        return None
    rows: list[tuple[str, Any, Drawing, str]] = [
        (name, row, figures.whisker(row.value, row.low, row.high, row.was, row.unit), recalibration.off_by(row)) for name, row in found.parameters.items()
    ]
    gains = _gains(found.shrinkage.axes, found.shrinkage.axes_interval, d.gap.axes)
    return {
        "title": recalibration.TITLE, "lead": recalibration.LEAD, "far": recalibration.far(found), "rows": rows, "gains": gains,
        "write": recalibration.WRITE, "command": found.command,
    }  # fmt: skip


def _steps(d: Diagnosis) -> list[tuple[str, list[tuple[Any, bool, str]]]]:
    """Every step of the search: each candidate, whether it was named, and the cause that this log cannot tell it from ("" for none)."""
    named = {c.effect for c in d.causes}
    alike = {member: c.effect for c in d.causes for member in words.group(c)[1:]}
    return [(title, [(c, c.effect in named, alike.get(c.effect, "")) for c in candidates]) for title, candidates in tables.steps(d)]
