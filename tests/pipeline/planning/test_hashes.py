"""The hash of the code that made a result: it changes with what computes it, and with nothing else."""

import shutil
import subprocess
import sys
from pathlib import Path

import rovval

PACKAGE = Path(rovval.__file__).parent
EDIT = """
import sys
from pathlib import Path
from rovval.pipeline.planning.hashes import code_on_disk
print(code_on_disk())
for name in sys.argv[1:]:
    file = Path(name)
    text = file.read_text()
    file.write_text(text + "# another line\\n")
    print(code_on_disk())
    file.write_text(text)
"""


def test_a_result_is_made_by_what_computes_it_and_not_by_what_only_shows_it(tmp_path):
    """Not the command line, the blind check or scenarios; vehicles and profiles count by their own content."""
    shutil.copytree(PACKAGE, tmp_path / "rovval", ignore=shutil.ignore_patterns("__pycache__"))
    idle = [next((tmp_path / "rovval" / room).rglob("*.py")) for room in ("blind", "cli", "demo", "fly")] + [tmp_path / "rovval/vehicle/library/merlin.toml"]
    computing = [tmp_path / "rovval" / name for name in ("core/frames.py", "plant/model.py", "diagnose/pipeline.py", "report/__init__.py")]
    command = [sys.executable, "-c", EDIT, *map(str, idle + computing)]
    done = subprocess.run(command, env={"PYTHONPATH": str(tmp_path)}, capture_output=True, text=True, check=True)
    first, *others = done.stdout.split()
    assert others[: len(idle)] == [first] * len(idle)
    assert first not in others[len(idle) :] and len(set(others[len(idle) :])) == len(computing)
