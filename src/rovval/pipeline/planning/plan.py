"""What a batch has to do: a task for each log, with the content key of each step, and what of it is done already."""

from __future__ import annotations

import hashlib
import json
import time
from collections import Counter
from collections.abc import Mapping, Sequence, Set
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from rovval.core.counts import counted
from rovval.core.errors import Unwritable, UsageProblem, all_at_once
from rovval.core.file_names import printable, shortened
from rovval.ingest.files import files_of
from rovval.pipeline import tolerances
from rovval.pipeline.planning import discover
from rovval.pipeline.planning.config import Pipeline, Source
from rovval.pipeline.planning.hashes import Hashes, code_on_disk
from rovval.pipeline.planning.packed import Packed
from rovval.pipeline.planning.records import brief, is_damaged, outputs_whole, read_quarantine, read_record

QUARANTINE = "quarantine"
HASHES = ".hashes.json"
RETRIED = ("crash", "internal", "unreadable", "changed")  # a worker that died may have lacked memory; a refused log stays refused until it changes


@dataclass(frozen=True, slots=True)
class Task:
    """One log, all that a worker needs to know, picklable. ``keys`` in the order of the steps; ``folder`` takes its reports; ``tolerances`` are the limits
    that its page shows; ``code`` is what the planner runs, `rovval.pipeline.planning.hashes.code_on_disk`; ``method`` is the digest of all that the results
    depend on beside the log: runs of one method can be held against each other."""

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
    method: str
    recordings: bool = False
    tolerances: tuple[str, ...] = ()

    @property
    def key(self) -> str:
        """The last step's key: it depends on all results before it."""
        return self.keys[-1][1]

    @property
    def id(self) -> str:
        """Its name for whoever starts tasks one by one."""
        return self.folder.name

    @property
    def quarantine(self) -> Path:
        """Where its record stands if it is set aside."""
        return self.reports / QUARANTINE / f"{self.folder.name}.json"


@dataclass(frozen=True, slots=True)
class Plan:
    """Tasks to do, records of what is done, records of what stays in quarantine or cannot be read, and logs left for later with the reason.

    ``missing`` are sources of which no log is there, with the reason; ``kept`` the records of the logs that they had. ``postponed`` are the records
    of logs that older code of rovval has judged and that a later night judges anew; ``folders`` are the names of
    those of the reports of every log, where reports on a former content of a log are removed (`keep_replaced_days`). ``settled`` are the places of
    quarantine records of logs that are done: whoever did them was killed before it could remove them.
    """

    todo: tuple[Task, ...]
    done: Packed
    set_aside: tuple[Mapping[str, Any], ...]
    waiting: tuple[tuple[Path, str], ...]
    missing: tuple[tuple[str, str], ...] = ()
    kept: Packed = field(default_factory=Packed)
    postponed: Packed = field(default_factory=Packed)
    folders: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    settled: tuple[Path, ...] = ()

    @property
    def why(self) -> Mapping[str, int]:
        """Why there is something to do, and for how many logs."""
        return Counter(why(task) for task in self.todo)


@dataclass(slots=True)
class _Sorting:
    """The lists of a plan while logs are sorted into them."""

    pipeline: Pipeline
    hashes: Hashes
    retry: bool
    todo: list[Task] = field(default_factory=list)
    done: Packed = field(default_factory=Packed)
    aside: list[Mapping[str, Any]] = field(default_factory=list)
    waiting: list[tuple[Path, str]] = field(default_factory=list)
    missing: list[tuple[str, str]] = field(default_factory=list)
    kept: Packed = field(default_factory=Packed)
    seen: dict[str, str] = field(default_factory=dict)
    folders: dict[str, tuple[str, ...]] = field(default_factory=dict)
    settled: list[Path] = field(default_factory=list)
    quarantined: Set[Path] = frozenset()

    def log(self, log: Path, source: Source, method: _Method) -> None:
        """Put one log where it belongs."""
        if _changes(log, self.pipeline.settle_s):
            self.waiting.append((log, f"changed less than {self.pipeline.settle_s:g} s ago (settle_s): a later run takes it"))
            return
        task = _task(self.pipeline, source, log, self.hashes.of(log), method)
        if self.pipeline.keep_replaced_days is not None:
            self.folders[str(log)] = (*self.folders.get(str(log), ()), task.folder.name)
        if (twin := self.seen.setdefault(task.key, str(log))) != str(log):
            self.waiting.append((log, f"same content as {twin}"))
        elif record := finished(task, self.hashes.afresh):
            self.done.append(brief(record, self.pipeline.tolerances))
            if task.quarantine in self.quarantined:
                self.settled.append(task.quarantine)
        elif (record := read_quarantine(task.quarantine)) and record["key"] == task.key and record["kind"] not in RETRIED and not self.retry:
            self.aside.append(record)
        else:
            self.todo.append(task)

    def nothing_of(self, source: Source, base: Path, method: _Method) -> None:
        """No log of a source is there: what is known of those that were there is kept."""
        for log, sha in self.hashes.below([discover.fixed(pattern, base) for pattern in source.logs]):
            record = None if log.exists() else finished(_task(self.pipeline, source, log, sha, method), False)
            if record:
                self.kept.append(brief(record, self.pipeline.tolerances))
        gone = discover.absent(source.logs, base)
        why = f"{gone[0]} does not exist" if gone else "no log is there"
        had = f"; {counted(len(self.kept), 'log was', 'logs were')} there before: is the volume mounted?" if self.kept else ""
        self.missing.append((", ".join(source.logs), why + had))


def plan(pipeline: Pipeline, base: Path, retry: bool = False, verify: bool = False) -> Plan:
    """Discover the logs and sort them into done, set aside, and to do. ``retry`` tries quarantined logs again, ``verify`` reads every log
    and every output anew instead of trusting sizes and times.

    Raises `UsageProblem` where the folder of a pattern does not exist and no log of it was ever there.
    """
    sorting = _Sorting(pipeline, Hashes(pipeline.reports / HASHES, afresh=verify), retry)
    sorting.quarantined = set((pipeline.reports / QUARANTINE).glob("*.json"))
    made_by = code_on_disk()
    for source in pipeline.source:
        method = _method(pipeline, source, made_by)
        logs, unusable = discover.matching(source.logs, base)
        for path, reason in unusable.items():
            sorting.aside.append(_unusable(path, reason))
        for log in logs:
            try:
                sorting.log(log, source, method)
            except OSError as error:
                sorting.aside.append(_unusable(log, f"cannot be read: {error.strerror}"))
        if not logs:
            sorting.nothing_of(source, base, method)
    _refuse_unknown_folders(pipeline, base, sorting)
    with suppress(Unwritable):  # it only saves reading; whoever writes a result on that disk is stopped, and says why
        sorting.hashes.save()
    todo, postponed = _in_a_night(sorting.todo, pipeline)
    return Plan(
        tuple(todo), sorting.done, tuple(sorting.aside), tuple(sorting.waiting), tuple(sorting.missing), sorting.kept, Packed(postponed), sorting.folders,
        tuple(sorting.settled),
    )  # fmt: skip


def _in_a_night(todo: Sequence[Task], pipeline: Pipeline) -> tuple[list[Task], list[Mapping[str, Any]]]:
    """What of ``todo`` is done this night: all that is new, and of the logs that other code of rovval has judged the newest (`most_redone`); and the records
    of the rest, which stand as they are until then."""
    most = pipeline.most_redone
    if most is None:
        return list(todo), []
    records = ((task, read_record(task.folder)) for task in todo)
    judged = {task: brief(record, pipeline.tolerances) for task, record in records if record and "began" in record and _codes(record) - {task.code}}
    newest = sorted(judged, key=lambda task: str(judged[task]["began"]), reverse=True)
    return [task for task in todo if task not in judged] + newest[:most], [judged[task] for task in newest[most:]]


def _codes(record: Mapping[str, Any]) -> set[str]:
    return {step.get("code", "older") for step in record["steps"].values()}


def _refuse_unknown_folders(pipeline: Pipeline, base: Path, sorting: _Sorting) -> None:
    """A folder that does not exist and never had a log is a slip of the pen in the file."""
    if sorting.hashes.known:
        return
    absent = {pattern: discover.absent([pattern], base) for source in pipeline.source for pattern in source.logs}
    if gone := [f"{pattern}: {folders[0]} does not exist" for pattern, folders in absent.items() if folders]:
        raise UsageProblem(all_at_once(gone, "logs"), "mend the pattern or make the folder")


def _changes(log: Path, settle_s: float) -> bool:
    """Whether a log was written so lately that it may still be. A time further in the future is a wrong clock, and waiting does not help."""
    now = time.time()
    return any(abs(now - part.stat().st_mtime) < settle_s for part in files_of(log))


def _unusable(path: Path, reason: str) -> Mapping[str, Any]:
    """The record of what cannot even be planned: nothing is known by which it could be found again, so that it is looked at every time."""
    name = printable(str(path))
    return {"log": name, "kind": "unreadable", "reason": f"{name}: {reason}", "next": "mend its name or its permissions", "exit_code": 3}


@dataclass(frozen=True, slots=True)
class _Method:
    """What the results of a source's logs depend on beside the logs: ``code``, and the digest ``results`` of all, vehicle, profile and options; and for
    each step that of what it depends on, and its page."""

    code: str
    results: str
    steps: tuple[tuple[str, str], ...]


def _method(pipeline: Pipeline, source: Source, code: str) -> _Method:
    vehicle, profile = _content(source)
    options: dict[str, tuple[Any, ...]] = {
        "ingest": (),
        "simulate": (vehicle, pipeline.model, pipeline.effects, pipeline.window_s),
        "compare": (vehicle, pipeline.model, pipeline.effects, pipeline.window_s),
        "diagnose": (vehicle, pipeline.model, pipeline.window_s, pipeline.calibration_slop),
    }
    shown: dict[str, tuple[Any, ...]] = {"compare": (_limits(pipeline), pipeline.recordings), "diagnose": (pipeline.recordings,)}
    results, steps = _hash(code, profile), []
    for step in pipeline.steps:
        results = _hash(results, step, *options[step])
        steps.append((step, _hash(results, *shown.get(step, ()))))  # what only its own page shows makes no later step new
    return _Method(code, results, tuple(steps))


def _limits(pipeline: Pipeline) -> tuple[str, ...]:
    return tolerances.of_one_run(pipeline.tolerances)


def _task(pipeline: Pipeline, source: Source, log: Path, sha: str, method: _Method) -> Task:
    return Task(
        log=log,
        sha256=sha,
        profile=source.profile,
        vehicle=source.vehicle,
        model=pipeline.model,
        effects=pipeline.effects,
        window_s=pipeline.window_s,
        calibration_slop=pipeline.calibration_slop,
        keys=tuple((step, hashlib.sha256(f"{sha} {digest}".encode()).hexdigest()) for step, digest in method.steps),
        archive=pipeline.archive,
        reports=pipeline.reports,
        folder=pipeline.reports / f"{shortened(log.stem)}-{_hash(sha, source.profile, source.vehicle)[:8]}",
        code=method.code,
        method=method.results[:12],
        recordings=pipeline.recordings,
        tolerances=_limits(pipeline),
    )


def _content(source: Source) -> tuple[str, str]:
    """Numbers of the source's vehicle and hash of its profile: an edited file makes its logs new."""
    from rovval import vehicle
    from rovval.ingest.profile import load_profile

    profile = load_profile(source.profile) if source.profile else None
    wanted = source.vehicle or (profile.vehicle_file if profile else "")
    numbers = vehicle.load(wanted).model_dump_json(exclude={"sources", "notes", "title"}) if wanted else ""
    return numbers, profile.sha256 if profile else ""


def finished(task: Task, digests: bool) -> Mapping[str, Any] | None:
    """The record of a task of which nothing is left to do: all steps are done, with these keys, and their outputs are whole, by size, and by content if
    ``digests``. None for any other."""
    record = read_record(task.folder)
    if record is None or any(record["steps"].get(step, {}).get("key") != key for step, key in task.keys):
        return None
    return record if all(outputs_whole(step, task.reports, digests) for step in record["steps"].values()) else None


def why(task: Task) -> str:
    """Why a task is to be done, in words."""
    if is_damaged(task.folder):
        return "with a damaged record"
    record, aside = read_record(task.folder), read_quarantine(task.quarantine)
    if record is None and aside is None:
        return "new"
    steps = record["steps"] if record else {}
    made_by = {step.get("code", "older") for step in (steps.values() if record else [aside or {}])}
    if other := made_by - {task.code}:
        return f"made by other code of rovval ({', '.join(sorted(other))}; now {task.code})"
    if aside and not record:
        return f"set aside before ({aside['kind']})"
    if missing := [step for step, _ in task.keys if step not in steps]:
        return f"without {', '.join(missing)} so far"
    same = all(steps[step]["key"] == key for step, key in task.keys)
    return "with an output gone or damaged" if same else "of changed vehicle, profile or options"


def _hash(*parts: Any) -> str:
    return hashlib.sha256(json.dumps(parts, default=str).encode()).hexdigest()
