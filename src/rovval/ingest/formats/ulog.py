"""Logs of PX4, .ulg: each message is a topic (``vehicle_attitude``, a second instance ``vehicle_attitude[1]``), its stamps the autopilot's clock."""

from __future__ import annotations

import contextlib
import io
import mmap
import struct
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from rovval.core.counts import counted
from rovval.core.data import RawLog
from rovval.core.errors import BadInput, Finding, UsageProblem
from rovval.core.progress import Progress, silent
from rovval.ingest.contents.block import Block
from rovval.ingest.files.watched_file import watched
from rovval.ingest.profile import Profile

SUFFIXES = (".ulg", ".ulog")
ALSO: tuple[str, ...] = ()
MAGIC = b"ULog\x01\x12\x35"  # PX4 developer guide, ULog file format, header
HEADER = 16  # bytes before the first message
MESSAGE = struct.Struct("<HB")  # before each: its length, and its kind
STAMP = "timestamp"  # us since the autopilot started, in every message


def sniff(path: Path) -> bool:
    """Whether the file begins as a ULog does."""
    with path.open("rb") as file:
        return file.read(len(MAGIC)) == MAGIC


def missing(path: Path, profile: Profile) -> tuple[str, ...]:
    """Required messages of ``profile`` that the log has not, and `absent` ones that it has."""
    from rovval.ingest.assembly.topics import missing_in

    return missing_in({_topic(data): tuple(data.data) for data in _opened(path, _names(profile)).data_list}, profile)


def read(path: Path, profile: Profile, progress: Progress = silent) -> RawLog:
    """The log of ``path``. Raises `BadInput` naming everything that is missing, `UsageProblem` without pyulog."""
    from rovval.ingest.assembly.topics import read_blocks

    return read_blocks(path, profile, _blocks(path, _names(profile), progress))


def contents(path: Path, progress: Progress = silent) -> Iterator[Block]:
    """A block for each message (and instance). Raises `BadInput` for a damaged log, `UsageProblem` without pyulog."""
    return _blocks(path, None, progress)


def _blocks(path: Path, names: Sequence[str] | None, progress: Progress) -> Iterator[Block]:
    log = _opened(path, names, progress)
    facts = {name: str(value) for name, value in log.msg_info_dict.items() if name in ("sys_name", "ver_hw", "ver_sw", "sys_uuid")}
    findings = []
    if log.dropouts:
        lost = sum(d.duration for d in log.dropouts) * 1e-3  # ms
        findings.append(Finding("dropout", path.name, f"the autopilot could not write for {lost:.2f} s in all, {counted(len(log.dropouts), 'time')}"))
    if cut := _cut(path):
        to = f"to {log.last_timestamp * 1e-6:.1f} s of the autopilot's clock"
        findings.append(Finding("cut_file", path.name, f"{to}; the file ends in the middle of a message ({cut} bytes)"))
    if log.file_corruption:
        findings.append(Finding("damaged", path.name, "parts of the file are damaged; what could be read before and after them is"))
    yield Block("", facts=facts, findings=tuple(findings))
    for data in log.data_list:
        if STAMP not in data.data:
            yield Block("", findings=(Finding("damaged", _topic(data), "its messages have no timestamp by their definition; left out"),))
            continue
        stamps = np.asarray(data.data[STAMP], dtype=np.float64) * 1e-6
        numbers = {name: np.asarray(v, dtype=np.float64) for name, v in data.data.items() if name != STAMP and np.asarray(v).dtype.kind in "biuf"}
        yield Block(_topic(data), data.name, clocks={"header": stamps, "record": stamps}, numbers=numbers)


def _cut(path: Path) -> int:
    """How many bytes at the end of the file are no whole message; 0 of a file that ends with one."""
    with path.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as content:
        at, size = HEADER, len(content)
        while at + MESSAGE.size <= size:
            then = at + MESSAGE.size + MESSAGE.unpack_from(content, at)[0]
            if then > size:
                break
            at = then
        return size - at


def _topic(data: Any) -> str:
    return f"{data.name}[{data.multi_id}]" if data.multi_id else str(data.name)


def _names(profile: Profile) -> list[str] | None:
    """The messages that a profile asks for, without instances; None for all where it has patterns or columns."""
    topics = [t for s in profile.channels.values() for t in s.topics]
    return None if not topics or any("*" in t for t in topics) or profile.absent else sorted({t.partition("[")[0] for t in topics})


def _opened(path: Path, names: Sequence[str] | None, progress: Progress = silent) -> Any:
    try:
        from pyulog import ULog
        from pyulog.exceptions import ULogException
    except ImportError:
        raise UsageProblem(f"{path}: a log of PX4 needs pyulog", "pip install 'rovval[autopilot]'") from None
    try:
        with watched(path, "reading messages", progress) as file, contextlib.redirect_stdout(io.StringIO()):  # it prints of damage; a finding says it instead
            return ULog(file, names)
    except (ULogException, TypeError, ValueError, KeyError, IndexError, AttributeError, OSError, MemoryError, struct.error) as error:
        said = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise BadInput(f"{path}: damaged or no ULog: {said}", "is the file whole?") from None
