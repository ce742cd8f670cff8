"""Which files are logs: files and folders that the user named, or glob patterns."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from fnmatch import fnmatchcase
from functools import cache
from pathlib import Path

from rovval.core.errors import BadInput, all_at_once
from rovval.ingest.files.compression import suffix
from rovval.ingest.files.dive_file import files_of_dive, is_dive
from rovval.storage import places

SUFFIXES = (
    ".csv", ".tsv", ".txt", ".xlsx", ".xls", ".xlsm", ".xlsb", ".ods", ".parquet", ".pq", ".mat", ".h5", ".hdf5", ".hdf", ".he5",
    ".bag", ".db3", ".mcap", ".bin", ".tlog", ".ulg", ".ulog", ".jsonl", ".ndjson", ".nmea",
)  # fmt: skip
WILD = "*?["


def logs_in(sources: Sequence[str]) -> list[Path]:
    """Files as named; of a folder every file that looks like a log, readable or not, every ROS 2 bag folder as one log, and every dive file as one, in place of
    the files that it names.

    Raises:
        BadInput: a source does not exist, or there is no log in all of them.
    """
    if missing := [s for s in sources if not places.place(s).exists()]:
        raise BadInput(all_at_once([f"{s} does not exist" for s in missing], "source"), "mend the path")
    logs = [log for path in map(places.place, sources) for log in (_inside(path) if path.is_dir() else [path])]
    if not logs:
        raise BadInput(f"no log in {', '.join(sources)}", f"a folder is searched for {' '.join(SUFFIXES)} and bag folders")
    return logs


def matching(patterns: Sequence[str], base: Path) -> tuple[list[Path], dict[Path, str]]:
    """Logs that the glob patterns match, relative to ``base``, in the order of their names, each once; a bag folder is one log. And
    what matches and cannot be used, or a folder that cannot be looked into, each with the reason.

    ``**`` goes through every folder once, also where links lead back to it; as in a shell it passes hidden folders over.
    """
    unusable: dict[Path, str] = {}
    found = {path for pattern in patterns for path in _matched(pattern, base, unusable)}
    bags, files, holds_a_bag = set(), set(), cache(is_bag)
    for path in found:
        try:
            if bag := next((p for p, sure in ((path, is_bag), (path.parent, holds_a_bag)) if sure(p)), None):
                bags.add(bag)
            elif path.is_file() and not path.name.startswith(".") and path.suffix != ".md":
                files.add(path)
            elif path.is_symlink() and not path.exists():
                unusable[path] = "a link that leads nowhere"
        except OSError as error:
            unusable[path] = f"cannot be read: {error.strerror}"
    logs = bags | {p for p in files if not bags & set(p.parents)}
    unusable |= {p: "its name is not UTF-8" for p in logs if not _is_utf8(p)}
    return sorted(logs - set(unusable), key=lambda log: log.parts), unusable


def _matched(pattern: str, base: Path, unusable: dict[Path, str]) -> Iterable[Path]:
    root, parts = _rooted(pattern, base)
    if not places.is_remote(root):
        return _expanded(root, parts, unusable)
    below = fixed(pattern, base)
    rest = parts[len(below.parts) - len(root.parts) :]
    found = below.glob("/".join(rest)) if rest else [below]
    return [path for path in found if not any(part.startswith(".") for part in path.relative_to(below).parts)]


def absent(patterns: Sequence[str], base: Path) -> list[Path]:
    """The fixed parts of patterns (up to the first wildcard) that do not exist."""
    roots = [fixed(pattern, base) for pattern in patterns]
    return [root for root in roots if not root.exists()]


def fixed(pattern: str, base: Path) -> Path:
    """The part of a pattern before its first wildcard; all of it where it has none."""
    path, parts = _rooted(pattern, base)
    for part in parts:
        if any(sign in part for sign in WILD):
            break
        path /= part
    return path


def is_bag(path: Path) -> bool:
    """A ROS 2 bag is a folder with metadata.yaml."""
    return (path / "metadata.yaml").is_file()


def _inside(folder: Path) -> list[Path]:
    if is_bag(folder):
        return [folder]
    entries = sorted(folder.iterdir())
    dives = [entry for entry in entries if is_dive(entry)]
    within = {part.resolve() for dive in dives for part in files_of_dive(dive)}  # logs of a dive are no logs of their own
    logs = list(dives)
    for entry in entries:
        if entry.name.startswith(".") or entry.resolve() in within:
            continue
        if entry.is_dir():
            logs += _inside(entry)
        elif _looks_like_log(entry):
            logs.append(entry)
    return logs


def _looks_like_log(path: Path) -> bool:
    return suffix(path) in SUFFIXES


def _rooted(pattern: str, base: Path) -> tuple[Path, tuple[str, ...]]:
    """Where a pattern begins (the folder of the pipeline's file, the root of the disk, a bucket), and its parts from there."""
    if url := places.URL.match(pattern):
        bucket, *parts = pattern[url.end() :].split("/")
        return places.place(url[0] + bucket), tuple(filter(None, parts))
    anchor = Path(pattern).anchor
    return Path(anchor or base), tuple(part for part in Path(pattern).parts if part != anchor)


def _expanded(folder: Path, parts: Sequence[str], unusable: dict[Path, str]) -> Iterator[Path]:
    """What the rest of a pattern matches below ``folder``."""
    if not parts:
        yield folder
        return
    part, rest = parts[0], parts[1:]
    if part == "**":
        for inside in _folders(folder, unusable):
            yield from _expanded(inside, rest or ("*",), unusable)
    elif any(sign in part for sign in WILD):
        for entry in _entries(folder, unusable):
            if fnmatchcase(entry.name, part) and (part.startswith(".") or not entry.name.startswith(".")):
                yield from _expanded(folder / entry.name, rest, unusable)
    elif os.path.lexists(folder / part):
        yield from _expanded(folder / part, rest, unusable)


def _folders(top: Path, unusable: dict[Path, str]) -> Iterator[Path]:
    """``top`` and every folder below it, each once, however many links lead to it: real ones first, under their own names."""
    seen: set[tuple[int, int]] = set()
    real, linked = deque([top]), deque[Path]()
    while real or linked:
        folder = real.popleft() if real else linked.popleft()
        with suppress(OSError):
            status = folder.stat()
            if (status.st_dev, status.st_ino) in seen:
                continue
            seen.add((status.st_dev, status.st_ino))
        yield folder
        for entry in _entries(folder, unusable):
            with suppress(OSError):
                if entry.is_dir() and not entry.name.startswith("."):
                    (linked if entry.is_symlink() else real).append(folder / entry.name)


def _entries(folder: Path, unusable: dict[Path, str]) -> list[os.DirEntry[str]]:
    """What lies in a folder, by name; what is no folder holds nothing."""
    try:
        with os.scandir(folder) as entries:
            return sorted(entries, key=lambda entry: entry.name)
    except (FileNotFoundError, NotADirectoryError):
        return []
    except OSError as error:
        unusable[folder] = f"cannot be looked into: {error.strerror}"
        return []


def _is_utf8(path: Path) -> bool:
    try:
        str(path).encode()
    except UnicodeEncodeError:
        return False
    return True


