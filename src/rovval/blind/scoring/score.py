"""Open the seal and score what was committed: digests first, then the labels, then marks, tables, page and history."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from rovval.blind.cases.grid import Case
from rovval.blind.scoring import ground_truth, history, outcomes, tables
from rovval.blind.scoring.oracle import oracle
from rovval.blind.scoring.rules import score_log
from rovval.blind.scoring.strata import strata
from rovval.blind.scoring.twin import made_by_effect
from rovval.blind.sealed import sealing
from rovval.blind.sealed.answer import one_thread_each
from rovval.blind.sealed.folder import Folder, write
from rovval.blind.sealed.make import now
from rovval.core.errors import UsageProblem
from rovval.core.version import __version__
from rovval.diagnose import Diagnosis
from rovval.vehicle import load as load_vehicle

SCHEMA = "rovval.blind-score/1"
HEADLINE = (
    "top_1",
    "right_when_one_named",
    "group_hit",
    "truth_named",
    "all_found",
    "group_size",
    "errors",
    "detected",
    "blamed",
    "said_unknown",
    "axis",
    "of_oracle",
    "cpu_s",
)
Say = Callable[[str, float], None]


def score_set(
    root: Path,
    *,
    key: Path | None = None,
    kept: Path | None = None,
    workers: int = 2,
    say: Say = lambda text, share: None,
) -> dict[str, Any]:
    """Score the committed answers of a set; ``kept`` is the history of unsealings.

    Raises:
        UsageProblem: answers are not committed, or were made or changed after the labels were first opened.
        BadInput: a log, the labels or an answer is not what was sealed or committed.
    """
    place = Folder(root)
    manifest, commit = place.manifest(), place.committed()
    place.check_logs()
    past = kept or history.default(root)
    history.refuse_other_answers(past, manifest["labels_sha256"], commit["sha256"])
    secret = sealing.read_key(key or place.key)
    opened = _open(place, commit)
    sealed = json.loads(sealing.unseal(place.labels.read_bytes(), secret))
    labels = sealed["logs"]
    answers = {row["log"]: row for row in (json.loads(p.read_text(encoding="utf-8")) for p in place.answer_files())}
    vehicle = str(place.vehicle())
    best = _oracles(place, vehicle, sealed, commit, workers, say)
    result = score_logs(labels, answers, best, vehicle)
    result = {
        "schema": SCHEMA, "opened": opened, "seed": sealed["seed"], "size": sealed["size"], "vehicle": sealed["vehicle"],
        "plant": sealed.get("plant", "a"),
        "rovval": __version__, "engine": commit["engine"], "committed": commit["committed"],
        "labels_sha256": manifest["labels_sha256"], "answers_sha256": commit["sha256"], "flights_failed": len(sealed["failed"]), **result,
    }  # fmt: skip
    write(root / "score.json", result)
    fields = ("opened", "seed", "size", "vehicle", "plant", "rovval", "engine", "labels_sha256", "answers_sha256")
    line = {name: result[name] for name in fields} | {"logs": len(labels), "summary": summary(result["strata"])}
    history.append(past, line)
    result["unsealings"] = history.read(past)
    return result


def score_logs(
    labels: Mapping[str, Any], answers: Mapping[str, Any], oracles: Mapping[str, Mapping[str, float]], vehicle: str
) -> dict[str, Any]:
    """Marks of every log, the tables over strata, and the wrong answers."""
    path, nominal = Path(vehicle), load_vehicle(vehicle)
    rows = []
    for name, label in labels.items():
        answer = answers.get(name, {"failed": "no answer", "cpu_s": 0.0})
        diagnosis = None if "failed" in answer else Diagnosis.read(answer["document"])
        best = _at_least(oracles.get(name, {}), label, diagnosis)
        row = score_log(label, answer, best, nominal, path)
        row |= {
            "log": name,
            "mission": label["mission"],
            "strata": strata(label, best),
            "truth": tables.names_of(label),
        }
        row |= {"foreign": [ground_truth.foreign(e) for e in label["effects"]], "left_out": label["left_out"]}
        row |= {
            "severity": [e["severity"] for e in label["effects"]],
            "library": len(diagnosis.ranking) if diagnosis else 0,
            "vehicle": nominal.name,
            "noise": diagnosis.detection.noise if diagnosis and diagnosis.detection else None,
        }
        row["visible"] = outcomes.visible(row, best)
        row |= _stated(diagnosis)
        rows.append(row)
    return {"logs": rows, "strata": tables.table(rows), "wrong": tables.confusions(rows), "summed": outcomes.summed(rows)}


def _stated(diagnosis: Diagnosis | None) -> dict[str, Any]:
    """What is said first, its probability, and those of the kinds of model; causes that were not found are causes."""
    first, p = outcomes.said(diagnosis) if diagnosis else ("failed", None)
    belief = diagnosis.probabilities if diagnosis else None
    kinds = belief.model_dump(exclude={"not_found"}) | {"causes": belief.causes + belief.not_found} if belief else None
    return {"said": first, "p_said": p if belief else None, "p_kinds": kinds}


def _at_least(best: Mapping[str, float], label: Mapping[str, Any], diagnosis: Diagnosis | None) -> dict[str, float]:
    """The oracle, which is a local search, is never behind an answer that names the truth and nothing else."""
    if not best or diagnosis is None or [c.effect for c in diagnosis.causes] != tables.names_of(label) or label["left_out"]:
        return dict(best)
    reached = diagnosis.shrinkage.total
    return {key: value if key == "each" else max(value, reached) for key, value in best.items()}


def summary(by_stratum: Mapping[str, Mapping[str, Any]]) -> dict[str, dict[str, float | int]]:
    """The few numbers of each stratum that the history keeps."""
    return {
        name: {"n": row["n"], **{m: round(row[m]["value"], 3) for m in HEADLINE if m in row and row[m]["value"] is not None}}
        for name, row in by_stratum.items()
    }


def _open(place: Folder, commit: Mapping[str, Any]) -> str:
    """Note that the labels are about to be read, before they are; the time of the first unsealing."""
    if place.opened.exists():
        before: dict[str, str] = json.loads(place.opened.read_text(encoding="utf-8"))
        if before["answers_sha256"] != commit["sha256"]:
            raise UsageProblem(
                f"{place.root}: the seal was opened at {before['opened']}; these answers were made or changed after that",
                "restore the answers that were scored, or make a new set with another seed",
            )
        return before["opened"]
    when = now()
    write(place.opened, {"opened": when, "answers_sha256": commit["sha256"], "engine": commit["engine"]})
    return when


def _oracles(
    place: Folder, vehicle: str, sealed: Mapping[str, Any], commit: Mapping[str, Any], workers: int, say: Say
) -> dict[str, dict[str, float]]:
    """The oracle of every log with known effects, and of every log of one that the library lacks what its twin says of it; kept beside the score, since
    they do not depend on the answers."""
    kept = place.root / "oracle.json"
    found = json.loads(kept.read_text(encoding="utf-8")) if kept.is_file() else {}
    done: dict[str, dict[str, float]] = dict(found["logs"]) if found.get("engine") == commit["engine"] else {}
    wanted = {name: label for name, label in sealed["logs"].items() if label["effects"] and name not in done}
    asked = {name: commit[name] for name in ("model", "window_s", "calibration_slop")}
    with one_thread_each(), ProcessPoolExecutor(workers, mp_context=get_context("forkserver")) as pool:
        jobs = {}
        for name, label in wanted.items():
            effects = [e for e in label["effects"] if not ground_truth.foreign(e)]
            onsets = {ground_truth.name(e): e["onset_s"] for e in effects if e["onset_s"] is not None}
            true = list(dict.fromkeys(ground_truth.name(e) for e in effects))
            if true:
                job = pool.submit(oracle, place.logs / name, vehicle, true, onsets, asked)
            else:
                without_it = Case(label["mission"], (), label["seed"], label["duration_s"], label["slop"], sealed.get("plant", "a"))
                job = pool.submit(made_by_effect, place.logs / name, vehicle, without_it, asked)
            jobs[job] = name
        for count, job in enumerate(as_completed(jobs), 1):
            done[jobs[job]] = job.result()
            say(f"oracle {count} of {len(jobs)}", count / len(jobs))
    write(kept, {"engine": commit["engine"], "logs": done})
    return done
