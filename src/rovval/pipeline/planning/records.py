"""Records of what was done with a log (rovval.batch/1), each with its own digest: one that was damaged counts as none."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence, Set
from functools import cache
from pathlib import Path
from typing import Any

from rovval.pipeline import tolerances
from rovval.storage.atomic import json_text, read_json, read_json_with_bytes, write_text
from rovval.storage.contents import damage
from rovval.storage.places import named

RECORD = "record.json"
DIGEST = "digest"
MARK, NO_DIGEST = f'"{DIGEST}": "', "0" * 64
JUDGED = ("vehicle", "stops", "findings", "axes", "window")  # parts of a comparison's document by which a batch judges a run
CHECKED = ("key", "files")  # facts of a step that only the plan asks for
TOLD = frozenset({"rms", "unit"})  # what the page and the catalogue tell of each axis, over windows


def read_record(folder: Path) -> dict[str, Any] | None:
    """The record of the log whose reports lie in ``folder``; None where there is none or it is damaged."""
    record, content = read_json_with_bytes(folder / RECORD)
    if record is None:
        return None
    digest = record.pop(DIGEST, None)
    if digest is not None and digest != _digest_of_text(content) and digest != _digest_of_older(record):  # one of a still older rovval has none
        return None
    steps = record.get("steps")
    sound = isinstance(steps, dict) and all(isinstance(s, dict) and {"key", "outputs"} <= s.keys() for s in steps.values())
    return record if sound and {"log", "run"} <= record.keys() else None


def is_damaged(folder: Path) -> bool:
    """Whether a record lies there that cannot be used."""
    return (folder / RECORD).exists() and read_record(folder) is None


def write_record(folder: Path, record: Mapping[str, Any]) -> None:
    """Write it with its digest: that of its text, as a reader has it; that of its content took two thirds of the time of reading a record."""
    text = json_text({**record, DIGEST: NO_DIGEST})
    before, mark, after = text.rpartition(MARK)
    write_text(folder / RECORD, before + mark + _digest_of_text(text.encode()) + after[len(NO_DIGEST) :])


def read_quarantine(path: Path) -> dict[str, Any] | None:
    """Why a log was set aside; None where it was not, or the record of it is damaged (the log is then tried again)."""
    record = read_json(path)
    return record if record and {"log", "key", "kind", "reason", "next"} <= record.keys() else None


def brief(record: Mapping[str, Any], limits: Sequence[str] = ()) -> Mapping[str, Any]:
    """What of a record the summary, the catalogue and the page of a batch are made of, a tenth of it: a batch holds one of every log at once. Metrics
    that ``limits``, the tolerances of the pipeline file, are about are kept as well."""
    steps = {step: {name: fact for name, fact in facts.items() if name not in CHECKED} for step, facts in record["steps"].items()}
    for facts in steps.values():
        facts["outputs"] = [place for place in facts["outputs"] if place.endswith(".html")]
    if "compare" in steps:
        steps["compare"] = _compared(steps["compare"], _metrics(tuple(limits)))
    return {**record, "steps": steps}


def judged(comparison: Mapping[str, Any]) -> dict[str, Any]:
    """Of a comparison's document what tolerances, catalogue and page ask for: every metric as a number. All of it stands in the report beside the
    record, and a batch reads the records of all logs every night."""
    kept = {name: comparison[name] for name in JUDGED if name in comparison}
    kept["axes"] = _numbers(kept["axes"])
    if window := kept.get("window"):
        kept["window"] = {"seconds": window["seconds"], "axes": _numbers(window["axes"])}
    return kept


def _numbers(axes: Mapping[str, Mapping[str, Any]]) -> dict[str, dict[str, Any]]:
    return {axis: {name: value for name, value in row.items() if not isinstance(value, dict | list)} for axis, row in axes.items()}


@cache
def _metrics(limits: Sequence[str]) -> frozenset[str]:
    return frozenset(limit.metric for limit in tolerances.parse(tolerances.of_one_run(limits)))


def _compared(compared: Mapping[str, Any], asked: Set[str]) -> dict[str, Any]:
    whole = compared["comparison"]
    kept = {name: whole[name] for name in ("vehicle", "stops", "findings") if name in whole}
    kept["axes"] = _only(whole["axes"], asked | {"unit"}) if asked else {}
    if window := whole.get("window"):
        kept["window"] = {"seconds": window["seconds"], "axes": _only(window["axes"], asked | TOLD)}
    return {**compared, "comparison": kept}


def _only(axes: Mapping[str, Mapping[str, Any]], names: Set[str]) -> dict[str, dict[str, Any]]:
    return {axis: {name: value for name, value in row.items() if name in names} for axis, row in axes.items()}


def outputs_whole(step: Mapping[str, Any], reports: Path, digests: bool = False) -> bool:
    """Whether all that a step wrote is still there as it was written: by size, and by content if ``digests``."""
    if "files" not in step:  # of an older rovval
        return all(named(reports, path).exists() for path in step["outputs"])
    return not damage(step["files"], reports, digests)


def _digest_of_text(content: bytes) -> str:
    """That of a record's text, of which its digest is the last entry, with zeros in the place of that."""
    before, mark, after = content.rpartition(MARK.encode())
    return hashlib.sha256(b"".join((before, mark, NO_DIGEST.encode(), after[len(NO_DIGEST) :]))).hexdigest()


def _digest_of_older(record: Mapping[str, Any]) -> str:
    return hashlib.sha256(json.dumps(record, sort_keys=True).encode()).hexdigest()
