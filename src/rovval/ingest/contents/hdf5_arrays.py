"""An HDF5 file as arrays nested by name, through h5py; Matlab's files of version 7.3 are such files, with every array transposed."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from rovval.core.errors import BadInput, UsageProblem
from rovval.core.progress import Progress, part_of, silent

MATLAB_CLASS = "MATLAB_class"  # attribute that says what an array was in Matlab
TEXT_CLASSES = (b"char", b"string")


@contextmanager
def opened(path: Path) -> Iterator[Any]:
    """The file by h5py. Raises `UsageProblem` without h5py, `BadInput` for a damaged file."""
    try:
        import h5py
    except ImportError:
        raise UsageProblem(f"{path}: an HDF5 file (Matlab's of version 7.3 is one) needs h5py", "pip install 'rovval[hdf5]'") from None
    try:
        with h5py.File(path, "r") as file:
            yield file
    except (OSError, RuntimeError, KeyError, TypeError, ValueError, AttributeError, OverflowError, MemoryError) as error:  # h5py, of damage
        said = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise BadInput(f"{path}: damaged or no HDF5: {said}", "is the file whole? was it closed by what wrote it?") from None


def nested(group: Any, matlab: bool = False, path: str = "", progress: Progress = silent) -> tuple[dict[str, Any], dict[str, str]]:
    """Mappings of arrays as the groups of the file, and path -> unit where an attribute ``units`` or ``unit`` states one.

    A compound array is a mapping of its fields. ``matlab``: arrays are turned, texts are decoded, a file's own bookkeeping is passed over."""
    import h5py

    arrays: dict[str, Any] = {}
    units: dict[str, str] = {}
    for number, (key, member) in enumerate(group.items()):
        progress("reading arrays", number / len(group))
        name = key if isinstance(key, str) else key.decode(errors="replace")  # h5py leaves a name that is no UTF-8 as bytes
        here = f"{path}{path and '/'}{name}"
        if matlab and name.startswith("#"):
            continue
        if isinstance(member, h5py.Group):
            arrays[name], inside = nested(member, matlab, here, part_of(progress, number, len(group)))
            units |= inside
        elif isinstance(member, h5py.Dataset):
            arrays[name] = _matlab_array(member) if matlab else _array(member)
            if stated := _unit(member):
                units[here] = stated
    return arrays, units


def _array(dataset: Any) -> Any:
    import h5py

    if dataset.dtype.names:
        return {field: np.asarray(dataset[field]) for field in dataset.dtype.names}
    if h5py.check_string_dtype(dataset.dtype) is not None:
        return np.asarray(dataset.asstr()[()], dtype=str)
    return np.asarray(dataset[()])


def _matlab_array(dataset: Any) -> Any:
    kind = dataset.attrs.get(MATLAB_CLASS, b"")
    if dataset.attrs.get("MATLAB_empty", 0):
        return np.empty(0)
    value = np.asarray(dataset[()])
    if kind in TEXT_CLASSES and value.dtype.kind == "u":
        return "".join(map(chr, value.ravel().tolist()))
    if value.dtype.kind == "O":
        return f"Matlab {kind.decode() if isinstance(kind, bytes) else kind}, by reference"
    return value.T.squeeze() if value.ndim else value


def _unit(dataset: Any) -> str:
    for name in ("units", "unit", "Units", "Unit"):
        value = dataset.attrs.get(name)
        if isinstance(value, (str, bytes)):
            return value.decode(errors="replace") if isinstance(value, bytes) else value
    return ""
