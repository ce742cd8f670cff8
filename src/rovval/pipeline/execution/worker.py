"""One log through its steps, in a worker. Every step that is done is on disk and in the record before the next begins."""

from __future__ import annotations

import os
import time
import traceback
from collections.abc import Callable
from contextlib import suppress
from datetime import UTC, datetime
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rovval.core.errors import BadInput, RovvalError, SimulationStopped, Unwritable
from rovval.core.version import __version__
from rovval.ingest.files import files_of, sha256
from rovval.pipeline import tolerances
from rovval.pipeline.planning.hashes import code_of_this_process
from rovval.pipeline.planning.plan import Task
from rovval.pipeline.planning.records import judged, outputs_whole, read_record, write_record
from rovval.storage.atomic import FULL, refusal, write_json, write_text
from rovval.storage.contents import contents
from rovval.storage.places import name_from, place, reached

if TYPE_CHECKING:
    from rovval.core.data import Comparison, Run, SimResult
    from rovval.vehicle.model import Vehicle

Outcome = dict[str, Any]


def work(task: Task) -> Outcome:
    """Do what is missing of one task. Returns its record, or why it is set aside, or why no task can be done: a disk that is full
    and a worker of other code are no log's fault. Never raises for what one log can do."""
    if code_of_this_process() != task.code:
        why = f"this worker runs other code of rovval ({code_of_this_process()}) than the plan was made by ({task.code})"
        return {"status": "stopped", "record": {"reason": why, "next": "install one version everywhere, restart the workers, run again"}}
    try:
        return _done_or_set_aside(task)
    except Unwritable as error:
        return {"status": "stopped", "record": {"reason": error.message, "next": error.hint}}


def _done_or_set_aside(task: Task) -> Outcome:
    began = time.monotonic()
    try:
        with reached():
            record = _steps(task)
    except Unwritable:
        raise
    except _Changed as error:
        return set_aside(task, "changed", error.message, error.exit_code, hint=error.hint)
    except OSError as error:
        if error.errno in FULL:
            raise refusal(Path(os.fsdecode(error.filename or task.folder)), error) from None
        return set_aside(task, "unreadable", f"{task.log}: {error}", 3, hint="it is tried again by the next run")
    except RovvalError as error:
        return set_aside(task, "refused", error.message, error.exit_code, hint=error.hint)
    except MemoryError:
        return set_aside(task, "crash", "out of memory", 70)
    except Exception as error:
        text = "".join(traceback.format_exception(error))
        return set_aside(task, "internal", f"{type(error).__name__}: {error}", 70, trace=text)
    task.quarantine.unlink(missing_ok=True)
    return {"status": "done", "seconds": round(time.monotonic() - began, 3), "record": record}


def set_aside(task: Task, kind: str, reason: str, code: int, hint: str = "", trace: str = "") -> Outcome:
    """Write the quarantine record of a log; the log itself stays where it is."""
    record = {
        "schema": "rovval.quarantine/1",
        "log": str(task.log),
        "sha256": task.sha256,
        "key": task.key,
        "code": task.code,
        "kind": kind,
        "reason": reason,
        "next": hint,
        "exit_code": code,
        "traceback": trace,
        "when": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime()),
    }
    write_json(task.quarantine, record)
    return {"status": "quarantined", "record": record}


def _steps(task: Task) -> dict[str, Any]:
    record = read_record(task.folder) or {"schema": "rovval.batch/1", "steps": {}}
    planned = {step: found for step, found in record["steps"].items() if step in dict(task.keys)}  # what is not would stay as it was
    record |= {"log": str(task.log), "sha256": task.sha256, "steps": planned}
    bench = _Bench(task)
    for step, key in task.keys:
        before = record["steps"].get(step)
        if not before or before["key"] != key or not outputs_whole(before, task.reports, digests=True):
            facts, outputs = bench.do(step)
            run = bench.run
            record |= {"run": run.id, "vehicle": run.vehicle, "duration_s": run.duration_s, "findings": len(run.findings), **_date(run)}
            record |= {"model": task.model, "method": task.method, "rovval": __version__}
            written = contents(outputs, task.reports)
            names = [name_from(task.reports, p) for p in outputs]
            record["steps"][step] = {"key": key, "code": task.code, "outputs": names, "files": written, **facts}
            write_record(task.folder, record)
    return record


def _date(run: Run) -> dict[str, Any]:
    """When the run began (UTC), and by what that is known: its stamps; or its file's time of change, which may be later, where they are of no
    year that a calendar has."""
    if run.t0_ns is not None:
        with suppress(ValueError, OverflowError, OSError):
            return {"began": datetime.fromtimestamp(run.t0_ns * 1e-9, UTC).isoformat(), "dated_by": "stamps"}
    changed = max(part.stat().st_mtime for part in files_of(place(run.source)))
    return {"began": datetime.fromtimestamp(changed, UTC).isoformat(), "dated_by": "file"}


class _Changed(BadInput):
    """The log is not what the plan was made for."""


class _Bench:
    """Run, vehicle and simulation of a task, each made once and only if a step asks for it."""

    def __init__(self, task: Task) -> None:
        self.task = task

    @cached_property
    def run(self) -> Run:
        from rovval.storage.archive import open_run

        run = open_run(self.task.log, self.task.profile, self.task.archive)
        if {run.sha256, sha256(self.task.log)} != {self.task.sha256}:  # while it was read, and after
            raise _Changed(f"{self.task.log}: changed between the plan and its reading", "it is tried again by the next run; see settle_s")
        return run

    @cached_property
    def vehicle(self) -> Vehicle:
        from rovval.pipeline.steps import vehicle_of

        return vehicle_of(self.run, self.task.vehicle or None)

    @cached_property
    def sim(self) -> SimResult:
        from rovval.pipeline.steps import simulated

        return simulated(self.run, self.vehicle, self.task.model, self.task.effects, self.task.window_s)

    def do(self, step: str) -> tuple[dict[str, Any], list[Path]]:
        """Do one step; its facts for the record, and its outputs."""
        steps: dict[str, Callable[[], tuple[dict[str, Any], list[Path]]]] = {
            "ingest": self.ingest,
            "simulate": self.simulate,
            "compare": self.compare,
            "diagnose": self.diagnose,
        }
        return steps[step]()

    def ingest(self) -> tuple[dict[str, Any], list[Path]]:
        from rovval.storage.archive import save_run

        folder = save_run(self.run, self.task.archive, overwrite=True)
        return {"findings": [str(f) for f in self.run.findings]}, [folder]

    def simulate(self) -> tuple[dict[str, Any], list[Path]]:
        from rovval.simulation.file import save_simulation

        path = self.task.folder / "simulation.parquet"
        save_simulation(self.sim, path)
        return {"stops": list(self.sim.stops)}, [path]

    def compare(self) -> tuple[dict[str, Any], list[Path]]:
        from rovval import report
        from rovval.comparison import compare
        from rovval.pipeline.steps import checked_against
        from rovval.report.common.versions import made_by
        from rovval.report.comparison.json import document

        task, limits = self.task, tolerances.parse(self.task.tolerances)
        comparison = compare(checked_against(self.run, self.vehicle), self.sim)
        with made_by(self._typed("compare", *(word for text in task.tolerances for word in ("--fail-above", text)))):
            links = self._links("diagnose", "Diagnosis", "../diagnosis/diagnosis.html")
            files = report.write(comparison, task.folder / "comparison", self.vehicle, recorded=task.recordings, limits=limits, links=links)
        return {"comparison": judged(document(comparison))}, list(files.values())

    def diagnose(self) -> tuple[dict[str, Any], list[Path]]:
        from rovval import report
        from rovval.diagnose import diagnose
        from rovval.pipeline.steps import before_and_after
        from rovval.report.common.versions import made_by
        from rovval.report.diagnosis import json as diagnosis_json
        from rovval.report.diagnosis.sentences.sentence import verdict

        task, folder = self.task, self.task.folder / "diagnosis"
        found = diagnose(
            [self.run], self.vehicle, model=task.model, window_s=task.window_s, calibration_slop=task.calibration_slop
        )
        document = diagnosis_json.document(found)
        facts = {key: document[key] for key in ("vehicle", "verdict", "causes")}
        before: Comparison | None = None
        after: SimResult | None = None
        try:
            before, after = before_and_after(found, self.run, self.vehicle)
        except (BadInput, SimulationStopped) as error:  # the diagnosis is not lost for it
            facts["without_the_whole_run"] = error.message
        with made_by(self._typed("diagnose", "--calibration-slop", f"{task.calibration_slop:g}")):
            links = self._links("compare", "Comparison", "../comparison/report.html")
            files = report.write_diagnosis(found, folder, before, self.vehicle if task.recordings else None, after, links)
        if found.vehicle_fixed:
            write_text(folder / "vehicle_fixed.toml", found.vehicle_fixed)
        return {**facts, "said": verdict(found), "gap": document["gap"]["axes"]}, list(files.values())

    def _links(self, step: str, label: str, page: str) -> dict[str, str]:
        """The pages that belong to one of its reports: that of all runs, and what another ``step`` makes of this one."""
        to_index = name_from(self.task.folder / "comparison", self.task.reports / "index.html")
        return {"All runs": to_index} | ({label: page} if step in dict(self.task.keys) else {})

    def _typed(self, command: str, *more: str) -> list[str]:
        """The command that makes one of its reports by hand."""
        task = self.task
        options = {"--profile": task.profile, "--vehicle": task.vehicle, "--model": task.model, "--window": f"{task.window_s:g}"}
        effects = [word for effect in task.effects for word in ("--effect", effect)] if command == "compare" else []
        return [command, str(task.log), *(word for name, value in options.items() if value for word in (name, value)), *effects, *more]
