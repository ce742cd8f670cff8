"""Logs as Matlab workspaces, .mat: versions 4 to 7.2 through SciPy, 7.3 (which is HDF5) through h5py.

Variables are columns, fields of a structure (``log.nav.u``) those of the topic ``log.nav``, and what Simulink writes as "structure with time"
is a table of its signals under their labels. Objects (timeseries, timetable) are opaque outside of Matlab: they are named, with what to do.
"""

from __future__ import annotations

import zlib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from rovval.core.data import RawLog
from rovval.core.errors import BadInput
from rovval.core.progress import Progress, silent
from rovval.ingest.contents.block import Block
from rovval.ingest.files.watched_file import watched
from rovval.ingest.profile import Profile

SUFFIXES = (".mat",)
ALSO: tuple[str, ...] = ("csv_log",)
HDF5_SINCE = b"MATLAB 7.3 MAT-file"
OPAQUE = "a Matlab object; save what it holds as arrays, such as t = ts.Time; u = ts.Data;"


def sniff(path: Path) -> bool:
    """Whether the file begins as Matlab's do: a text that says so (5 and later), or the small integers of version 4."""
    with path.open("rb") as file:
        head = file.read(20)
    return head.startswith(b"MATLAB ") or (len(head) == 20 and np.frombuffer(head[:4], "<u4")[0] < 5000)  # MOPT, MAT-file format, version 4


def missing(path: Path, profile: Profile) -> tuple[str, ...]:
    """Required columns or structures of ``profile`` that the workspace has not, and `absent` ones that it has."""
    from rovval.ingest.assembly.topics import missing_in

    return missing_in({b.topic: (*b.numbers, *b.texts) for b in contents(path)}, profile)


def read(path: Path, profile: Profile, progress: Progress = silent) -> RawLog:
    """The log of ``path``. Raises `BadInput` naming everything that is missing, `UsageProblem` without h5py for version 7.3."""
    from rovval.ingest.assembly.topics import read_blocks

    return read_blocks(path, profile, contents(path, progress))


def contents(path: Path, progress: Progress = silent) -> Iterator[Block]:
    """A block for the variables, for each structure, and for each length of arrays among them."""
    from rovval.ingest.contents.nested_arrays import blocks_of

    with path.open("rb") as file:
        new = file.read(len(HDF5_SINCE)) == HDF5_SINCE
    yield from blocks_of(_plain(_of_hdf5(path, progress) if new else _of_scipy(path, progress)), {}, ".")


def _of_hdf5(path: Path, progress: Progress) -> dict[str, Any]:
    from rovval.ingest.contents.hdf5_arrays import nested, opened

    with opened(path) as file:
        return nested(file, matlab=True, progress=progress)[0]


def _of_scipy(path: Path, progress: Progress) -> dict[str, Any]:
    from scipy.io import loadmat
    from scipy.io.matlab import MatReadError

    try:
        with watched(path, "reading variables", progress) as file:
            found = loadmat(file, simplify_cells=True)
    except (MatReadError, ValueError, TypeError, KeyError, IndexError, OSError, OverflowError, MemoryError, EOFError, zlib.error) as error:
        said = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise BadInput(f"{path}: damaged or no Matlab file: {said}", "is the file whole?") from None
    return {name: value for name, value in found.items() if not name.startswith("__")}


def _plain(group: Mapping[str, Any]) -> dict[str, Any]:
    """The workspace as mappings of arrays alone: structures of structures, and Simulink's signals as a table."""
    from scipy.io.matlab import MatlabFunction, MatlabOpaque

    out: dict[str, Any] = {}
    for name, value in group.items():
        if isinstance(value, Mapping) and {"time", "signals"} <= set(value):
            out[name] = _simulink(value)
        elif isinstance(value, Mapping):
            out[name] = _plain(value)
        elif isinstance(value, (MatlabOpaque, MatlabFunction)):
            out[name] = OPAQUE
        elif isinstance(value, list) and all(isinstance(part, Mapping) for part in value):
            out |= {f"{name}[{i}]": _plain(part) for i, part in enumerate(value)}
        else:
            out[name] = value
    return out


def _simulink(structure: Mapping[str, Any]) -> dict[str, Any]:
    """Simulink's "structure with time": ``time``, and ``signals`` each with ``values`` and ``label``."""
    signals = structure["signals"]
    parts = [signals] if isinstance(signals, Mapping) else list(signals)
    named = {_label(part, i): part["values"] for i, part in enumerate(parts) if isinstance(part, Mapping) and "values" in part}
    return {"time": structure["time"], **named}


def _label(signal: Mapping[str, Any], number: int) -> str:
    label = signal.get("label")
    return label if isinstance(label, str) and label else f"signals[{number}]"  # an empty text is an empty array in the file
