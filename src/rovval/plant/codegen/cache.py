"""The compiled kernel of a `Spec`: written to a cache folder under the hash of all that it is made of, imported, run by threads.

Threads share the blocks through a plain pool and the kernel gives up Python's lock. numba's own parallel loops would compile
slower, share one cache entry between a serial and a parallel version, and break worker processes that are forked (OpenMP).
"""

from __future__ import annotations

import atexit
import hashlib
import importlib.util
import os
import shutil
import sys
import tempfile
import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, suppress
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

from rovval.core.errors import UsageProblem
from rovval.plant.codegen.spec import Spec
from rovval.plant.codegen.text import render
from rovval.storage import lock

ROOT = Path(__file__).parent
PACKAGE = ROOT.parents[1]
WRITTEN_FROM = ("core", "effects", "plant")  # packages that the source of a kernel is made of
WORTH_A_THREAD = 2_000  # steps of a block, some 5 ms: a thread costs a tenth of a millisecond


def cache_folder() -> Path:
    """Where kernels are kept: ROVVAL_CACHE, else the user's cache folder, else a folder of this process alone."""
    return _lasting_folder() or _own_folder()


def _lasting_folder() -> Path | None:
    """The folder that the next run finds again, or None where it cannot be written."""
    wanted = Path(os.environ.get("ROVVAL_CACHE") or Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "rovval")
    try:
        wanted.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=wanted):
            return wanted
    except OSError:
        return None


@cache
def _own_folder() -> Path:
    folder = Path(tempfile.mkdtemp(prefix="rovval-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return folder


@cache
def _name(spec: Spec) -> str:
    """Name of the kernel, by the hash of all that its machine code depends on: its source with every effect in it, helpers, versions. The source is in the
    cache folder under that name.

    To write it takes a second or two: where the files that it is written from are the same it is the one that was written before.
    """
    folder, entry = cache_folder(), cache_folder() / f"{_written_from(spec)}.name"
    with suppress(OSError, UnicodeDecodeError):
        known = entry.read_text(encoding="utf-8")
        if known == _named(spec, (folder / f"{known}.py").read_text(encoding="utf-8")):
            return known
    text = render(spec)
    name = _named(spec, text)
    _write(folder / f"{name}.py", text)
    _write(entry, name)
    return name


def _named(spec: Spec, text: str) -> str:
    """Name of the kernel of that source."""
    import numba

    digest = hashlib.sha256(f"{numba.__version__} {sys.version}\n{text}".encode())
    digest.update((ROOT / "runtime.py").read_bytes())
    return f"kernel_{spec.name}_{digest.hexdigest()[:16]}"


def _written_from(spec: Spec) -> str:
    """Hash of all that the source is written from: the files of the packages that it is made of, and Python, which writes it."""
    digest = hashlib.sha256(f"{spec} {sys.version}".encode())
    for file in sorted(path for package in WRITTEN_FROM for path in (PACKAGE / package).rglob("*.py")):
        digest.update(f"\n{file.relative_to(PACKAGE).as_posix()}\n".encode())
        digest.update(file.read_bytes())
    return f"source_{spec.name}_{digest.hexdigest()[:16]}"


@cache
def module(spec: Spec) -> ModuleType:
    """The generated module of that spec, compiled or from the cache; says so when compilation takes longer than a second."""
    name = _name(spec)
    path = cache_folder() / f"{name}.py"
    try:
        return _imported(name, path)
    except Exception:  # the file is as it must be: its bytecode is damaged
        Path(importlib.util.cache_from_source(str(path))).unlink(missing_ok=True)
        return _imported(name, path)


def _imported(name: str, path: Path) -> ModuleType:
    description = importlib.util.spec_from_file_location(name, path)
    assert description is not None and description.loader is not None
    loaded = importlib.util.module_from_spec(description)
    sys.modules[name] = loaded
    description.loader.exec_module(loaded)
    return loaded


def _write(path: Path, content: str) -> None:
    """Beside its place and renamed into it: several processes may do this at once."""
    handle, temporary = tempfile.mkstemp(dir=path.parent, suffix=".tmp")
    with os.fdopen(handle, "w", encoding="utf-8") as file:
        file.write(content)
    Path(temporary).replace(path)


def threads() -> int:
    """Threads of one call: ROVVAL_THREADS, else the processors that this process may use."""
    if wanted := os.environ.get("ROVVAL_THREADS"):
        return max(1, int(wanted))
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else (os.cpu_count() or 1)


_compiled: set[str] = set()


def run(spec: Spec, blocks: int, steps: int, arguments: tuple[Any, ...]) -> None:
    """Run the kernel over all blocks, ``steps`` of integration each; ``arguments`` are those of `rovval.plant.codegen.kernel.run` after ``first, last``."""
    function = module(spec).run
    if spec.name not in _compiled:
        _compile(function, spec, arguments)
    workers = min(threads(), blocks, blocks * steps // WORTH_A_THREAD)
    if workers <= 1:
        function(0, blocks, *arguments)
        return
    size = max(1, blocks // (workers * 4))
    pieces = [(b, min(b + size, blocks)) for b in range(0, blocks, size)]
    with ThreadPoolExecutor(workers) as pool:
        for future in [pool.submit(function, first, last, *arguments) for first, last in pieces]:
            future.result()


def _compile(function: Any, spec: Spec, arguments: tuple[Any, ...]) -> None:
    """Compile (or load) by a call over no block at all. Of several processes that need the kernel one compiles it, and the others wait and load it."""
    name = _name(spec)
    if _intact(name):
        function(0, 0, *arguments)
    else:
        with _alone(name):
            if _intact(name):  # another process has made it meanwhile
                function(0, 0, *arguments)
            else:
                _compile_anew(function, spec, arguments)
    _compiled.add(spec.name)


def _compile_anew(function: Any, spec: Spec, arguments: tuple[Any, ...]) -> None:
    """Compile, what is there and damaged removed first, for it would be run; with a word on stderr, since it takes a while."""
    name, start = _name(spec), time.monotonic()
    for file in _machine_code(name):
        file.unlink(missing_ok=True)
    often = "once for this machine" if _lasting_folder() else "in every run, for want of a folder to keep it: name one in ROVVAL_CACHE"
    print(f"rovval: compiling the {spec.name} plant, {often} (some seconds) ...", file=sys.stderr, flush=True)  # noqa: T201
    function(0, 0, *arguments)
    _write(_seal(name), _digest(_machine_code(name)))
    print(f"rovval: compiled in {time.monotonic() - start:.1f} s", file=sys.stderr, flush=True)  # noqa: T201


def _alone(name: str) -> ExitStack:
    """Nobody else compiles that kernel meanwhile; where files cannot be locked each process does for itself."""
    stack = ExitStack()
    with suppress(OSError, UsageProblem):
        stack.enter_context(lock.held(cache_folder() / f"{name}.lock", wait=True))
    return stack


def _intact(name: str) -> bool:
    """Whether there is machine code of that kernel as its seal says it was written."""
    code, seal = _machine_code(name), _seal(name)
    return bool(code) and seal.is_file() and seal.read_bytes() == _digest(code).encode()


def _machine_code(name: str) -> list[Path]:
    """numba's files of that kernel: of each function an index and what it leads to."""
    return sorted(cache_folder().glob(f"__pycache__/{name}.*.nb[ic]"))


def _seal(name: str) -> Path:
    return cache_folder() / f"{name}.sha256"


def _digest(files: Sequence[Path]) -> str:
    digest = hashlib.sha256()
    for file in files:
        with suppress(FileNotFoundError):  # another process compiles, too, where files cannot be locked
            digest.update(file.read_bytes())
    return digest.hexdigest()
