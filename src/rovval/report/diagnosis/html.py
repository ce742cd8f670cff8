"""A diagnosis as one HTML file (templates/diagnosis.html): the answer, then where, before and after, which, how far, and what to fly next."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from rovval.core.data import Comparison, SimResult
from rovval.diagnose.result.diagnosis import AxisGap, Cause, Diagnosis, Interval, SensorFault
from rovval.report.common.numbers import MISSING, number, per_cents, probability
from rovval.report.common.page import render
from rovval.report.common.versions import foot
from rovval.report.diagnosis import figures, tables, whole_run
from rovval.report.diagnosis.sentences import recalibration, words
from rovval.report.diagnosis.sentences.first_screen import first_screen
from rovval.report.diagnosis.sentences.no_cause import unexplained
from rovval.report.diagnosis.sentences.plain import remaining, title
from rovval.report.diagnosis.sentences.sentence import also, answer, facts
from rovval.report.drawings.drawing import Drawing


class Gain(NamedTuple):
    """Of one axis, the share by which its squared error shrinks, with its interval, and its rms before and after."""

    axis: str
    share: float
    interval: str
    rms: str


def text(
    d: Diagnosis, comparison: Comparison | None = None, corrected: SimResult | None = None, recording: bool = False, links: Mapping[str, str] | None = None
) -> str:  # fmt: skip
    """The page; with a ``comparison`` of the run it shows all of it, beside its simulation ``corrected`` by the causes. ``recording`` says that run.rrd
    lies beside it, ``links`` lead to pages that belong to it."""
    axes, drawn, places = figures.traces(d)
    whole_axes, whole_drawn, whole_places = whole_run.drawn(d, comparison, corrected) if comparison else ({}, [], [])
    main = figures.main_regimes(d, d.heatmap) if d.heatmap else None
    return render(
        "diagnosis.html",
        {"x": axes | whole_axes, "plots": [*drawn, *whole_drawn]},
        links,
        title=f"{d.run} · rovval diagnosis",
        eyebrow="Diagnosis",
        name=d.run,
        banner=f"SYNTHETIC DATA: {d.synthetic}" if d.synthetic else "",
        said=[answer(d)],
        screen=first_screen(d),
        also=also(d),
        facts=facts(d),
        d=d,
        heat=figures.heat_map(d.heatmap) if d.heatmap else None,
        main_heat=figures.heat_map(main) if main else None,
        where=words.where(d),
        changes=words.changes(d),
        disturbances=words.disturbances(d),
        keys={"measured": "measured", "nominal": "nominal simulator"} | ({"corrected": "with the effects found"} if d.causes else {}),
        traces=places,
        whole=whole_places,
        whole_of=comparison.run.id if comparison else "",
        causes=[_cause(c, d.gap.axes) for c in d.causes],
        calibration=_calibration(d),
        steps=_steps(d),
        weighed=tables.WEIGHED,
        first_look=tables.screen(d),
        ranking=figures.ranking(d),
        coherence=figures.matrix(d.coherence) if d.coherence else None,
        parity=_parity(d),
        models=tables.models(d),
        harm=tables.harm(d),
        left=unexplained(d),
        flight=figures.schedule(d.manoeuvre.schedule) if d.manoeuvre else None,
        not_testable=tables.not_testable(d),
        title_of=title,
        remaining=remaining,
        recording=recording,
        footer=foot(words.SCOPE, words.SQUARED),
    )


def _cause(cause: Cause, gap: Mapping[str, AxisGap]) -> dict[str, Any]:
    """A cause with its parameters and what it does axis by axis."""
    said = [f"probability {probability(cause.probability)}"]
    said += [f"begins at {number(cause.onset_s)} s"] if cause.onset_s is not None else []
    parameters = [(n, p, figures.whisker(p.value, p.low, p.high, p.null or 0.0, p.unit)) for n, p in words.moved(cause.parameters).items()]
    gains = _gains(cause.shrinkage.axes, cause.shrinkage.axes_interval, gap)
    members = [(name, title(name)) for name in words.group(cause)]
    return {
        "members": members, "said": ", ".join([*said, words.shrinks(cause)]), "parameters": parameters, "beside": words.beside(cause), "gains": gains,
    }  # fmt: skip


def _gains(axes: Mapping[str, float], spans: Mapping[str, Interval], gap: Mapping[str, AxisGap]) -> list[Gain]:
    """Axis by axis, what becomes of the squared error."""
    intervals = {axis: per_cents(spans[axis].low, spans[axis].high) if axis in spans else MISSING for axis in axes}
    return [Gain(axis, share, intervals[axis], words.rms_change(gap.get(axis), share)) for axis, share in axes.items()]


def _parity(d: Diagnosis) -> list[tuple[str, list[tuple[SensorFault, Drawing]]]]:
    """What kinematics say of the sensors: each check with its note, and under it the faults that it looked for."""
    groups: dict[str, list[tuple[SensorFault, Drawing]]] = {}
    for f in d.parity:
        groups.setdefault(": ".join(filter(None, (f.check, f.note))), []).append((f, figures.whisker(f.value, f.low, f.high, unit=f.unit)))
    return list(groups.items())


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
