"""A stretch of a run: the samples between two times, as a run of its own."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from rovval.core.data import Reason, Run
from rovval.core.errors import BadInput, Finding, UsageProblem

LEAST_SAMPLES = 2  # of which a run consists


def stretch_of(run: Run, start_s: float | None = None, end_s: float | None = None) -> Run:
    """The samples of ``run`` from ``start_s`` to ``end_s`` (s since its first grid point, both ends within); None is its own start or end.

    Its id says the stretch, its time counts from ``start_s``, and a finding says so. What the whole log was found to have stays among its findings.

    Raises:
        UsageProblem: a time is no number, or the end is not after the start.
        BadInput: the stretch begins or ends beyond the log, or no channel holds a value in it.
    """
    if start_s is None and end_s is None:
        return run
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
    )  # fmt: skip
