"""Imports point down, and heavy libraries stand only in the rooms that need them. The table is the design's list of rooms."""

import ast
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parent.parent / "src" / "rovval"

# Top first: a room may import itself and what stands below it. Rooms on one line may not import each other.
ROOMS = (
    ("__main__",),
    ("__init__",),
    ("cli",),
    ("demo",),
    ("pipeline",),
    ("report",),
    ("blind", "fit"),
    ("diagnose",),
    ("fly",),
    ("comparison",),
    ("simulation",),
    ("plant",),
    ("effects",),
    ("vehicle",),
    ("storage",),
    ("alignment",),
    ("ingest",),
    ("core",),
)
# Third-party libraries and the rooms that may import them; numpy may be imported by every room that computes.
ALLOWED = {
    "typer": {"cli"},
    "pydantic": {"vehicle", "ingest", "pipeline"},
    "polars": {"ingest", "storage", "simulation", "report"},
    "rosbags": {"ingest"},
    "mcap": {"ingest"},
    "pymavlink": {"ingest"},
    "fastexcel": {"ingest"},
    "rerun": {"report"},
    "jinja2": {"report"},
    "markupsafe": {"report"},
    "numba": {"plant", "effects"},
    "llvmlite": {"plant"},
    "scipy": {"plant", "diagnose", "blind", "alignment", "report", "simulation"},
    "distributed": {"pipeline"},
    "fsspec": {"storage", "pipeline", "ingest"},
    "cryptography": {"blind"},
}
NO_NUMPY = {"cli", "pipeline"}
FILES = sorted(PACKAGE.rglob("*.py"))


def room_of(path: Path) -> str:
    return path.relative_to(PACKAGE).parts[0].removesuffix(".py")


def height(room: str) -> int:
    return next(len(ROOMS) - i for i, rooms in enumerate(ROOMS) if room in rooms)


def imported(path: Path) -> set[str]:
    """Full names of the modules that a file imports at any depth, those for type checking excepted."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    skipped = {id(child) for node in ast.walk(tree) if for_types(node) for child in ast.walk(node)}
    names: set[str] = set()
    for node in ast.walk(tree):
        if id(node) in skipped:
            continue
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: relative import at line {node.lineno}; write the full name"
            names |= {f"{node.module}.{alias.name}" for alias in node.names} if node.module == "rovval" else {node.module or ""}
    return names


def for_types(node: ast.AST) -> bool:
    return isinstance(node, ast.If) and isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"


def test_every_room_is_in_the_table():
    assert {room_of(f) for f in FILES} <= {room for rooms in ROOMS for room in rooms}


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_imports_point_down(path: Path):
    own = room_of(path)
    for name in imported(path):
        top, _, rest = name.partition(".")
        if top == "rovval" and rest and not rest.startswith("__"):
            other = rest.partition(".")[0]
            assert other == own or height(other) < height(own), f"{own} imports {other}, which does not stand below it"


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_heavy_libraries_stay_in_their_rooms(path: Path):
    own = room_of(path)
    tops = {name.partition(".")[0] for name in imported(path)}
    for library, rooms in ALLOWED.items():
        assert library not in tops or own in rooms, f"{own} imports {library}; only {', '.join(sorted(rooms))} may"


@pytest.mark.parametrize("path", [f for f in FILES if room_of(f) in NO_NUMPY], ids=lambda p: str(p.relative_to(PACKAGE)))
def test_light_rooms_load_no_numpy_when_imported(path: Path):
    """Inside a function is fine: it is loaded when the function runs."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    top_level = {a.name for node in tree.body if isinstance(node, ast.Import) for a in node.names}
    assert "numpy" not in top_level


def test_the_walk_sees_an_import_inside_a_function(tmp_path):
    """The rule would be empty if it saw only the top of a file: most imports of the command line are inside functions."""
    file = tmp_path / "x.py"
    file.write_text(
        "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    import polars\n"
        "def f():\n    from rovval import store\n    import numba.core\n    from rovval.cli.app import app\n"
    )
    assert imported(file) == {"typing", "rovval.storage.archive", "numba.core", "rovval.cli.app"}
