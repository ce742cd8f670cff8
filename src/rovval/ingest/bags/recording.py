"""A path as a user names a recording -> the containers that it is made of: one file, or a ROS 2 folder with its metadata.yaml."""

from __future__ import annotations

import shutil
import sqlite3
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from rovval.core.errors import BadInput, Finding
from rovval.ingest.bags import mcap_file, rosbag1, sqlite_file
from rovval.ingest.bags.block import Block, Connection, Container

SUFFIXES = (".bag", ".active", ".db3", ".mcap")  # a recorder calls a bag that it has not closed NAME.bag.active
ZSTANDARD = b"\x28\xb5\x2f\xfd"  # RFC 8878, 3.1.1: magic of a frame
MAGIC = (rosbag1.MAGIC[:12], sqlite_file.MAGIC, mcap_file.MAGIC)


@dataclass(frozen=True, slots=True)
class Recording:
    """``containers`` in order; ``packed`` says that each message is compressed (zstd) by itself."""

    containers: tuple[Container, ...]
    packed: bool = False

    def connections(self) -> list[Connection]:
        """Every connection of every container."""
        return [connection for container in self.containers for connection in container.connections()]

    def blocks(self, topics: frozenset[str]) -> Iterator[Block]:
        """The messages on ``topics``, many at a time."""
        for container in self.containers:
            for block in container.blocks(topics):
                yield _unpacked(block) if self.packed or _packed(block) else block

    @property
    def share(self) -> float:
        """The share of ``blocks`` that is through, 0 to 1."""
        return sum(container.share for container in self.containers) / len(self.containers)

    def foreign(self) -> dict[str, str]:
        """Topics whose messages are not serialised as ROS does, and how they are."""
        return {topic: how for container in self.containers for topic, how in container.foreign.items()}

    def findings(self) -> list[Finding]:
        """What is damaged, once ``blocks`` is through."""
        return [finding for container in self.containers for finding in container.findings]


def recording(path: Path, scratch: Path, found: list[Finding]) -> Recording:
    """The recording at ``path``; what had to be done to open it goes to ``found``, copies of damaged files to ``scratch``.

    Raises `BadInput` for a folder that is no recording and for a file that begins as none.
    """
    if path.is_file():
        return Recording((_container(path, scratch, found),))
    about = _metadata(path, found)
    files = [path / Path(str(name)).name for name in about.get("relative_file_paths", [])] or inside(path)
    if not about and len(files) != 1:
        names = ", ".join(p.name for p in files) or "none"
        hint = "give one of the files, or name those of one recording in a dive.toml (docs/formats.md)"
        raise BadInput(f"{path}: a folder without metadata.yaml and with {len(files)} bag files ({names})", hint)
    if gone := [file.name for file in files if not file.is_file()]:
        found.append(Finding("missing_part", path.name, f"metadata.yaml names {', '.join(gone)}, which the folder does not hold"))
    there = [_plain(file, scratch) for file in files if file.is_file()]
    if not there:
        raise BadInput(f"{path}: none of the files that metadata.yaml names is there", "copy the whole folder")
    packed = str(about.get("compression_mode", "")).lower() == "message"
    return Recording(tuple(_container(file, scratch, found) for file in there), packed)


def inside(folder: Path) -> list[Path]:
    """The files in ``folder`` that can be a ROS 2 bag."""
    return sorted(p for p in folder.iterdir() if p.suffix in (".db3", ".mcap"))


def _metadata(folder: Path, found: list[Finding]) -> dict[str, Any]:
    """What metadata.yaml says of the bag; {} where it is not there or damaged, since the files say the rest."""
    from ruamel.yaml import YAML
    from ruamel.yaml.error import YAMLError

    file = folder / "metadata.yaml"
    if not file.is_file():
        return {}
    try:
        about = YAML(typ="safe", pure=True).load(file.read_text(encoding="utf-8"))["rosbag2_bagfile_information"]
        if isinstance(about, dict) and isinstance(about.get("relative_file_paths"), list):
            return about
    except (YAMLError, UnicodeDecodeError, KeyError, TypeError, ValueError):
        pass
    found.append(Finding("damaged_file", file.name, "cannot be read; the bag is read without it"))
    return {}


def _plain(file: Path, scratch: Path) -> Path:
    """The file out of its zstd compression, where it is in one."""
    if file.suffix != ".zstd":
        return file
    import zstandard

    out = scratch / file.stem
    try:
        with file.open("rb") as packed, out.open("wb") as plain:
            zstandard.ZstdDecompressor().copy_stream(packed, plain)
    except zstandard.ZstdError as error:
        raise BadInput(f"{file}: damaged, while unpacking: {error}", "`zstd -d` may save a part of it") from None
    return out


def _container(file: Path, scratch: Path, found: list[Finding]) -> Container:
    with file.open("rb") as opened:
        head = opened.read(16)
    if head.startswith(rosbag1.MAGIC[:12]):
        return rosbag1.Rosbag1(file)
    if head.startswith(mcap_file.MAGIC):
        return mcap_file.Mcap(file)
    if head.startswith(sqlite_file.MAGIC):
        return sqlite_file.Sqlite(_of_whole_pages(_with_write_ahead_log(file, scratch, found), scratch))
    raise BadInput(f"{file}: does not begin as a bag does", "is the file whole, and is it what its name says?")


def _with_write_ahead_log(file: Path, scratch: Path, found: list[Finding]) -> Path:
    """The database with what a crashed recorder left in SQLite's write-ahead log put back into it, in a copy."""
    log = file.with_name(file.name + "-wal")
    if not log.is_file() or not log.stat().st_size:
        return file
    copy = scratch / file.name
    shutil.copy(file, copy)
    shutil.copy(log, scratch / log.name)
    database = sqlite3.connect(copy)
    database.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    database.close()
    found.append(Finding("write_ahead_log", file.name, "the recorder did not close the file; messages of its write-ahead log are included"))
    return copy


def _of_whole_pages(file: Path, scratch: Path) -> Path:
    """A database that is cut inside a page, in a copy without that page: SQLite would take what is missing of it for zeros."""
    size = sqlite_file.pages(file)[0]
    rest = file.stat().st_size % size
    if not rest:
        return file
    copy = scratch / file.name
    if copy != file:
        shutil.copy(file, copy)
    with copy.open("r+b") as opened:
        opened.truncate(file.stat().st_size // size * size)
    return copy


def _packed(block: Block) -> bool:
    """Whether messages are compressed one by one, as a file without its metadata.yaml does not say: none in CDR begins so."""
    first = int(block.start[0]) if len(block.start) else 0
    return block.connection.encoding == "cdr" and block.data[first : first + len(ZSTANDARD)].tobytes() == ZSTANDARD


def _unpacked(block: Block) -> Block:
    """The block with its messages out of their compression; one that is spoiled has no bytes, which no type fits."""
    import zstandard

    messages = []
    for start, size in zip(block.start.tolist(), block.size.tolist(), strict=True):
        try:
            messages.append(zstandard.ZstdDecompressor().decompress(block.data[start : start + size].tobytes()))
        except zstandard.ZstdError:
            messages.append(b"")
    size = np.array([len(message) for message in messages], dtype=np.int64)
    data = np.frombuffer(b"".join(messages), dtype=np.uint8)
    return Block(block.connection, block.record_ns, data, np.concatenate(([0], np.cumsum(size)[:-1])), size)
