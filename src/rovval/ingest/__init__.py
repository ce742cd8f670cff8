"""File -> `RawLog`. A reader is one file of ``formats``; it is imported when a log needs it.

A reader has ``SUFFIXES`` (lower case, with dot), ``sniff(path) -> bool``, ``missing(path, profile) -> tuple[str, ...]`` (what the
profile requires and the log has not), ``read(path, profile, progress) -> RawLog`` and ``contents(path, progress) -> Iterator[Block]`` (all that the log holds,
without a profile: for `rovval inspect` and `rovval profile propose`), and ``ALSO``, the formats whose profiles it reads beside its own: what
is a column of a CSV is one of a workbook, too. `rovval.ingest.assembly.topics` reads by profile whatever yields blocks. A source is one TOML file of
``profiles``.
"""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Protocol, cast

from rovval.core.channels import channel
from rovval.core.data import RawLog
from rovval.core.errors import BadInput, Finding, RovvalError, UsageProblem
from rovval.core.progress import Progress, silent
from rovval.ingest import formats
from rovval.ingest.contents.block import Block
from rovval.ingest.dive import read_dive
from rovval.ingest.files import compression, refuse_unusable, sha256
from rovval.ingest.files.compression import is_compressed
from rovval.ingest.files.dive_file import is_dive, load_dive, parts_of
from rovval.ingest.profile import Profile, load_profile, profiles

__all__ = ["Profile", "Reader", "formats_of", "implausible", "load_profile", "plain", "profiles", "read", "reader", "reader_of", "readers"]
OF_TEXT = ("csv_log", "json_lines", "nmea")  # readers of text: they read it compressed, too


class Reader(Protocol):
    """What a reader module offers."""

    SUFFIXES: tuple[str, ...]
    ALSO: tuple[str, ...]

    def sniff(self, path: Path) -> bool:
        """Whether the file can be of this format, from its first bytes."""
        ...

    def missing(self, path: Path, profile: Profile) -> tuple[str, ...]:
        """What ``profile`` requires and the file has not; () when the file is of this source."""
        ...

    def read(self, path: Path, profile: Profile, progress: Progress = silent) -> RawLog:
        """The log; raises `BadInput`. ``progress`` hears how much of the file is read, where that takes long."""
        ...

    def contents(self, path: Path, progress: Progress = silent) -> Iterator[Block]:
        """All that the file holds, without a profile, as logged: blocks in the order of the file, a topic's as often as it needs (so that
        memory stays bounded). `Block` says what stands in one, `rovval.ingest.contents.flatten.flat` and `Collector` make them of decoded
        messages. Damage is a finding of a block where something can be read, else `BadInput`."""
        ...


def readers() -> tuple[str, ...]:
    """Names of the readers, by looking at file names only."""
    return tuple(sorted(m.name for m in pkgutil.iter_modules(formats.__path__)))


def reader(name: str) -> Reader:
    """A reader by name; refuses one that does not exist (`UsageProblem`)."""
    if name not in readers():
        raise UsageProblem(f"unknown format {name!r}", f"use one of: {', '.join(readers())}")
    return cast(Reader, importlib.import_module(f"{formats.__name__}.{name}"))


def formats_of(path: Path) -> tuple[str, ...]:
    """The formats that a file may be of, by its name and first bytes. Raises `BadInput` for one of no known format."""
    able = tuple(name for name in readers() if _able(name, path))
    if not able:
        raise _of_no_format(path)
    return able


def read(path: Path, profile: str | None = None, timezone: str | None = None, progress: Progress = silent) -> RawLog:
    """The log of ``path`` in SI, forward-starboard-down and north-east-down, each channel at its own stamps.

    A dive file (``dive.toml``) is one log of all that it names. ``profile`` is a built-in name or a path to a TOML file; without it the one
    built-in profile is taken whose required columns or topics the log has, of several in other units the one that suits its values. ``timezone``
    (``Europe/Berlin``, ``+02:00``) is that of stamps that are date and time without a zone of their own; it goes before the profile's. Raises
    `BadInput` for a log that cannot be used or that fits none or several profiles, `UsageProblem` for a profile that does not exist or is wrong.
    """
    path = Path(path)
    refuse_unusable(path)
    if is_dive(path):
        return read_dive(path, partial(read, progress=progress), profile, timezone)
    with plain(path, progress) as (whole, lost):
        raw = _read(whole, profile, timezone, progress)
    return raw if whole == path else replace(raw, source=str(path), sha256=sha256(path), findings=(*lost, *raw.findings))


@contextmanager
def plain(path: Path, progress: Progress = silent) -> Iterator[tuple[Path, tuple[Finding, ...]]]:
    """The file that readers are given, and what is lost of it: a log as it is, a compressed one unpacked for as long as it is read. Readers of
    text unpack for themselves, while they read. Raises `BadInput` for a dive file, which is several logs."""
    if is_dive(path):
        names = ", ".join(str(file) for _, file in parts_of(path, load_dive(path)))
        raise BadInput(f"{path}: a dive of several files, each with a profile of its own", f"give one of them: {names}")
    of_text = {s for name in OF_TEXT for s in reader(name).SUFFIXES}
    if path.is_dir() or compression.suffix(path) in of_text:
        yield path, ()
        return
    with compression.unpacked(path, progress) as (whole, lost):
        yield whole, lost


def reader_of(path: Path, profile: Profile) -> Reader:
    """The reader that reads a log by ``profile``: of those that can read the file the profile's own first, as a CSV's profile reads a workbook, too.
    Raises `BadInput` for a folder that the profile's format is not."""
    able = [name for name in readers() if _able(name, path)]
    chosen = reader(next(iter(_of_profile(profile, able)), profile.format))
    if path.is_dir() and "" not in chosen.SUFFIXES:
        raise BadInput(f"{path}: a folder; profile {profile.name!r} reads single files ({profile.format})", "give one of the files in it")
    return chosen


def _read(path: Path, profile: str | None, timezone: str | None, progress: Progress) -> RawLog:
    chosen = (load_profile(profile) if profile is not None else _the_one_that_fits(path)).in_zone(timezone)
    return reader_of(path, chosen).read(path, chosen, progress)


def _the_one_that_fits(path: Path) -> Profile:
    able = formats_of(path)
    fits, near = [], []
    for candidate in (load_profile(name) for name in profiles()):
        if not (readers_of_it := _of_profile(candidate, able)):
            continue
        try:
            gone = reader(readers_of_it[0]).missing(path, candidate)
        except BadInput as error:
            raise BadInput(error.message, error.hint or "is the file whole?") from None
        if gone:
            shown = ", ".join(gone[:6]) + (", ..." if len(gone) > 6 else "")
            near.append(f"\n  - {candidate.name} misses {len(gone)}: {shown}")
        else:
            fits.append(candidate)
    if len(fits) > 1:
        unlikely = implausible(path, fits)
        fits = [p for p in fits if not unlikely[p.name]] or fits
    if len(fits) == 1:
        return fits[0]
    if fits:
        names = ", ".join(p.name for p in fits)
        raise BadInput(f"{path}: fits several profiles: {names}", "say which with --profile")
    hint = "give --profile: one of these, or a TOML file of your own"
    raise BadInput(f"{path}: fits no built-in profile" + "".join(near), hint)


def implausible(path: Path, fits: Sequence[Profile]) -> dict[str, tuple[str, ...]]:
    """Of several profiles that fit a log, by name, the channels that by their values cannot be what it says: one source may write radians in some logs and
    degrees in others. None of profiles that take each channel in one unit, which values cannot tell apart; for these the log is not read."""
    taken = {(name, source.unit) for p in fits for name, source in p.channels.items()}
    differ = len(taken) > len({name for name, _ in taken})
    return {p.name: _implausible(reader_of(path, p).read(path, p)) if differ else () for p in fits}


def _implausible(log: RawLog) -> tuple[str, ...]:
    rows = [(name, series.values, channel(name)) for name, series in log.channels.items() if series.mostly_outside(channel(name))]
    return tuple(f"{name} within {row.low:g} to {row.high:g} {row.unit} (holds {v.min():.4g} to {v.max():.4g})" for name, v, row in rows)


def _of_profile(profile: Profile, able: Sequence[str]) -> list[str]:
    """Of the readers that are able to read a file those that read such a profile, the profile's own first."""
    return sorted((name for name in able if profile.format in (name, *reader(name).ALSO)), key=lambda name: name != profile.format)


def _of_no_format(path: Path) -> BadInput:
    known = sorted({s for name in readers() for s in reader(name).SUFFIXES if s})
    if path.is_dir():
        hint = f"give one of the logs in it, or put all of them into the archive: `rovval ingest {path}`"
        return BadInput(f"{path}: of no known format: a folder that holds no bag", hint)
    if is_compressed(path) or path.suffix.lower() in known:
        said = f"its name ends in {path.suffix}, and it does not begin as such a file does"
        return BadInput(f"{path}: of no known format: {said}", "is the file whole, and is it what its name says?")
    return BadInput(f"{path}: of no known format (known: {', '.join(known)})", "give --profile if the file has an unusual name")


def _able(name: str, path: Path) -> bool:
    candidate = reader(name)
    if compression.suffix(path) not in candidate.SUFFIXES and not (path.is_dir() and "" in candidate.SUFFIXES):
        return False
    try:
        return candidate.sniff(path)
    except OSError as error:
        raise BadInput(f"{path}: cannot be read: {error}", "check the file") from None
    except RovvalError:
        return False
