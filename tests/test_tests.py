"""The tests themselves: they stand where what they test stands, reach for public names alone, and can fail."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

HERE = Path(__file__).parent
PACKAGE = HERE.parent / "src" / "rovval"
NO_ROOM = {"cases", "docs", "faults", "real", "other_simulators", "benchmarks"}  # helpers, the README, kills and full disks, logs by others, timings
FILES = sorted(HERE.rglob("*.py"))
THEIR_OWN = {"_get_module_for_linking", "_exit", "_repr_html_"}  # numba's, the operating system's and IPython's only name for it


def name_of(path: Path) -> str:
    return path.relative_to(HERE).as_posix()


def private(name: str) -> bool:
    return name.startswith("_") and not name.startswith("__") and name not in THEIR_OWN


def reached_for(tree: ast.AST) -> Iterator[str]:
    """Private names that a file imports, reads off something, or replaces by a string such as `rovval.room.file._name`."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("rovval"):
            yield from (f"{node.module}.{a.name}" for a in node.names if any(map(private, (*(node.module or "").split("."), a.name))))
        elif isinstance(node, ast.Attribute) and private(node.attr):
            yield node.attr
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and re.fullmatch(r"rovval(\.\w+)+", node.value):
            yield from filter(private, node.value.split("."))


def asserts(function: ast.FunctionDef, others: dict[str, ast.FunctionDef], seen: frozenset[str] = frozenset()) -> bool:
    """Whether a function holds something that can fail: an assert, `raises`, one of NumPy's, or a function of the file that does."""
    for node in ast.walk(function):
        if isinstance(node, ast.Assert):
            return True
        if isinstance(node, ast.Call):
            called = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
            if called == "raises" or called.startswith(("assert_", "check_")):
                return True
            if called in others and called not in seen and asserts(others[called], others, seen | {called}):
                return True
    return False


def test_every_folder_is_a_room():
    folders = {path.parent.relative_to(HERE) for path in FILES if path.parent != HERE}
    strangers = {f.as_posix() for f in folders if f.parts[0] not in NO_ROOM and not (PACKAGE / f).is_dir()}
    assert not strangers


@pytest.mark.parametrize("path", FILES, ids=name_of)
def test_only_public_names_are_reached_for(path: Path):
    found = sorted(set(reached_for(ast.parse(path.read_text(encoding="utf-8")))))
    assert found == []


@pytest.mark.parametrize("path", [f for f in FILES if f.name.startswith("test_")], ids=name_of)
def test_every_test_can_fail(path: Path):
    functions = {n.name: n for n in ast.walk(ast.parse(path.read_text(encoding="utf-8"))) if isinstance(n, ast.FunctionDef)}
    idle = [name for name, function in functions.items() if name.startswith("test_") and not asserts(function, functions)]
    assert idle == []


def test_the_rules_see_what_they_forbid():
    """A rule that finds nothing anywhere would hold as well."""
    text = "from rovval.a import _b\nfrom rovval._c import d\nx._e\nx.__class__\nset('rovval.' 'f._g', 1)\nimport numpy._h\nfrom numpy import _i\n"
    assert set(reached_for(ast.parse(text))) == {f"rovval.{name}" for name in ("a._b", "_c.d")} | {"_e", "_g"}
    functions = {n.name: n for n in ast.parse("def f():\n    g()\ndef g():\n    assert 1\ndef h():\n    f\n").body if isinstance(n, ast.FunctionDef)}
    assert [asserts(function, functions) for function in functions.values()] == [True, True, False]
