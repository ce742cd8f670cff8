"""Which files are logs: files and folders that the user named, or glob patterns."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Sequence
from glob import glob
from pathlib import Path

from rovval.core.errors import BadInput, UsageProblem, all_at_once

SUFFIXES = (".csv", ".tsv", ".txt", ".bag", ".db3", ".mcap", ".bin", ".tlog", ".xlsx", ".parquet")
FOREIGN = (".h5", ".hdf5", ".mat", ".ulg", ".ulog", ".xls")  # logs by their names that no reader is there for: named and refused, not passed over
COMPRESSED = (".gz",)
BLOCK = 1 << 20


def logs_in(sources: Sequence[str]) -> list[Path]:
    """Files as named; of a folder every file that looks like a log, readable or not, and every ROS 2 bag folder as one log.

    Raises:
        BadInput: a source does not exist, or there is no log in all of them.
    """
    if missing := [s for s in sources if not Path(s).exists()]:
        raise BadInput(all_at_once([f"{s} does not exist" for s in missing], "source"), "mend the path")
    logs = [log for source in sources for log in (_inside(Path(source)) if Path(source).is_dir() else [Path(source)])]
    if not logs:
        raise BadInput(f"no log in {', '.join(sources)}", f"a folder is searched for {' '.join(SUFFIXES)} and bag folders")
    return logs


def matching(patterns: Sequence[str], base: Path) -> list[Path]:
    """Logs that the glob patterns match, relative to ``base``; a bag folder is one log. In the order of their names, each once.

    Raises:
        UsageProblem: the fixed part of a pattern is a place that does not exist.
    """
    if missing := [p for p in patterns if not _root(base / p).exists()]:
        raise UsageProblem(
            all_at_once([f"{p}: {_root(base / p)} does not exist" for p in missing], "logs"),
            "mend the pattern or make the folder",
        )
    found = {Path(name) for p in patterns for name in glob(str(base / p), recursive=True)}  # noqa: PTH207 (a pattern may be absolute)
    bags = {p for p in found if is_bag(p)} | {p.parent for p in found if is_bag(p.parent)}
    return sorted(
        bags
        | {p for p in found if p.is_file() and not bags & set(p.parents) and not p.name.startswith(".") and p.suffix != ".md"}
    )


def is_bag(path: Path) -> bool:
    """A ROS 2 bag is a folder with metadata.yaml."""
    return (path / "metadata.yaml").is_file()


def sha256(path: Path) -> str:
    """Content hash of a file, or of a bag folder's files and their names."""
    if path.is_file():
        return _digest([path], path.parent)
    return _digest(sorted(p for p in path.rglob("*") if p.is_file()), path)


def _digest(files: Iterable[Path], base: Path) -> str:
    total = hashlib.sha256()
    several = list(files)
    for file in several:
        if len(several) > 1:
            total.update(str(file.relative_to(base)).encode() + b"\0")
        with file.open("rb") as stream:
            while block := stream.read(BLOCK):
                total.update(block)
    return total.hexdigest()


def _inside(folder: Path) -> list[Path]:
    if is_bag(folder):
        return [folder]
    logs = []
    for entry in sorted(folder.iterdir()):
        if entry.name.startswith("."):
            continue
        if entry.is_dir():
            logs += _inside(entry)
        elif _looks_like_log(entry):
            logs.append(entry)
    return logs


def _looks_like_log(path: Path) -> bool:
    suffixes = [s.lower() for s in path.suffixes]
    if suffixes and suffixes[-1] in COMPRESSED:
        suffixes.pop()
    return bool(suffixes) and suffixes[-1] in (*SUFFIXES, *FOREIGN)


def _root(pattern: Path) -> Path:
    """The part of a pattern before its first wildcard."""
    fixed = []
    for part in pattern.parts:
        if any(sign in part for sign in "*?["):
            break
        fixed.append(part)
    return Path(*fixed)
