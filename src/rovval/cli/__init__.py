"""The command line. Importing it loads typer and nothing heavy: every command imports what it needs when it runs."""

from __future__ import annotations

import errno
import json
import os
import sys
import tempfile
import traceback
from pathlib import Path
from typing import NoReturn

from rovval.core.errors import RovvalError

INTERNAL, INTERRUPTED = 70, 130
CONFIGURATION, INPUT = 2, 3
BLAS_THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")


def main() -> NoReturn:
    """Run the command of ``sys.argv`` and leave with its exit code; no traceback reaches the user."""
    one_blas_thread()
    import typer

    from rovval.cli.app import app
    from rovval.report.common.versions import made_by

    try:
        with made_by(sys.argv[1:]):
            code = app(prog_name="rovval", standalone_mode=not as_json())
    except RovvalError as error:
        leave(error.message, error.exit_code, error.hint, type(error).__name__)
    except OSError as error:
        if error.filename is None:
            if error.errno in (errno.ENOSPC, errno.EDQUOT):
                leave(str(error.strerror), CONFIGURATION, "free space on the disk that the result goes to", type(error).__name__)
            internal(error)
        leave(f"{os.fsdecode(error.filename)}: {error.strerror}", _blame(error), _mend(error), type(error).__name__)
    except typer.Abort:
        leave("interrupted", INTERRUPTED, "", "Interrupted")
    except Exception as error:
        if hasattr(error, "format_message"):  # typer's refusals of a command line
            leave(error.format_message(), CONFIGURATION, "`rovval COMMAND --help` has what it takes", "UsageProblem")
        internal(error)
    raise SystemExit(code if isinstance(code, int) else 0)


def as_json() -> bool:
    """Whether the command was asked for JSON: what it refuses is then JSON, too."""
    return any(word == "--json" or word.startswith("--json=") for word in sys.argv[1:])


def one_blas_thread() -> None:
    """Keep BLAS to one thread unless the user set its number: it reads that once, when numpy is first imported."""
    # A diagnosis multiplies thousands of small matrices, over which threads mostly wait for one another. Measured on a 5-minute log, two
    # cores: 9.5 s of CPU and 12 s in all with one thread, 18.6 s and 22 s with two; on more cores up to five times the CPU.
    for name in BLAS_THREADS:
        os.environ.setdefault(name, "1")


def leave(message: str, code: int, hint: str = "", kind: str = "") -> NoReturn:
    """One message on stderr, then the exit code; with --json the message is one line of JSON (docs/schemas/error.json)."""
    if debugging():
        traceback.print_exc()
    if as_json():
        document = {"schema": "rovval.error/1", "kind": kind, "message": message, "next": hint, "exit_code": code}
        sys.stderr.write(json.dumps(document) + "\n")
    else:
        from rovval.cli import output

        who, then = output.styled("rovval:", err=True, fg="red", bold=True), output.styled("next:", err=True, bold=True)
        sys.stderr.write(f"{who} {message}\n" + (f"  {then} {hint}\n" if hint else ""))
    raise SystemExit(code)


def internal(error: BaseException) -> NoReturn:
    """A fault of rovval itself: one line, the traceback in a file, exit 70."""
    if debugging():
        leave(f"internal error: {error}", INTERNAL, "", "InternalError")
    with tempfile.NamedTemporaryFile("w", prefix="rovval-traceback-", suffix=".txt", delete=False, encoding="utf-8") as file:
        file.write("".join(traceback.format_exception(error)))
    summary = " ".join(f"{type(error).__name__}: {error}".split())[:300]
    leave(f"internal error: {summary}", INTERNAL, f"report it with {file.name}, or run again with `rovval --debug ...`", "InternalError")


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
