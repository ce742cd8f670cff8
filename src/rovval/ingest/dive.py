"""Several files of one dive -> one `RawLog`: thrusters in one, velocities in another, each with its own profile and its own clock.

Stamps that say their moment stand on UTC; times of day on one day; clocks that count from a start of their own are brought onto the first
log's by what the dive file states. Nothing is shifted to fit: what is left between the clocks is estimated and reported as for any run.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

import numpy as np

from rovval.core.data import RawLog, Series
from rovval.core.errors import BadInput, UsageProblem, all_at_once
from rovval.ingest.files import sha256
from rovval.ingest.files.dive_file import Dive, DiveLog, load_dive, parts_of
from rovval.ingest.profile import FOLDER

Reading = Callable[[Path, str | None, str | None], RawLog]  # `rovval.ingest.read`
PROFILE = "dive"  # the profile that the run of a dive names


@dataclass(frozen=True, slots=True)
class Placed:
    """A log with the start of its t = 0 on the dive's clock (s), which is UTC, a day's, or one of its own."""

    name: str
    asked: DiveLog
    log: RawLog
    clock: str
    start_s: float

    @property
    def first_s(self) -> float:
        """Its first sample on the dive's clock."""
        return self.start_s + min(float(s.t[0]) for s in self.log.channels.values())

    @property
    def last_s(self) -> float:
        """Its last sample on the dive's clock."""
        return self.start_s + max(float(s.t[-1]) for s in self.log.channels.values())


def read_dive(path: Path, read: Reading, profile: str | None = None, timezone: str | None = None) -> RawLog:
    """The dive of a dive file as one log. ``profile`` is for logs that name none.

    Raises `BadInput` for a log that cannot be used, a channel in two logs at one time, clocks that cannot be brought together, or logs that
    have no moment in common; `UsageProblem` for what is wrong in the file.
    """
    dive = load_dive(path)
    logs = []
    for asked, file in parts_of(path, dive):
        own = path.parent / asked.profile
        chosen = str(own) if asked.profile and not (FOLDER / f"{asked.profile}.toml").is_file() else asked.profile or profile
        logs.append(_placed(file.relative_to(path.parent).as_posix(), asked, read(file, chosen if chosen != PROFILE else None, timezone)))
    logs = _on_one_clock(path, logs)
    _refuse_apart(path, logs)
    zero = min(p.first_s for p in logs)
    channels, zero = _stretch(path, dive, _joined(path, logs, zero), zero)
    known = logs[0].clock == "UTC"
    shas = "".join(p.log.properties.get("profile_sha256", "") for p in logs)
    facts: dict[str, str] = {}
    if dive.from_s is not None or dive.to_s is not None:
        facts["stretch"] = f"from {dive.from_s or 0.0:g} s to {'the end' if dive.to_s is None else f'{dive.to_s:g} s'} of the dive"
    for p in logs:
        facts = {**p.log.properties, **facts, f"log {p.name}": f"{p.log.profile}, begins at {p.start_s - zero:.3f} s"}
    return RawLog(
        source=str(path), sha256=sha256(path), profile=PROFILE, vehicle=_vehicle(path, dive.vehicle, logs), t0_ns=round(zero * 1e9) if known else None,
        channels=channels, findings=tuple(replace(f, where=f"{p.name}: {f.where}") for p in logs for f in p.log.findings),
        properties={**facts, "profile_sha256": hashlib.sha256(shas.encode()).hexdigest()},
        rules={n: r for p in logs for n, r in p.log.rules.items() if n in channels},
        markers=tuple(sorted((replace(m, t_s=m.t_s + p.start_s - zero) for p in logs for m in p.log.markers), key=lambda m: m.t_s)),
    )  # fmt: skip


def _placed(name: str, asked: DiveLog, log: RawLog) -> Placed:
    """The log with the channels that are asked for, on the clock that its stamps are of."""
    kept = {n: s for n, s in log.channels.items() if not asked.channels or n in asked.channels or n.partition(":")[0] in asked.channels}
    if not kept:
        raise UsageProblem(f"{name}: has none of the channels {', '.join(asked.channels)}", f"it has: {', '.join(log.channels)}")
    log = replace(log, channels=kept, rules={n: r for n, r in log.rules.items() if n in kept})
    offset = asked.offset_s or 0.0
    if asked.begins is not None:
        return Placed(name, asked, log, "UTC", asked.begins.timestamp() - min(float(s.t[0]) for s in kept.values()) + offset)
    if log.t0_ns is not None:
        return Placed(name, asked, log, "UTC", log.t0_ns * 1e-9 + offset)
    if (day := log.properties.get("time_of_day_s_at_start")) is not None:
        return Placed(name, asked, log, "time of day", float(day) + offset)
    return Placed(name, asked, log, "its own", float(log.properties.get("stamp_s_at_start", "0")) + offset)


def _on_one_clock(path: Path, logs: Sequence[Placed]) -> list[Placed]:
    """The same logs, where their clocks are one. Raises `BadInput` saying for each what it lacks."""
    if len({p.clock for p in logs}) > 1:
        told = [f"{p.name} counts {'from a start of its own' if p.clock == 'its own' else p.clock}" for p in logs]
        hint = "state the moment of the first sample: begins = 2026-11-23T10:00:00Z, for each that does not count UTC"
        raise BadInput(all_at_once(told, f"{path}: the logs have unlike clocks"), hint)
    unsaid = [p.name for p in logs[1:] if p.clock == "its own" and p.asked.offset_s is None]
    if unsaid:
        raise BadInput(
            all_at_once([f"{name} counts from a start of its own" for name in unsaid], f"{path}: clocks that nothing joins"),
            f"state offset_s, the seconds to add to its stamps to have those of {logs[0].name} (0.0: both count from one start), or begins for all",
        )
    return list(logs)


def _refuse_apart(path: Path, logs: Sequence[Placed]) -> None:
    """Raises `BadInput` where a log shares neither a moment nor a channel (a split recording) with the others."""
    spans = {p.name: (p.first_s, p.last_s) for p in logs}
    for p in logs:
        others = [o for o in logs if o is not p]
        meets = any(spans[o.name][0] < spans[p.name][1] and spans[p.name][0] < spans[o.name][1] for o in others)
        if others and not meets and not any(set(o.log.channels) & set(p.log.channels) for o in others):
            zero = min(first for first, _ in spans.values())
            told = [f"{name}: {first - zero:.1f} to {last - zero:.1f} s" for name, (first, last) in spans.items()]
            raise BadInput(all_at_once(told, f"{path}: {p.name} has no moment in common with the others"), "check --timezone, offset_s and begins")


def _joined(path: Path, logs: Sequence[Placed], zero: float) -> Mapping[str, Series]:
    """Every channel on the dive's clock; of a channel in several logs the stretches one after another."""
    held: dict[str, list[tuple[str, Series]]] = {}
    for p in logs:
        for name, series in p.log.channels.items():
            held.setdefault(name, []).append((p.name, Series(series.t + (p.start_s - zero), series.values, series.stamp)))
    twice: dict[str, list[str]] = {}
    out = {}
    for name, parts in held.items():
        parts = sorted(parts, key=lambda part: float(part[1].t[0]))
        for (a, first), (b, second) in pairwise(parts):
            if second.t[0] <= first.t[-1]:
                twice.setdefault(f"{a} and {b}", []).append(name)
        if not twice:
            out[name] = Series(np.concatenate([s.t for _, s in parts]), np.concatenate([s.values for _, s in parts]), parts[0][1].stamp)
    if twice:
        told = [f"{files} both have {', '.join(names)}" for files, names in twice.items()]
        raise BadInput(all_at_once(told, f"{path}: channels in two logs at one time"), "say with channels = [...] which log each is taken from")
    return out


def _stretch(path: Path, dive: Dive, channels: Mapping[str, Series], zero: float) -> tuple[Mapping[str, Series], float]:
    """What the dive file takes of the dive, from there on counted. Raises `BadInput` where that is beyond it."""
    start, end = dive.from_s or 0.0, np.inf if dive.to_s is None else dive.to_s
    last = max(float(s.t[-1]) for s in channels.values())
    if start >= last or (np.isfinite(end) and end > last + 1.0):
        raise BadInput(f"{path}: from_s = {start:g} to to_s = {end:g} is beyond the dive, which lasts {last:.1f} s", "choose times within it")
    out = {}
    for name, s in channels.items():
        within = (s.t >= start - 1e-9) & (s.t <= end + 1e-9)
        if within.any():
            out[name] = Series(s.t[within] - start, s.values[within], s.stamp)
    return (out, zero + start) if start or np.isfinite(end) else (channels, zero)


def _vehicle(path: Path, stated: str, logs: Sequence[Placed]) -> str:
    """The vehicle that the dive file states (a file's path counts from there), else that of the logs' profiles."""
    if stated:
        return str(path.parent / stated) if stated.endswith(".toml") else stated
    named = {p.log.vehicle: p.name for p in logs if p.log.vehicle}
    if len(named) > 1:
        raise BadInput(f"{path}: " + ", ".join(f"{name} is of {vehicle}" for vehicle, name in named.items()), "state the vehicle in the dive file")
    return next(iter(named), "")
