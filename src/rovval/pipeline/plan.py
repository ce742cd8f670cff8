"""What a batch has to do: a task for each log, with the content key of each step, and what of it is done already."""

from __future__ import annotations

import hashlib
import json
import time
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rovval.pipeline import discover
from rovval.pipeline.config import Pipeline, Source
from rovval.pipeline.hashes import Hashes, code_on_disk
from rovval.storage.atomic import read_json

RECORD = "record.json"
QUARANTINE = "quarantine"
HASHES = ".hashes.json"
RETRIED = ("crash", "internal")  # a worker that died may have lacked memory; a refused log stays refused until it changes


@dataclass(frozen=True, slots=True)
class Task:
    """One log, all that a worker needs to know, picklable. ``keys`` in the order of the steps; ``folder`` takes its reports;
    ``code`` is what the planner runs, `rovval.pipeline.hashes.code_on_disk`."""

    log: Path
    sha256: str
    profile: str | None
    vehicle: str
    model: str
    effects: tuple[str, ...]
    window_s: float
    calibration_slop: float
    keys: tuple[tuple[str, str], ...]
    archive: Path
    reports: Path
    folder: Path
    code: str

    @property
    def key(self) -> str:
        """The last step's key: it depends on all before it."""
        return self.keys[-1][1]

    @property
    def quarantine(self) -> Path:
        """Where its record stands if it is set aside."""
        return self.reports / QUARANTINE / f"{self.folder.name}.json"


@dataclass(frozen=True, slots=True)
class Plan:
    """Tasks to do, records of what is done, records of what stays in quarantine, and logs left for later with the reason."""

    todo: tuple[Task, ...]
    done: tuple[Mapping[str, Any], ...]
    set_aside: tuple[Mapping[str, Any], ...]
    waiting: tuple[tuple[Path, str], ...]

    @property
    def why(self) -> Mapping[str, int]:
        """Why there is something to do, and for how many logs."""
        return Counter(why(task) for task in self.todo)


def plan(pipeline: Pipeline, base: Path, retry: bool = False) -> Plan:
    """Discover the logs and sort them into done, set aside, and to do. ``retry`` tries quarantined logs again."""
    todo: list[Task] = []
    done: list[Mapping[str, Any]] = []
    aside: list[Mapping[str, Any]] = []
    waiting: list[tuple[Path, str]] = []
    seen: dict[str, Path] = {}
    hashes, made_by = Hashes(pipeline.reports / HASHES), code_on_disk()
    for source in pipeline.source:
        vehicle, profile = _content(source)
        for log in discover.matching(source.logs, base):
            if time.time() - log.stat().st_mtime < pipeline.settle_s:
                waiting.append((log, f"changed less than {pipeline.settle_s:g} s ago (settle_s): a later run takes it"))
                continue
            task = _task(pipeline, source, log, hashes.of(log), (vehicle, profile, made_by))
            if (twin := seen.setdefault(task.key, log)) != log:
                waiting.append((log, f"same content as {twin}"))
            elif record := _finished(task):
                done.append(record)
            elif (
                (record := read_json(task.quarantine)) and record["key"] == task.key and record["kind"] not in RETRIED and not retry
            ):
                aside.append(record)
            else:
                todo.append(task)
    hashes.save()
    return Plan(tuple(todo), tuple(done), tuple(aside), tuple(waiting))


def _task(pipeline: Pipeline, source: Source, log: Path, sha: str, content: tuple[str, str, str]) -> Task:
    vehicle, profile, made_by = content
    key = _hash(made_by, sha, profile)
    keys = []
    options: dict[str, tuple[Any, ...]] = {
        "ingest": (),
        "simulate": (vehicle, pipeline.model, pipeline.effects, pipeline.window_s),
        "compare": (vehicle, pipeline.model, pipeline.effects, pipeline.window_s),
        "diagnose": (vehicle, pipeline.model, pipeline.window_s, pipeline.calibration_slop),
    }
    for step in pipeline.steps:
        key = _hash(key, step, *options[step])
        keys.append((step, key))
    return Task(
        log=log,
        sha256=sha,
        profile=source.profile,
        vehicle=source.vehicle,
        model=pipeline.model,
        effects=pipeline.effects,
        window_s=pipeline.window_s,
        calibration_slop=pipeline.calibration_slop,
        keys=tuple(keys),
        archive=pipeline.archive,
        reports=pipeline.reports,
        folder=pipeline.reports / f"{log.stem}-{_hash(sha, source.profile, source.vehicle)[:8]}",
        code=made_by,
    )


def _content(source: Source) -> tuple[str, str]:
    """Numbers of the source's vehicle and hash of its profile: an edited file makes its logs new."""
    from rovval import vehicle
    from rovval.ingest.profile import load_profile

    profile = load_profile(source.profile) if source.profile else None
    wanted = source.vehicle or (profile.vehicle_file if profile else "")
    numbers = vehicle.load(wanted).model_dump_json(exclude={"sources", "notes", "title"}) if wanted else ""
    return numbers, profile.sha256 if profile else ""


def _finished(task: Task) -> Mapping[str, Any] | None:
    record = read_record(task)
    if record is None or any(record["steps"].get(step, {}).get("key") != key for step, key in task.keys):
        return None
    outputs = [path for step in record["steps"].values() for path in step["outputs"]]
    return record if all((task.reports / path).exists() for path in outputs) else None


def why(task: Task) -> str:
    """Why a task is to be done, in words."""
    record = read_record(task) or read_json(task.quarantine)
    if record is None:
        return "new"
    steps = record.get("steps", {})
    made_by = {step.get("code", "older") for step in (*steps.values(), *([] if steps else [record]))}
    if other := made_by - {task.code}:
        return f"made by other code of rovval ({', '.join(sorted(other))}; now {task.code})"
    if missing := [step for step, _ in task.keys if step not in steps]:
        return f"without {', '.join(missing)} so far"
    same = all(steps[step]["key"] == key for step, key in task.keys)
    return "with an output gone" if same else "of changed vehicle, profile or options"


def read_record(task: Task) -> dict[str, Any] | None:
    """The record of what was done with the task's log, if there is one."""
    return read_json(task.folder / RECORD)


def _hash(*parts: Any) -> str:
    return hashlib.sha256(json.dumps(parts, default=str).encode()).hexdigest()
