"""The archive: one immutable folder a run, ``run.parquet`` (values and reasons) and ``manifest.json`` (everything else).

A folder is written beside its place and renamed into it, so that a kill leaves either nothing or a whole run. In an object store, where nothing
can be renamed, the manifest is put last.
"""

from __future__ import annotations

import hashlib
import io
import json
import shutil
import sys
import uuid
from contextlib import nullcontext, suppress
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl

from rovval.alignment import align
from rovval.alignment.checks import check
from rovval.core.data import ClockReport, Marker, Resampled, Run
from rovval.core.did_you_mean import near
from rovval.core.errors import BadInput, Finding, RovvalError, UsageProblem
from rovval.core.progress import Progress, silent
from rovval.core.version import __version__
from rovval.ingest import read
from rovval.storage import atomic, lock, places
from rovval.storage.atomic import drafts, read_json, refusal

SCHEMA = "rovval.run/1"
REASON = "reason:"
ARCHIVE = Path("archive")


def open_run(
    source: str | Path, profile: str | None = None, archive: Path = ARCHIVE, timezone: str | None = None, progress: Progress = silent
) -> Run:
    """A log file (ingested on the fly), a run's folder, or the id of a run in ``archive`` -> the run. ``timezone`` and
    ``progress`` as of `rovval.ingest.read`.

    Raises `BadInput` or `UsageProblem` as `read`, `align` and `load` do.
    """
    path, archive = places.place(source), places.place(archive)
    if (path / "manifest.json").is_file() or (not path.exists() and (archive / str(source)).is_dir()):
        return load_run(source, archive)
    if not path.exists():
        raise BadInput(f"{source}: no such log file, and no such run in {archive}", _meant(path, archive))
    if not places.is_remote(path):
        return _read(path, profile, timezone, progress)
    with places.fetched(path) as local:
        try:
            return replace(_read(local, profile, timezone, progress), source=str(path))
        except RovvalError as error:
            raise type(error)(error.message.replace(str(local), str(path)), error.hint) from None


def _meant(path: Path, archive: Path) -> str:
    """What to do about a log that is not there: files beside it and runs of nearly that name, else the first runs there are."""
    runs = [str(run) for run in run_ids(archive)]
    beside = [] if places.is_remote(path) or not path.parent.is_dir() else [p.name for p in path.parent.iterdir() if not p.name.startswith(".")]
    close = [str(path.parent / name) for name in near(path.name, beside)] + near(path.name, runs)
    if close:
        return f"did you mean {' or '.join(close)}?"
    return f"runs in {archive}: {', '.join(runs[:5])}" if runs else f"check the path; {archive} holds no runs"


def _read(path: Path, profile: str | None, timezone: str | None, progress: Progress) -> Run:
    raw = read(path, profile, timezone, progress)
    return align(replace(raw, findings=tuple(dict.fromkeys((*raw.findings, *check(raw))))))


def save_run(run: Run, archive: Path = ARCHIVE, overwrite: bool = False) -> Path:
    """Write a run; the same run already there is left alone. Another one of its id (other code read the log, or found more in it)
    gives way if ``overwrite``; else `BadInput` is raised."""
    place = places.place(archive) / run.id
    table, manifest = _bytes(run)
    if place.exists():
        try:
            old = _same(place, run)
        except BadInput:
            if not overwrite:
                raise
            _move_away(place)
        else:
            if not overwrite or _facts(_bytes(old)[1]) == _facts(manifest):
                return place
            _move_away(place)
    _put(place, table, manifest) if places.is_remote(place) else _rename_into(place, table, manifest, run, overwrite)
    return place


def _put(place: Path, table: bytes, manifest: dict[str, Any]) -> None:
    """Into an object store: the manifest last, since a run is what has one."""
    for name, content in (("run.parquet", table), ("manifest.json", _text(manifest).encode())):
        with drafts(place / name) as [draft]:
            draft.write_bytes(content)


def _rename_into(place: Path, table: bytes, manifest: dict[str, Any], run: Run, overwrite: bool) -> None:
    draft = place.with_name(f".{run.id}.{uuid.uuid4().hex[:8]}.part")
    try:
        with lock.held(place.parent, wait=True, shared=True) if lock.KNOWN else nullcontext():
            draft.mkdir(parents=True)
            (draft / "run.parquet").write_bytes(table)
            (draft / "manifest.json").write_text(_text(manifest), encoding="utf-8")
            try:
                draft.rename(place)
            except OSError:
                if not place.exists():
                    raise
                save_run(run, place.parent, overwrite)  # another process was faster
    except OSError as error:
        raise refusal(place, error) from None
    finally:
        shutil.rmtree(draft, ignore_errors=True)


def sweep(archive: Path) -> None:
    """Remove what a kill left half-written among the runs of an archive, unless another process writes there just now: the next one does it then."""
    if places.is_remote(archive):
        return
    with suppress(UsageProblem, OSError), lock.held(archive):
        for left in archive.glob(atomic.LEFTOVER):
            shutil.rmtree(left, ignore_errors=True)


def _text(manifest: dict[str, Any]) -> str:
    return json.dumps(manifest, indent=1, ensure_ascii=False) + "\n"


def _same(place: Path, run: Run) -> Run:
    """The run that stands at ``place``; raises `BadInput` where it is not ``run``."""
    try:
        old = load_run(place, place.parent)
    except BadInput as error:
        raise BadInput(f"{place}: holds a damaged run: {error.message}", "move that folder away and ingest again") from None
    if _digest(old) != _digest(run):
        raise BadInput(f"{place}: holds another run of the same id", "move that folder away, or use another --archive")
    return old


def _facts(manifest: dict[str, Any]) -> dict[str, Any]:
    """What a manifest says of the run itself, not of where its log lay and what wrote it."""
    return {k: v for k, v in json.loads(json.dumps(manifest)).items() if k not in ("source", "versions", "table_sha256")}


def _move_away(place: Path) -> None:
    """Out of its place in one step, then gone; another process may have been faster. In an object store the manifest goes first."""
    if places.is_remote(place):
        (place / "manifest.json").unlink(missing_ok=True)
        places.remove(place)
        return
    old = place.with_name(f".{place.name}.{uuid.uuid4().hex[:8]}.part")
    with suppress(FileNotFoundError):
        place.rename(old)
    shutil.rmtree(old, ignore_errors=True)


def load_run(id_or_folder: str | Path, archive: Path = ARCHIVE) -> Run:
    """A run by its id or folder, exactly as saved. Raises `BadInput` where it is not there or damaged."""
    folder = places.place(id_or_folder)
    if not (folder / "manifest.json").is_file():
        folder = places.place(archive) / str(id_or_folder)
    try:
        manifest = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
        table = (folder / "run.parquet").read_bytes()
    except FileNotFoundError:
        near = ", ".join(run_ids(archive)[:5]) or "none"
        raise BadInput(f"{id_or_folder}: no such run in {archive}", f"runs there: {near}") from None
    except (OSError, ValueError) as error:
        raise BadInput(f"{folder}: damaged: {error}", "ingest the log again") from None
    if not isinstance(manifest, dict):
        raise BadInput(f"{folder}: damaged: manifest.json holds no object", "ingest the log again")
    if manifest.get("schema") != SCHEMA:
        raise BadInput(f"{folder}: schema {manifest.get('schema')!r}, this version reads {SCHEMA!r}", "ingest the log again")
    if manifest.get("table_sha256") != hashlib.sha256(table).hexdigest():
        raise BadInput(f"{folder}: run.parquet is not the table that the manifest describes", "ingest the log again")
    return _run(manifest, pl.read_parquet(io.BytesIO(table)))


def manifest(folder: Path) -> dict[str, Any] | None:
    """The facts of the run in ``folder``, which may be damaged beside them; None where they are themselves."""
    facts = read_json(folder / "manifest.json")
    return facts if facts and {"source", "sha256", "profile"} <= facts.keys() else None


def run_ids(archive: Path = ARCHIVE) -> tuple[str, ...]:
    """Ids of the runs in an archive, sorted; () where there is none."""
    return tuple(sorted(p.parent.name for p in places.place(archive).glob("*/manifest.json") if not p.parent.name.startswith(".")))


def _bytes(run: Run) -> tuple[bytes, dict[str, Any]]:
    columns = {name: pl.Series(v) for name, v in run.values.items()} | {REASON + n: pl.Series(r) for n, r in run.reasons.items()}
    buffer = io.BytesIO()
    pl.DataFrame(columns).write_parquet(buffer, compression="zstd")
    table = buffer.getvalue()
    facts = {k: getattr(run, k) for k in ("id", "source", "sha256", "profile", "vehicle", "t0_ns", "dt")}
    versions = {"rovval": __version__, "python": sys.version.split()[0], "numpy": np.__version__, "polars": pl.__version__}
    return table, {
        "schema": SCHEMA, **facts, "samples": len(run), "duration_s": run.duration_s, "clock": asdict(run.clock),
        "resampled": {n: asdict(r) for n, r in run.resampled.items()}, "findings": [asdict(f) for f in run.findings],
        "properties": dict(run.properties), "channels": list(run.values), "table_sha256": hashlib.sha256(table).hexdigest(),
        "versions": versions, **({"markers": [asdict(m) for m in run.markers]} if run.markers else {}),
    }  # fmt: skip


def _run(manifest: dict[str, Any], table: pl.DataFrame) -> Run:
    try:
        names = manifest["channels"]
        return Run(
            **{k: manifest[k] for k in ("id", "source", "sha256", "profile", "vehicle", "t0_ns", "dt", "properties")},
            values={n: table[n].to_numpy() for n in names},
            reasons={n: table[REASON + n].to_numpy() for n in names},
            resampled={n: Resampled(**r) for n, r in manifest["resampled"].items()},
            clock=ClockReport(**manifest["clock"]),
            findings=tuple(Finding(**f) for f in manifest["findings"]),
            markers=tuple(Marker(**m) for m in manifest.get("markers", ())),
        )
    except (KeyError, TypeError, pl.exceptions.PolarsError) as error:
        raise BadInput(f"run {manifest.get('id')}: damaged manifest: {error}", "ingest the log again") from None


def _digest(run: Run) -> str:
    """What makes two runs the same: their values, masks and origin; not where the file lay or which version wrote it."""
    digest = hashlib.sha256(repr((run.id, run.sha256, run.profile, run.dt, run.t0_ns, list(run.values))).encode())
    for name in run.values:
        digest.update(run.values[name].tobytes() + run.reasons[name].tobytes())
    return digest.hexdigest()
