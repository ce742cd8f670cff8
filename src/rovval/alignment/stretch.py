"""A stretch of a run: the samples between two times, as a run of its own."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from rovval.core.data import Marker, Reason, Run
from rovval.core.errors import BadInput, Finding, UsageProblem

LEAST_SAMPLES = 2  # of which a run consists
MOST_NAMES = 300  # characters of markers' names that a refusal lists


Moment = float | str | None


def stretch_of(run: Run, start: Moment = None, end: Moment = None) -> Run:
    """The samples of ``run`` from ``start`` to ``end`` (both ends within): s since its first grid point, or the name of a marker of the log; None
    is its own start or end. Of markers of one name the first holds, for the end the first one after the start.

    Its id says the stretch, its time counts from its start, and a finding says so. What the whole log was found to have stays among its findings.

    Raises:
        UsageProblem: a time is no number, or the end is not after the start.
        BadInput: the log has no such marker, or the stretch begins or ends beyond the log, or no channel holds a value in it.
    """
    start_s = _seconds(run, start, -np.inf)
    end_s = _seconds(run, end, -np.inf if start_s is None else start_s)
    return run if start_s is None and end_s is None else _cut(run, start_s, end_s)


def _seconds(run: Run, said: Moment, after_s: float) -> float | None:
    """What is said in s since the run's start: a number, or the first marker of that name after ``after_s``. Raises `BadInput`."""
    if said is None or isinstance(said, float | int):
        return said
    try:
        return float(said)
    except ValueError:
        pass
    named = [m for m in run.markers if m.name.casefold() == said.casefold()]
    if later := [m.t_s for m in named if m.t_s > after_s]:
        return later[0]
    if named:
        raise BadInput(f"run {run.id}: the marker {said!r} is not there after {after_s:g} s", f"it is at {', '.join(f'{m.t_s:g} s' for m in named[:5])}")
    known = ", ".join(dict.fromkeys(f"{m.name!r}" for m in run.markers))
    hint = f"its markers: {known[:MOST_NAMES]}" if known else "give seconds; a log has markers where its profile says where they stand: [markers]"
    raise BadInput(f"run {run.id}: no marker {said!r}", hint)


def _cut(run: Run, start_s: float | None, end_s: float | None) -> Run:
    start, end = 0.0 if start_s is None else start_s, run.duration_s if end_s is None else end_s
    asked = f"from {start:g} to {end:g} s"
    beyond = start < 0.0 or end > run.duration_s + 0.5 * run.dt or (end_s is None and start >= run.duration_s)
    if not (np.isfinite(start) and np.isfinite(end)) or (start >= end and not beyond):
        raise UsageProblem(f"stretch {asked}: the end must come after the start", "give both in seconds since the run's start")
    if beyond:
        where = asked if end_s is not None else f"from {start:g} s"
        raise BadInput(f"run {run.id}: stretch {where} is beyond the log, which lasts from 0 to {run.duration_s:g} s", "choose times within it")
    first, last = int(np.ceil(start / run.dt - 1e-6)), int(np.floor(end / run.dt + 1e-6))
    if last - first + 1 < LEAST_SAMPLES:
        raise BadInput(f"run {run.id}: stretch {asked} holds less than {LEAST_SAMPLES} samples of {run.dt:g} s", "choose a longer one")
    of = slice(first, last + 1)
    reasons = {name: codes[of] for name, codes in run.reasons.items()}
    if not any((codes == Reason.OK).any() for codes in reasons.values()):
        raise BadInput(f"run {run.id}: no channel holds a value in the stretch {asked}", "choose another")
    late = first * run.dt
    said = f"{asked} of {run.duration_s:g} s; t = 0 is {late:g} s of the log, the times in other findings are the log's"
    grid_start = float(run.properties.get("grid_start_s", "0.0"))
    covered = {name: replace(one, coverage=float((reasons[name] == Reason.OK).mean())) for name, one in run.resampled.items()}
    return replace(
        run, id=f"{run.id}-from{start:g}to{end:g}s", values={name: x[of] for name, x in run.values.items()}, reasons=reasons, resampled=covered,
        t0_ns=None if run.t0_ns is None else run.t0_ns + round(late * 1e9), findings=(Finding("stretch", "log", said), *run.findings),
        properties={**run.properties, "grid_start_s": repr(grid_start + late)},
        markers=tuple(Marker(m.t_s - late, m.name) for m in run.markers if start <= m.t_s <= end),
    )  # fmt: skip
