"""Answer a sealed set: diagnose every log with all cores, go on where an interrupted run stopped, commit the answers by digest."""

from __future__ import annotations

import json
import shutil
import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from contextlib import AbstractContextManager
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from rovval.blind.sealed.folder import COMMIT, Folder, engine_hash, write
from rovval.blind.sealed.make import now
from rovval.blind.sealed.sealing import digest, digest_of_files
from rovval.core.environment import environment
from rovval.core.errors import RovvalError, UsageProblem

PROFILE = "merlin"  # the layout of every log of the plant
BULKY = ("heatmap", "traces", "coherence", "manoeuvre")  # pictures: not needed for a score
ONE_THREAD = ("NUMBA_NUM_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
Say = Callable[[str, float], None]


def answer_set(
    root: Path, *, workers: int = 2, baselines: bool = True, fresh: bool = False, say: Say = lambda text, share: None
) -> dict[str, Any]:
    """Diagnose what is not answered yet and commit; the commitment.

    Raises:
        UsageProblem: the seal was opened, or answers of another engine are there (``fresh`` begins again).
    """
    place = Folder(root)
    manifest = place.manifest()
    place.refuse_if_opened()
    place.check_logs()
    if fresh:
        place.commit.unlink(missing_ok=True)
        shutil.rmtree(place.answers, ignore_errors=True)
    if place.commit.is_file():
        return place.committed()
    engine, asked = engine_hash(), {"calibration_slop": 0.05, "window_s": 10.0, "model": manifest["model"], "floors": baselines}
    done, vehicle = _done(place, engine), str(place.vehicle())
    left = [name for name in manifest["logs"] if name not in done]
    began = time.monotonic()
    with one_thread_each(), ProcessPoolExecutor(workers, mp_context=get_context("forkserver")) as pool:
        jobs = {
            pool.submit(one, place.logs / name, vehicle, manifest["logs"][name]["without"], asked): name
            for name in left
        }
        for count, job in enumerate(as_completed(jobs), 1):
            if engine_hash() != engine:
                pool.shutdown(wait=False, cancel_futures=True)
                raise UsageProblem(
                    f"{root}: the engine's source changed while it answered; the answers would not be of one engine",
                    f"run from a copy of the source that nobody edits, and begin again: `rovval blind answer {root} --fresh`",
                )
            name = jobs[job]
            write(place.answers / f"{Path(name).stem}.json", {"log": name, "engine": engine, **job.result()})
            rest = (time.monotonic() - began) / count * (len(left) - count)
            say(f"answered {len(done) + count} of {len(manifest['logs'])}, about {rest / 60:.0f} min left", count / len(left))
    commit = {"schema": COMMIT, "sha256": digest_of_files(place.answer_files()), "committed": now(), "engine": engine, **asked}
    commit["labels_sha256"] = digest(place.labels)
    write(place.commit, commit)
    return commit


def one(log: Path, vehicle: str, without: Sequence[str], asked: Mapping[str, Any]) -> dict[str, Any]:
    """Diagnosis of one log without its pictures, what the simple methods name, and CPU seconds; ``failed`` where the engine refused."""
    from rovval.blind.baselines.methods import baseline_answers
    from rovval.diagnose import diagnose
    from rovval.storage.archive import open_run
    from rovval.vehicle import load as load_vehicle

    nominal = load_vehicle(vehicle)
    began = time.process_time()
    try:
        run = open_run(log, PROFILE)
        found = diagnose(
            [run],
            nominal,
            model=asked["model"],
            window_s=asked["window_s"],
            calibration_slop=asked["calibration_slop"],
            without=tuple(without),
        )
    except (RovvalError, ArithmeticError, ValueError, LookupError, AssertionError) as problem:
        return {"failed": f"{type(problem).__name__}: {problem}", "cpu_s": time.process_time() - began}
    spent = time.process_time() - began
    document = {key: value for key, value in found.document().items() if key not in BULKY}
    simple = baseline_answers(run, nominal, without, asked["model"], asked["window_s"]) if asked["floors"] else {}
    return {"document": document, "floors": simple, "cpu_s": spent}


def _done(place: Folder, engine: str) -> set[str]:
    """Logs that this engine has answered. Answers of another engine are not mixed with its own."""
    found = [json.loads(path.read_text(encoding="utf-8")) for path in place.answer_files()]
    others = sorted({row["engine"] for row in found} - {engine})
    if others:
        raise UsageProblem(
            f"{place.answers} holds {len(found)} answers of engine {', '.join(others)}; this one is {engine}",
            f"begin again with this engine: `rovval blind answer {place.root} --fresh`",
        )
    return {row["log"] for row in found}


def one_thread_each() -> AbstractContextManager[None]:
    """Processes that are started within use one thread each."""
    return environment(dict.fromkeys(ONE_THREAD, "1"))
