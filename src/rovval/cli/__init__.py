"""The command line. Importing it loads typer and nothing heavy: every command imports what it needs when it runs."""

from __future__ import annotations

import errno
import os
import sys
import tempfile
import traceback
from pathlib import Path
from typing import NoReturn

from rovval.core.errors import RovvalError

INTERNAL = 70
CONFIGURATION, INPUT = 2, 3
BLAS_THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")


def main() -> NoReturn:
    """Run the command of ``sys.argv`` and leave with its exit code; no traceback reaches the user."""
    one_blas_thread()
    from rovval.cli.app import app

    try:
        app(prog_name="rovval")
    except RovvalError as error:
        leave(f"rovval: {error}", error.exit_code)
    except OSError as error:
        if error.filename is None:
            if error.errno in (errno.ENOSPC, errno.EDQUOT):
                leave(f"rovval: {error.strerror}\n  next: free space on the disk that the result goes to", CONFIGURATION)
            internal(error)
        leave(
            f"rovval: {os.fsdecode(error.filename)}: {error.strerror}\n  next: {_mend(error)}", _blame(error)
        )
    except Exception as error:
        internal(error)
    raise AssertionError("typer leaves by itself")


def one_blas_thread() -> None:
    """Keep BLAS to one thread unless the user set its number: it reads that once, when numpy is first imported."""
    # A diagnosis multiplies thousands of small matrices, over which threads mostly wait for one another. Measured on a 5-minute log, two
    # cores: 9.5 s of CPU and 12 s in all with one thread, 18.6 s and 22 s with two; on more cores up to five times the CPU.
    for name in BLAS_THREADS:
        os.environ.setdefault(name, "1")


def leave(message: str, code: int) -> NoReturn:
    """One message on stderr, then the exit code."""
    if debugging():
        traceback.print_exc()
    sys.stderr.write(message + "\n")
    raise SystemExit(code)


def internal(error: BaseException) -> NoReturn:
    """A fault of rovval itself: one line, the traceback in a file, exit 70."""
    if debugging():
        leave(f"rovval: internal error: {error}", INTERNAL)
    with tempfile.NamedTemporaryFile("w", prefix="rovval-traceback-", suffix=".txt", delete=False, encoding="utf-8") as file:
        file.write("".join(traceback.format_exception(error)))
    summary = " ".join(f"{type(error).__name__}: {error}".split())[:300]
    leave(
        f"rovval: internal error: {summary}\n  next: report it with {file.name}, or run again with `rovval --debug ...`",
        INTERNAL,
    )


def debugging() -> bool:
    """Whether `rovval --debug` (or ROVVAL_DEBUG=1) asked for tracebacks."""
    return os.environ.get("ROVVAL_DEBUG", "") not in ("", "0")


def _mend(error: OSError) -> str:
    """What to do next."""
    return "free space on its disk, or write elsewhere" if error.errno in (errno.ENOSPC, errno.EDQUOT) else "mend the path or its permissions"


def _blame(error: OSError) -> int:
    """A file that is there and cannot be read is bad input; everything else is where the user pointed rovval."""
    path = Path(os.fsdecode(error.filename))
    return INPUT if path.is_file() and not os.access(path, os.R_OK) else CONFIGURATION
