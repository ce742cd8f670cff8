"""Where compiled kernels are kept, and what whoever waits for one is told."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import rovval


@pytest.mark.slow
def test_a_kernel_cache_that_cannot_be_written_is_no_hindrance(tmp_path):
    """And whoever waits for a compilation is told so on stderr."""
    code = "import plant_cases as c; from rovval.plant import Plant; print(c.run(Plant(c.merlin())).nu.shape)"
    blocked = tmp_path / "file"
    blocked.write_text("")
    environment = {**os.environ, "ROVVAL_CACHE": str(blocked / "below"), "PYTHONPATH": str(Path(__file__).parents[2] / "cases")}
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "(1, 11, 6)" and "compiling" in done.stderr
    assert "once for this machine" not in done.stderr and "ROVVAL_CACHE" in done.stderr


@pytest.mark.slow
def test_a_damaged_kernel_cache_is_compiled_anew(tmp_path):
    """Every log of a batch was set aside, night after night."""
    code = "import plant_cases as c; from rovval.plant import Plant; print(c.run(Plant(c.merlin())).nu.sum())"
    paths = os.pathsep.join([str(Path(__file__).parents[2] / "cases"), os.environ.get("PYTHONPATH", "")])
    environment = {**os.environ, "ROVVAL_CACHE": str(tmp_path), "PYTHONPATH": paths}

    def run() -> tuple[str, bool]:
        done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True)
        return done.stdout, "compiling" in done.stderr

    first, compiled = run()
    assert compiled and run() == (first, False)
    for file in [*tmp_path.glob("*.py"), *tmp_path.glob("__pycache__/*.pyc")]:
        file.write_bytes(file.read_bytes()[:200])
    assert run()[0] == first
    for file in tmp_path.glob("__pycache__/*.nb[ic]"):
        content = file.read_bytes()
        file.write_bytes(content[: len(content) // 2] + bytes(9) + content[len(content) // 2 + 9 :])
    assert run() == (first, True)
    assert run() == (first, False)


@pytest.mark.slow
def test_a_source_is_written_once_and_anew_where_what_it_is_written_from_has_changed(tmp_path):
    """Writing it takes a second of every command's time."""
    package = tmp_path / "package"
    shutil.copytree(Path(rovval.__file__).parent, package / "rovval", ignore=shutil.ignore_patterns("__pycache__"))
    code = "import plant_cases as c; from rovval.plant import Plant; from rovval.plant.codegen import text; c.run(Plant(c.merlin())); "
    code += "print(text.render.cache_info().misses)"
    paths = os.pathsep.join([str(package), str(Path(__file__).parents[2] / "cases")])
    environment = {**os.environ, "ROVVAL_CACHE": str(tmp_path / "cache"), "PYTHONPATH": paths}

    def run() -> tuple[str, bool]:
        done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True)
        return done.stdout.strip(), "compiling" in done.stderr

    assert run() == ("1", True) and run() == ("0", False)
    kernel = package / "rovval" / "plant" / "codegen" / "kernel" / "thrust.py"
    kernel.write_text(f"{kernel.read_text(encoding='utf-8')}# a remark\n", encoding="utf-8")
    assert run() == ("1", False) and run() == ("0", False)  # the same source, of changed files


@pytest.mark.slow
def test_of_two_processes_that_need_a_kernel_one_compiles_it(tmp_path):
    code = "import plant_cases as c; from rovval.plant import Plant; print(c.run(Plant(c.merlin())).nu.sum())"
    paths = os.pathsep.join([str(Path(__file__).parents[2] / "cases"), os.environ.get("PYTHONPATH", "")])
    environment = {**os.environ, "ROVVAL_CACHE": str(tmp_path), "PYTHONPATH": paths}
    both = [subprocess.Popen([sys.executable, "-c", code], env=environment, stdout=-1, stderr=-1, text=True) for _ in range(2)]
    said = [one.communicate() for one in both]
    assert [one.returncode for one in both] == [0, 0] and said[0][0] == said[1][0]
    assert sorted("compiling" in stderr for _, stderr in said) == [False, True]
