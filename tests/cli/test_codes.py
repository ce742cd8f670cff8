"""What the wrapper does with each way to end: exit code, one message, and where a traceback goes."""

import errno
import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator

import rovval.cli
from conftest import ROOT
from rovval.cli.app import app
from rovval.core.errors import BadInput, RovvalError, SimulationStopped, UsageProblem


@pytest.fixture
def ends_with(monkeypatch, capsys):
    """Run main() with a command that raises the given error; gives exit code and stderr."""

    def run(error: BaseException) -> tuple[int, str]:
        def fail(*args: object, **kwargs: object) -> None:
            raise error

        monkeypatch.setattr("rovval.cli.complete.known", fail)
        monkeypatch.setattr(sys, "argv", ["rovval", "list", "vehicle"])
        with pytest.raises(SystemExit) as left:
            rovval.cli.main()
        return int(left.value.code or 0), capsys.readouterr().err

    return run


@pytest.mark.parametrize(
    ("error", "code"),
    [
        (UsageProblem("no such thing", "take another"), 2),
        (BadInput("log.csv: no rows", "look"), 3),
        (SimulationStopped("ran off"), 4),
    ],
)
def test_refusals_keep_their_code_and_say_what_next(ends_with, error: RovvalError, code: int):
    left, err = ends_with(error)
    assert left == code
    assert err == f"rovval: {error}\n"


def test_blas_has_one_thread_unless_the_user_says_so():
    """The command line asks for it before numpy is there, and leaves alone what is set."""
    names = rovval.cli.BLAS_THREADS
    code = f"""import os, sys; import rovval.cli.app; assert 'numpy' not in sys.modules
sys.argv = ['rovval', 'list', 'vehicle']
try:
    rovval.cli.main()
except SystemExit:
    print(*(os.environ[n] for n in {names!r}))"""
    bare = {k: v for k, v in os.environ.items() if k not in names}
    for given, want in (({}, "1 1 1"), ({"OMP_NUM_THREADS": "3"}, "1 3 1")):
        done = subprocess.run([sys.executable, "-c", code], env=bare | given, capture_output=True, text=True, check=True)
        assert done.stdout.splitlines()[-1] == want


def test_interrupt_is_130(ends_with):
    assert ends_with(KeyboardInterrupt())[0] == 130


def test_internal_error_is_70_in_one_line_with_the_traceback_in_a_file(ends_with):
    """Exit 1 must never be a crash: it says that a tolerance is exceeded."""
    code, err = ends_with(ZeroDivisionError("a\nb"))
    assert code == 70
    assert err.startswith("rovval: internal error: ZeroDivisionError: a b\n")
    assert "Traceback" not in err
    found = re.search(r"report it with (\S+?),", err)
    assert found
    file = Path(found[1])
    assert "ZeroDivisionError" in file.read_text()
    file.unlink()


def test_debug_prints_the_traceback(ends_with, monkeypatch):
    monkeypatch.setenv("ROVVAL_DEBUG", "1")
    code, err = ends_with(BadInput("log.csv: no rows"))
    assert code == 3
    assert "Traceback" in err


def test_a_refused_path_is_named(ends_with, tmp_path):
    code, err = ends_with(PermissionError(13, "Permission denied", str(tmp_path / "out")))
    assert code == 2
    assert str(tmp_path / "out") in err


def test_a_result_that_cannot_be_printed_is_no_internal_error(ends_with):
    code, err = ends_with(OSError(errno.ENOSPC, os.strerror(errno.ENOSPC)))
    assert code == 2
    assert "free space" in err


def test_a_missing_library_of_an_extra_is_not_hidden_as_success(ends_with):
    assert ends_with(ImportError("x"))[0] == 70


def test_debug_flag_sets_the_environment(monkeypatch):
    from typer.testing import CliRunner

    monkeypatch.setenv("ROVVAL_DEBUG", "0")
    assert CliRunner().invoke(app, ["--debug", "list", "vehicle"]).exit_code == 0
    assert rovval.cli.debugging()


def test_ctrl_c_by_signal_is_130(tmp_path):
    """By a real signal to a real process, as a terminal sends it."""
    code = (
        "import sys, time\nimport rovval.cli, rovval.cli.complete as c\n"
        "def slow(*a, **k):\n    print('ready', flush=True)\n    time.sleep(30)\n"
        "c.known = slow\nsys.argv = ['rovval', 'list', 'vehicle']\nrovval.cli.main()"
    )
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
        time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=20)
    assert process.returncode == 130
    assert "Traceback" not in err


@pytest.mark.parametrize(
    ("args", "code", "kind", "said"),
    [
        (["show", "effect", "inflow_los", "--json"], 2, "UsageProblem", "did you mean inflow_loss"),
        (["compare", "nope.csv", "--json"], 3, "BadInput", "no such log file"),
        (["compare", "--json", "--nope"], 2, "UsageProblem", "--nope"),
        (["diagnose", "nope.csv", "--json", "-"], 3, "BadInput", "no such log file"),
    ],
)
def test_with_json_a_refusal_is_one_line_of_json(monkeypatch, capsys, tmp_path, args, code, kind, said):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", ["rovval", *args])
    with pytest.raises(SystemExit) as left:
        rovval.cli.main()
    shown = capsys.readouterr()
    document = json.loads(shown.err.splitlines()[-1])
    Draft202012Validator(json.loads((ROOT / "docs" / "schemas" / "error.json").read_text(encoding="utf-8"))).validate(document)
    assert (left.value.code, document["exit_code"], document["kind"], shown.out) == (code, code, kind, "")
    assert said in document["message"] + document["next"]


def test_with_json_success_still_ends_with_its_code(monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["rovval", "list", "vehicle", "--json"])
    with pytest.raises(SystemExit) as left:
        rovval.cli.main()
    assert left.value.code == 0 and "merlin" in json.loads(capsys.readouterr().out)
