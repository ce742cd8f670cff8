"""RawLog -> Run: every channel on one grid (10 Hz), each by the method that suits it, with a reason where a value is missing.

A log that is on such a grid already (within 20 ms at 10 Hz) comes through bit for bit. Else: a channel with ``mean`` that is
faster than the grid is averaged over the bin around each grid point, a slower one is interpolated linearly between neighbours;
``circular`` does the same on the unit circle, and an attitude that tumbles is one rotation; ``linear`` interpolates; ``hold`` keeps the previous
value, since a command acts until the next one, and ``hold_mean`` is its mean until the next grid point: the plant holds its inputs from one to the next, and
a command that comes between two would act half a step late. Nothing is bridged beyond a channel's longest gap (`rovval.alignment.series.longest_bridge`) and
nothing extrapolated.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import cast, get_args

import numpy as np

from rovval.alignment.attitude import resampled_attitude, tumbling_attitude
from rovval.alignment.clock_offset import estimated_offset
from rovval.alignment.resampling import ON_GRID, resample
from rovval.alignment.series import bad_samples, longest_bridge
from rovval.core.channels import DRIVING, Resampling, Rule, channel
from rovval.core.data import RATE_HZ, Array, ClockReport, Codes, RawLog, Reason, Resampled, Run, Series
from rovval.core.errors import BadInput, UsageProblem, all_at_once
from rovval.core.file_names import shortened

SHARED_PHASE = 0.6  # mean resultant length: uniform jitter of a quarter step has 0.64
LONGEST_S = 30 * 86400.0  # a log longer than a month is a broken clock


def align(raw: RawLog, rate_hz: float = RATE_HZ, methods: Mapping[str, str] | None = None) -> Run:
    """The log on a grid of ``rate_hz``; ``methods`` says for channels (``u``) or families (``n``) another method than the profile.

    Raises `UsageProblem` for an unknown channel or method, `BadInput` for a log that does not span two grid points.
    """
    chosen = _methods(raw, rate_hz, methods or {})
    dt = 1.0 / rate_hz
    start, n = _grid(raw, dt)
    values, reasons, resampled, bad = {}, {}, {}, dict[str, Codes]()
    findings = list(raw.findings)
    for name, series in raw.channels.items():
        bad[name], found = bad_samples(name, series, chosen[name][2])
        findings += [f for f in found if not any(f.code == k.code and name in k.where.split(", ") for k in raw.findings)]

    def how(name: str) -> tuple[float, Resampling, float | None]:
        return chosen[name][1], chosen[name][0], raw.rules.get(name, Rule()).longest_gap_s

    attitude = resampled_attitude(raw, bad, start, n, dt, *how("phi")) if tumbling_attitude(raw, bad) else {}
    for name, series in raw.channels.items():
        got = attitude.get(name) or resample(series, bad[name], start, n, dt, *how(name))
        values[name], reasons[name], used = got
        resampled[name] = _report(series, used, chosen[name][1], reasons[name])
    if not any((r == Reason.OK).any() for r in reasons.values()):
        raise BadInput(f"{raw.source}: no channel holds a value on the grid", "see its findings with `rovval ingest`")
    t0_ns = None if raw.t0_ns is None else raw.t0_ns + round(start * 1e9)
    return Run(
        id=_run_id(raw, rate_hz, methods or {}), source=raw.source, sha256=raw.sha256, profile=raw.profile, vehicle=raw.vehicle,
        t0_ns=t0_ns, dt=dt, values=values, reasons=reasons, resampled=resampled, clock=_clock(raw, values, start, dt, resampled),
        findings=tuple(findings), properties={**raw.properties, "grid_start_s": repr(start)},
        markers=tuple(replace(m, t_s=m.t_s - start) for m in raw.markers),
    )  # fmt: skip


def _methods(raw: RawLog, rate_hz: float, methods: Mapping[str, str]) -> dict[str, tuple[Resampling, float, float | None]]:
    """Per channel method, longest gap (s) and stuck limit (s): the caller's before the profile's before the table's."""
    problems = [] if 0.1 <= rate_hz <= 1000.0 else [f"rate {rate_hz} Hz is not between 0.1 and 1000"]
    for name, method in methods.items():
        channel(name)
        if method not in get_args(Resampling):
            problems.append(f"channel {name!r}: unknown method {method!r}; use one of: {', '.join(get_args(Resampling))}")
    if problems:
        raise UsageProblem(all_at_once(problems, "alignment"))
    out: dict[str, tuple[Resampling, float, float | None]] = {}
    for name in raw.channels:
        row, rule = channel(name), raw.rules.get(name, Rule())
        said = methods.get(name, methods.get(row.name, rule.resampling or row.resampling))
        out[name] = (cast(Resampling, said), longest_bridge(raw, name)[0], rule.stuck_s)
    return out


def _grid(raw: RawLog, dt: float) -> tuple[float, int]:
    """Start (s on the log's clock) and length of the grid, from the first to the last sample of what drives and moves.

    The grid's phase is the one that most samples share, so that jitter of the first one does not shift the log.
    """
    span = [s for name, s in raw.channels.items() if name.partition(":")[0] in DRIVING] or list(raw.channels.values())
    first, last = min(float(s.t[0]) for s in span), max(float(s.t[-1]) for s in span)
    if last - first > LONGEST_S:
        raise BadInput(f"{raw.source}: spans {(last - first) / 86400:.0f} days; its clock is broken", "look at its first and last stamps")
    stamps = max(span, key=lambda s: len(s.t)).t
    turn = np.mean(np.exp(2j * np.pi * ((stamps - first) / dt)))
    phase = float(np.angle(turn)) / (2 * np.pi) * dt if abs(turn) > SHARED_PHASE else 0.0
    start = first + (phase if abs(phase) > 1e-6 * dt else 0.0)
    n = int(np.floor((last - start) / dt + 0.2 + 1e-9)) + 1
    if n < 2:
        raise BadInput(f"{raw.source}: spans {last - first:.3f} s, less than two points at {1 / dt:g} Hz", "is this the whole log?")
    return start, n


def _report(series: Series, method: str, longest_gap_s: float, reasons: Codes) -> Resampled:
    steps = np.diff(series.t)
    period, largest = (float(np.median(steps)), float(steps.max())) if len(steps) else (0.0, 0.0)
    return Resampled(method, len(series.t), period, largest, longest_gap_s, float((reasons == Reason.OK).mean()))


def _clock(raw: RawLog, values: Mapping[str, Array], start: float, dt: float, resampled: Mapping[str, Resampled]) -> ClockReport:
    span = {name: s for name, s in raw.channels.items() if name.partition(":")[0] in DRIVING} or dict(raw.channels)
    matched = 0
    for series in span.values():
        at = (series.t - start) / dt
        matched += int((np.abs(at - np.rint(at)) <= ON_GRID + 1e-5).sum())
    largest = max(resampled[name].largest_gap_s for name in span)
    offset, correlation, note = estimated_offset(values, dt)
    stamp = "+".join(sorted({s.stamp for s in span.values()}))
    return ClockReport(stamp, sum(len(s.t) for s in span.values()), matched, largest, offset, correlation, note)


def _run_id(raw: RawLog, rate_hz: float, methods: Mapping[str, str]) -> str:
    """Name of the file and ten digits of what made the run: content, profile, and the alignment where it is not the default."""
    asked = {} if rate_hz == RATE_HZ and not methods else {"rate_hz": rate_hz, "methods": dict(sorted(methods.items()))}
    made_of = json.dumps([raw.sha256, raw.profile, raw.properties.get("profile_sha256", ""), asked])
    stem = "".join(c if c.isalnum() or c in "-_." else "_" for c in Path(raw.source).stem) or "log"
    return f"{shortened(stem)}-{hashlib.sha256(made_of.encode()).hexdigest()[:10]}"
