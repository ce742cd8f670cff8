"""Many logs at once: ``python -m rovval.blind.cases.generate --vehicle TOML --out DIR --seed N (--cases FILE | --grid)``.

Logs get random names; ``labels.json`` goes to a directory of its own. A cases file is a list of
``{"mission": "rich", "effects": [{"name": "buoyancy_error", "severity": 1.0}], "duration_s": 300, "seed": 7, "slop": 0.03}``;
``target`` and ``onset_s`` of an effect, ``duration_s``, ``seed`` and ``slop`` may be left out.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from rovval.blind.cases import flight
from rovval.blind.cases.csv_log import write_csv
from rovval.blind.cases.grid import DURATION_S, Case, grid
from rovval.blind.plant.spec import Planted, PlantName, stream
from rovval.blind.second import flight as second_flight


def read_cases(path: Path, seed: int, plant: PlantName = "a") -> list[Case]:
    """Cases file to cases of a plant; seeds that are left out are drawn from ``seed``."""
    rng = stream(seed, "cases")
    out = []
    for row in json.loads(path.read_text(encoding="utf-8")):
        effects = tuple(Planted(**effect) for effect in row.get("effects", []))
        drawn = int(rng.integers(2**31 - 1))
        duration, slop = float(row.get("duration_s", DURATION_S)), float(row.get("slop", 0.03))
        out.append(Case(row["mission"], effects, int(row.get("seed", drawn)), duration, slop, plant))
    return out


def make(vehicle: Path, case: Case, path: Path) -> dict[str, Any]:
    """Fly one case and write its log; the label, with ``failed`` where there is no log."""
    try:
        fly = second_flight.fly if case.plant == "b" else flight.fly
        flown = fly(vehicle, case.mission, case.effects, case.seed, case.duration_s, case.slop)
    except (RuntimeError, ValueError) as problem:
        effects = [{"name": e.name, "target": e.target, "severity": e.severity} for e in case.effects]
        return {"failed": str(problem), "mission": case.mission, "seed": case.seed, "effects": effects}
    write_csv(flown, path)
    return dict(flown.truth)


def generate(
    vehicle: Path, cases: Sequence[Case], out: Path, labels: Path, seed: int, workers: int = 2
) -> dict[str, dict[str, Any]]:
    """Make every log under a random name and write ``labels.json``; the labels by log name."""
    out.mkdir(parents=True, exist_ok=True)
    labels.mkdir(parents=True, exist_ok=True)
    rng = stream(seed, "names")
    files = [f"{rng.bytes(6).hex()}.csv" for _ in cases]
    done: dict[str, dict[str, Any]] = {}
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
        jobs = {pool.submit(make, vehicle, c, out / f): f for c, f in zip(cases, files, strict=True)}
        for job in as_completed(jobs):
            done[jobs[job]] = label = job.result()
            note = f"  failed: {label['failed']}" if "failed" in label else ""
            print(f"{len(done)}/{len(cases)} {jobs[job]}{note}", file=sys.stderr)  # noqa: T201
    text = {"schema": "rovval.blind-labels/1", "vehicle": vehicle.stem, "seed": seed, "logs": dict(sorted(done.items()))}
    (labels / "labels.json").write_text(json.dumps(text, indent=1), encoding="utf-8")
    return done


def main(arguments: Sequence[str] | None = None) -> int:
    """Command line: 0 when every log was made, 1 when some flights failed."""
    parser = argparse.ArgumentParser(prog="python -m rovval.blind.cases.generate", description="Make labelled logs.")
    parser.add_argument("--vehicle", type=Path, required=True)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--labels", type=Path, help="default: beside OUT, with -labels appended")
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--repeats", type=int, default=1, help="of the grid")
    parser.add_argument("--limit", type=int, help="only the first so many cases")
    parser.add_argument("--workers", type=int, default=2)
    which = parser.add_mutually_exclusive_group(required=True)
    which.add_argument("--cases", type=Path)
    which.add_argument("--grid", action="store_true")
    given = parser.parse_args(arguments)
    cases = grid(given.vehicle, given.seed, given.repeats) if given.grid else read_cases(given.cases, given.seed)
    labels = given.labels or given.out.with_name(given.out.name + "-labels")
    done = generate(given.vehicle, cases[: given.limit], given.out, labels, given.seed, given.workers)
    return 1 if any("failed" in label for label in done.values()) else 0


if __name__ == "__main__":
    sys.exit(main())
