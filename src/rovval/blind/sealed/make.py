"""Make a sealed set: logs with random names and equal metadata, their labels sealed, and a manifest that fixes both by digest."""

from __future__ import annotations

import datetime
import json
import os
import secrets
import shutil
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from rovval.blind.cases import generate
from rovval.blind.cases.questions import Question, questions
from rovval.blind.plant.spec import PlantName
from rovval.blind.sealed import sealing
from rovval.blind.sealed.folder import MANIFEST, Folder, write
from rovval.core.errors import UsageProblem

EPOCH_S = 1_600_000_000  # every log's file time: September 2020
Say = Callable[[str, float], None]


def make_set(
    root: Path,
    vehicle: Path,
    seed: int | None = None,
    size: str = "full",
    *,
    plant: PlantName = "a",
    healthy: float | None = None,
    seconds: float | None = None,
    asked: Sequence[Question] | None = None,
    key: Path | None = None,
    workers: int = 2,
    say: Say = lambda text, share: None,
) -> Folder:
    """Make the set in ``root``, which must not hold one. Without a seed one is drawn, and sealed with the labels.

    ``plant``, ``healthy`` and ``seconds`` as `questions` takes them;
    ``asked`` gives the questions outright. Equal seeds give equal logs; names and seal differ each time.
    """
    place = Folder(root)
    if root.exists() and any(root.iterdir()):
        raise UsageProblem(f"{root} is not empty", "give a new folder; a sealed set is never made over another")
    drawn = secrets.randbits(31) if seed is None else seed
    chosen = list(asked) if asked is not None else questions(vehicle, drawn, size, plant, healthy, seconds)
    secret = sealing.new_key(key or place.key)
    place.logs.mkdir(parents=True)
    files = sorted(f"{secrets.token_hex(6)}.csv" for _ in chosen)
    labels: dict[str, dict[str, Any]] = {}
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
        jobs = {pool.submit(generate.make, vehicle, q.case, place.logs / f): (f, q) for f, q in zip(files, chosen, strict=True)}
        for job in as_completed(jobs):
            name, question = jobs[job]
            labels[name] = job.result() | {"left_out": question.left_out, "without": list(question.without)}
            say(f"flown {len(labels)} of {len(jobs)}", len(labels) / len(jobs))
    flown = {name: label for name, label in sorted(labels.items()) if "failed" not in label}
    if not flown:
        raise UsageProblem(f"{root}: every flight failed: {next(iter(labels.values()))['failed']}", "check the vehicle file")
    shutil.copyfile(vehicle, root / vehicle.name)
    _equalise([place.logs / name for name in flown])
    text = {"schema": "rovval.blind-labels/1", "vehicle": vehicle.stem, "plant": plant, "seed": drawn, "size": size, "logs": flown}
    text["failed"] = [label for label in labels.values() if "failed" in label]
    place.labels.write_bytes(sealing.seal(json.dumps(text).encode(), secret))
    rows = {name: {"sha256": sealing.digest(place.logs / name), "without": label["without"]} for name, label in flown.items()}
    write(root / "manifest.json", {
        "schema": MANIFEST, "made": now(), "vehicle": vehicle.name, "plant": plant, "model": "fossen", "count": len(rows),
        "labels_sha256": sealing.digest(place.labels), "logs": rows,
    })  # fmt: skip
    return place


def now() -> str:
    """This moment, UTC."""
    return datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds")


def _equalise(logs: Sequence[Path]) -> None:
    """Same size (blank lines at the end) and same file time for every log, so that the folder's listing tells nothing."""
    largest = max(path.stat().st_size for path in logs)
    for path in logs:
        with path.open("ab") as file:
            file.write(b"\n" * (largest - path.stat().st_size))
        os.utime(path, (EPOCH_S, EPOCH_S))
