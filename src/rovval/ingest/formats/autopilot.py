"""ArduSub logs: DataFlash .BIN and MAVLink .tlog, by message type and field (``XKF1[0]`` is instance 0, which is the default).

Stamps: ``header`` is the autopilot's clock since it started (TimeUS, time_boot_ms), put on the ground station's time by the median
difference where a .tlog has both; ``record`` is when the ground station wrote.
"""

from __future__ import annotations

import contextlib
import io
import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from rovval.core.counts import counted
from rovval.core.data import Array, RawLog
from rovval.core.errors import BadInput, Finding, RovvalError, UsageProblem, all_at_once
from rovval.core.progress import Progress, silent
from rovval.ingest.autopilot.ardusub import other_frame, turned
from rovval.ingest.autopilot.packets import DATAFLASH, MAVLINK, STAMP, whole_packets
from rovval.ingest.clocks.clock import increasing_stamps
from rovval.ingest.contents.block import Block, Collector
from rovval.ingest.contents.flatten import flat
from rovval.ingest.files import sha256
from rovval.ingest.profile import ATTITUDE, Profile, Source

SUFFIXES = (".bin", ".tlog")
ALSO: tuple[str, ...] = ()  # formats whose profiles this reads beside its own
PARAMETER = {"PARM": ("Name", "Value"), "PARAM_VALUE": ("param_id", "param_value")}  # message type -> fields of name and value
TOLD_EVERY = 1_000  # packets between two words on how far it is
LOOKED_AT = 20_000  # messages looked at to say which types a log has


def sniff(path: Path) -> bool:
    """Whether the file begins as DataFlash or as a .tlog does."""
    with path.open("rb") as file:
        head = file.read(STAMP + 1)
    return head.startswith(DATAFLASH) or (len(head) > STAMP and head[STAMP] in MAVLINK)


def missing(path: Path, profile: Profile) -> tuple[str, ...]:
    """Required message types of ``profile`` that the beginning of the log has not."""
    seen: set[str] = set()
    parameters: dict[str, float] = {}
    with _opened(path) as (log, _):
        for _ in range(LOOKED_AT):
            message = log.recv_match()
            if message is None:
                break
            seen.add(message.get_type())
            _note_parameter(message, parameters)
    wanted = dict.fromkeys(_type(s)[0] for s in profile.channels.values() if not s.optional)
    frame = other_frame(profile, parameters)
    return (*(w for w in wanted if w not in seen), *(f"not {a}" for a in profile.absent if a in seen), *([frame] if frame else []))


def read(path: Path, profile: Profile, progress: Progress = silent) -> RawLog:
    """The log of ``path``. Raises `BadInput` naming every missing message and field, `UsageProblem` without pymavlink."""
    from rovval.ingest.assembly import Signal, build
    from rovval.ingest.assembly.markers import markers_of, not_there

    wanted: dict[tuple[str, str], _Messages] = {}
    for name, source in profile.channels.items():
        wanted.setdefault(_type(source), _Messages()).channels[name] = source
    parameters: dict[str, float] = {}
    notes = _Notes(profile)
    findings = _collect(path, wanted, profile, parameters, notes, progress)
    if frame := other_frame(profile, parameters):
        hint = "give the profile of that frame (`rovval list profile`): its motors are other thrusters"
        raise BadInput(f"{path}: profile {profile.name!r} reads {frame}", hint)
    gone = [_address(kind, i) for (kind, i), m in wanted.items() if not m.record and not all(s.optional for s in m.channels.values())]
    if gone:
        raise BadInput(all_at_once(gone, f"{path}: missing messages of profile {profile.name!r}"), "see `rovval show profile`, or give another")
    logged = {key: m for key, m in wanted.items() if m.record}
    lead = [r - b for m in logged.values() for r, b in zip(m.record, m.boot, strict=True) if np.isfinite(b)]
    offset = float(np.median(lead)) if lead else 0.0
    own = profile.time.kind == "header"
    stamps = {k: np.where(np.isfinite(m.boot), np.array(m.boot) + offset, m.record) if own else np.array(m.record) for k, m in logged.items()}
    t0 = min(float(s.min()) for s in stamps.values())
    signals: dict[str, Any] = {}
    for key, m in logged.items():
        try:
            rows, t, found = increasing_stamps(stamps[key] - t0, np.arange(1, len(m.record) + 1), key[0])
        except BadInput as error:
            findings.append(Finding("unusable_topic", key[0], error.message))
            continue
        findings += [Finding(f.code, key[0], f.detail.replace("line", "message").replace("row", "message")) for f in found]
        stamp = "header" if own and np.isfinite(m.boot).all() else "record"
        for name, source in m.channels.items():
            column: Array = np.array(m.columns[name], dtype=float)
            signals[name] = Signal(t, column[rows], stamp, source)
    t0_ns = round(t0 * 1e9) if t0 > 1e9 else None  # smaller: seconds since the autopilot started
    signals, told = turned(profile, signals, parameters)
    clock = np.where(np.isfinite(notes.boot), np.array(notes.boot) + offset, notes.record) if own else np.array(notes.record)
    markers = markers_of(profile, clock - t0, notes.texts)
    told += [not_there(profile)] if profile.markers and not markers else []
    facts = {"messages": ", ".join(k for k, _ in logged), **({"stamp_s_at_start": repr(t0)} if t0_ns is None else {})}
    return build(profile, signals.items(), path, sha256(path), t0_ns, [*findings, *told], facts, markers)


def contents(path: Path, progress: Progress = silent) -> Iterator[Block]:
    """Every message type (and instance) of the log with its fields; ``header`` is the autopilot's clock since its start.

    Raises `BadInput` for a damaged log, `UsageProblem` without pymavlink."""
    collector, bad, count = Collector(), 0, 0
    with _opened(path) as (log, lost):
        while (message := log.recv_match()) is not None:
            kind, count = message.get_type(), count + 1
            if count % TOLD_EVERY == 0:
                progress("reading packets", log.percent / 100.0)
            if kind == "BAD_DATA":
                bad += 1
                continue
            fields, left_out = flat({n: getattr(message, n) for n in message.get_fieldnames()})
            clocks = {"record": float(message._timestamp), "header": _boot(message)}
            if block := collector.add(_address(kind, _instance(message)), kind, clocks, fields, left_out):
                yield block
    yield from collector.rest()
    if lost or bad:
        yield Block("", findings=(*lost, *_bad(path, bad)))


def _bad(path: Path, count: int) -> list[Finding]:
    return [Finding("bad_packet", path.name, f"{counted(count, 'packet')} with a wrong CRC, or not what the type says; left out")] if count else []


@dataclass(slots=True)
class _Messages:
    """What is collected of one message type and instance: both clocks (s), and a column per channel."""

    channels: dict[str, Source] = field(default_factory=dict)
    boot: list[float] = field(default_factory=list)
    record: list[float] = field(default_factory=list)
    columns: dict[str, list[Any]] = field(default_factory=dict)


class _Notes:
    """What the message type of a profile's markers says, and when by both clocks (s)."""

    def __init__(self, profile: Profile) -> None:
        self.kind, self.field = (profile.markers.topic or "", profile.markers.field or "") if profile.markers else ("", "")
        self.boot: list[float] = []
        self.record: list[float] = []
        self.texts: list[str] = []

    def take(self, message: Any) -> None:
        """Append a message of that type."""
        self.boot.append(_boot(message))
        self.record.append(float(message._timestamp))
        self.texts.append(str(getattr(message, self.field, "")))


def _collect(
    path: Path, wanted: dict[tuple[str, str], _Messages], profile: Profile, parameters: dict[str, float], notes: _Notes,
    progress: Progress,
) -> list[Finding]:
    """Fill ``wanted``, ``parameters`` and ``notes`` from the log; returns what is damaged. Raises `BadInput` with every unknown field."""
    count, number = Counter[str](), 0
    wrong: dict[str, None] = {}
    types = [*{kind for kind, _ in wanted}, *PARAMETER, "BAD_DATA", *filter(None, [notes.kind])]
    with _opened(path) as (log, lost):
        while (message := log.recv_match(type=types)) is not None:
            kind = message.get_type()
            count[kind] += 1
            number += 1
            if number % TOLD_EVERY == 0:
                progress("reading packets", log.percent / 100.0)
            _note_parameter(message, parameters)
            if kind == notes.kind:
                notes.take(message)
            if (messages := wanted.get((kind, _instance(message)))) is None:
                continue
            values, unknown = _values(message, messages)
            wrong |= dict.fromkeys(f"{kind} has no number {f!r}" for f in unknown)
            if not unknown:
                messages.record.append(float(message._timestamp))
                messages.boot.append(_boot(message))
                for name, value in values.items():
                    messages.columns.setdefault(name, []).append(value)
    if wrong:
        raise BadInput(all_at_once(list(wrong), f"{path}: fields that profile {profile.name!r} names"), "mend the profile's field")
    return [*lost, *_bad(path, count["BAD_DATA"])]


def _note_parameter(message: Any, parameters: dict[str, float]) -> None:
    """Keep a parameter's value where the message is one."""
    if (fields := PARAMETER.get(message.get_type())) is not None:
        with contextlib.suppress(AttributeError, TypeError, ValueError):  # a damaged packet
            parameters[str(getattr(message, fields[0]))] = float(getattr(message, fields[1]))


def _values(message: Any, messages: _Messages) -> tuple[dict[str, Any], list[str]]:
    values, unknown = {}, []
    for name, source in messages.channels.items():
        fields = [f"{source.field}{i}" for i in (1, 2, 3, 4)] if name == ATTITUDE else [str(source.field)]
        try:
            found = [_number(message, f) for f in fields]
            values[name] = tuple(found) if name == ATTITUDE else found[0]
        except (AttributeError, IndexError, TypeError, ValueError):
            unknown.append(str(source.field))
    return values, unknown


def _number(message: Any, address: str) -> float:
    name, _, index = address.partition("[")
    value = getattr(message, name)
    return float(value[int(index.rstrip("]"))] if index else value)


def _type(source: Source) -> tuple[str, str]:
    """``XKF1[1]`` -> message type and instance; ``NAMED_VALUE_FLOAT[Lights1]`` for an instance that has a name."""
    found = re.fullmatch(r"(.*?)(?:\[(\w+)\])?", str(source.topic))
    return (found.group(1), found.group(2) or "0") if found else (str(source.topic), "0")


def _instance(message: Any) -> str:
    name = getattr(getattr(message, "fmt", None), "instance_field", None) or getattr(message, "_instance_field", None)
    return str(getattr(message, name, 0)) if name else "0"


def _address(kind: str, instance: str) -> str:
    return kind if instance == "0" else f"{kind}[{instance}]"


def _boot(message: Any) -> float:
    for name, unit in (("TimeUS", 1e-6), ("time_boot_ms", 1e-3), ("time_usec", 1e-6)):
        if (value := getattr(message, name, None)) is not None:
            return float(value) * unit
    return float("nan")


@contextlib.contextmanager
def _opened(path: Path) -> Iterator[tuple[Any, list[Finding]]]:
    """pymavlink's reader of the whole packets, and what is lost. It is silent: it prints of damage where results are printed."""
    try:
        from pymavlink import DFReader, mavutil
    except ImportError:
        raise UsageProblem(f"{path}: an autopilot log needs pymavlink", "pip install 'rovval[autopilot]'") from None
    log = None
    try:
        with whole_packets(path) as (whole, lost), contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            with whole.open("rb") as file:
                dataflash = file.read(2) == DATAFLASH
            kind = DFReader.DFReader_binary if dataflash else mavutil.mavlogfile
            log = kind.__new__(kind)  # in two steps: what fails in the second has a file open, and is closed below
            log.__init__(str(whole))
            yield log, lost
    except (RovvalError, KeyboardInterrupt):
        raise
    except Exception as error:
        said = str(error).splitlines()[0] if str(error) else ""
        raise BadInput(f"{path}: damaged or foreign: {type(error).__name__}: {said}", "is the file whole?") from None
    finally:
        for held in (getattr(log, name, None) for name in ("data_map", "filehandle", "f")):  # what the two kinds of reader have open
            if held is not None:
                with contextlib.suppress(BufferError):  # what a damaged log raised still looks at the map of the file, which goes with it
                    held.close()
