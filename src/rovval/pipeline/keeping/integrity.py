"""Whether what is kept is whole and true: runs, catalogue, reports, by their digests; and what can be done about what is not."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from rovval.core.errors import BadInput, RovvalError
from rovval.ingest.files import sha256
from rovval.pipeline.planning.plan import QUARANTINE
from rovval.pipeline.planning.records import RECORD, is_damaged, read_quarantine, read_record
from rovval.storage import places
from rovval.storage.atomic import refusal
from rovval.storage.contents import damage

if TYPE_CHECKING:
    from rovval.core.data import Run

ASIDE = ".damaged"  # the folder, beside what it lay among, that damaged files are moved to


@dataclass(frozen=True, slots=True)
class Fault:
    """One file or folder that is not as it was written: ``place``, what is wrong with it, and the folder of all that it belongs to."""

    place: Path
    what: str
    root: Path


@dataclass(frozen=True, slots=True)
class Repair:
    """What was done about a fault. ``mended`` if nothing is left to do."""

    fault: Fault
    done: str
    mended: bool


def check(archive: Path, reports: Path | None = None) -> list[Fault]:
    """Every fault of an archive, its catalogue, and the reports of a batch. Every byte is read."""
    return [*_runs(archive), *_catalogue(archive), *(_reports(reports) if reports else ())]


def repair(faults: list[Fault]) -> list[Repair]:
    """Make a damaged run anew from its log where that is still the same; move everything else aside, so that the next batch makes it anew.

    Raises `UsageProblem` where a place cannot be written.
    """
    return [_repaired(fault) for fault in faults]


def _runs(archive: Path) -> Iterator[Fault]:
    from rovval.storage import catalogue
    from rovval.storage.archive import load_run

    for folder in sorted(p for p in archive.glob("*") if p.is_dir() and not p.name.startswith(".") and p.name != catalogue.FOLDER):
        try:
            run = load_run(folder, archive)
        except BadInput as error:
            yield Fault(folder, _after(error.message, folder), archive)
        else:
            if run.id != folder.name:
                yield Fault(folder, f"holds the run {run.id}", archive)


def _catalogue(archive: Path) -> Iterator[Fault]:
    from rovval.storage import catalogue

    for file, what in catalogue.faults(archive).items():
        yield Fault(file, what, archive)


def _reports(reports: Path) -> Iterator[Fault]:
    for folder in sorted(path.parent for path in reports.glob(f"*/{RECORD}")):
        if is_damaged(folder):
            yield Fault(folder / RECORD, "damaged record of what was done", reports)
        for step, facts in ((read_record(folder) or {}).get("steps") or {}).items():
            for name, what in damage(facts.get("files", {}), reports, digests=True).items():
                if what == "gone" or not name.startswith(".."):  # a run that is there is held against its own manifest
                    yield Fault(places.named(reports, name), f"{what} ({step})", reports)
    for file in sorted((reports / QUARANTINE).glob("*.json")):
        if read_quarantine(file) is None:
            yield Fault(file, "damaged record of a log that was set aside", reports)


def _repaired(fault: Fault) -> Repair:
    if not fault.place.exists():
        return Repair(fault, "gone: the next `rovval run` of its pipeline makes it anew", False)
    made = _made_anew(fault)
    aside = _aside(fault)
    if made is None:
        return Repair(fault, f"moved to {aside}; the next `rovval run` makes it anew, or ingest its log again", False)
    from rovval.storage.archive import save_run

    return Repair(fault, f"made anew from {made.source}; the damaged one is in {aside}", save_run(made, fault.root) == fault.place)


def _made_anew(fault: Fault) -> Run | None:
    """The run of a damaged folder, from the log that its manifest names; None where the log is gone or another by now."""
    from rovval.storage.archive import manifest, open_run

    facts = manifest(fault.place) if fault.place.is_dir() else None
    if facts is None or not (log := places.place(facts["source"])).exists() or sha256(log) != facts["sha256"]:
        return None
    try:
        run = open_run(facts["source"], facts["profile"], fault.root)
    except RovvalError:
        return None
    return run if run.id == fault.place.name else None


def _aside(fault: Fault) -> Path:
    home = fault.root / ASIDE
    name = fault.place.relative_to(fault.root).as_posix().replace("/", "__") if fault.place.is_relative_to(fault.root) else fault.place.name
    target = next(t for n in range(1000) if not (t := home / (f"{name}.{n}" if n else name)).exists())
    try:
        return places.move(fault.place, target)
    except OSError as error:
        raise refusal(fault.place, error) from None


def _after(message: str, folder: Path) -> str:
    return message.removeprefix(f"{folder}: ")
