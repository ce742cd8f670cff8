"""Imports point down, between rooms and inside them, in no circle, and heavy libraries stand only in the rooms that need them.

The tables are the design's lists of rooms. Imports inside functions and those for type checking count: a lazy import hides no circle.
"""

import ast
from functools import cache
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
    ("report", "export"),
    ("blind",),
    ("fit", "trend"),
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
# The same inside a room; "" are the files that lie in the room itself.
INSIDE = {
    "diagnose": (
        ("",), ("result",), ("decision",), ("search",), ("hypotheses",), ("inference",), ("problem",), ("residuals",), ("windows",), ("criteria", "effort"),
    ),
    "blind": (("",), ("scoring",), ("sealed",), ("baselines", "cases"), ("second",), ("planted",), ("missions",), ("plant",)),
    "report": (("scenario",), ("",), ("recording",), ("batch", "blind", "diagnosis", "flight"), ("comparison",), ("common",), ("drawings",)),
    "effects": (("library",), ("",)),
    "pipeline": (("",), ("keeping",), ("execution",), ("planning",), ("steps", "tolerances")),
    "ingest": (
        ("documentation",), ("inspection",), ("",), ("formats",), ("autopilot",), ("assembly",), ("clocks",), ("contents",), ("table",),
        ("profile", "bags", "files"),
    ),
    "fit": (("",), ("bench", "calibration")),
    "plant": (("reference",), ("",), ("codegen",), ("platforms",)),
}
DEEPEST = 4  # files in the longest chain of imports inside a room of `diagnose`
MOST_FILES = 12  # in a room of `diagnose` or `pipeline`
# Third-party libraries and the rooms that may import them; numpy may be imported by every room that computes.
ALLOWED = {
    "typer": {"cli"},
    "pydantic": {"vehicle", "ingest", "pipeline", "diagnose", "fly"},
    "jinja2": {"report"},
    "polars": {"export", "ingest", "storage", "simulation", "report"},
    "rosbags": {"export", "ingest"},
    "mcap": {"export", "ingest"},
    "pymavlink": {"ingest"},
    "fastexcel": {"ingest"},
    "h5py": {"ingest"},
    "pyulog": {"ingest"},
    "pynmeagps": {"ingest"},
    "mcap_protobuf": {"ingest"},
    "zstandard": {"ingest"},
    "rerun": {"report"},
    "numba": {"plant", "effects"},
    "llvmlite": {"plant"},
    "scipy": {"ingest", "fit", "diagnose", "blind", "alignment", "report", "simulation", "comparison", "trend"},
    "distributed": {"pipeline"},
    "upath": {"storage"},
    "cryptography": {"blind"},
}
NO_NUMPY = {"cli", "pipeline", "__init__"}
FILES = sorted(PACKAGE.rglob("*.py"))


def module_of(path: Path) -> str:
    return ".".join(("rovval", *path.relative_to(PACKAGE).with_suffix("").parts)).removesuffix(".__init__")


MODULES = {module_of(path): path for path in FILES}


@cache
def imported(path: Path) -> frozenset[str]:
    """Full names that a file imports at any depth: modules of rovval as far as they are modules, others as written."""
    names: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: relative import at line {node.lineno}; write the full name"
            module = node.module or ""
            names |= {full if (full := f"{module}.{alias.name}") in MODULES else module for alias in node.names}
    return frozenset(names)


def own(path: Path) -> set[str]:
    """Modules of rovval that a file imports."""
    return {name for name in imported(path) if name in MODULES} - {module_of(path)}


def room_of(module: str) -> str:
    return [*module.split("."), "__init__"][1]


def inside(module: str) -> str:
    """The room inside the room; "" for a file that lies in the room itself."""
    parts = module.split(".")[2:]
    known = {name for names in INSIDE.get(room_of(module), ()) for name in names}
    return parts[0] if parts and parts[0] in known else ""


def height(name: str, table: tuple[tuple[str, ...], ...]) -> int:
    return next(len(table) - i for i, names in enumerate(table) if name in names)


def longest(module: str, room: set[str]) -> int:
    """Files in the longest chain of imports that begins at a module and stays in its room."""
    return 1 + max((longest(other, room - {module}) for other in own(MODULES[module]) & room - {module}), default=0)


def test_every_room_is_in_the_table():
    assert {room_of(module) for module in MODULES} == {room for rooms in ROOMS for room in rooms}


@pytest.mark.parametrize("module", MODULES)
def test_imports_point_down(module: str):
    room = room_of(module)
    for other in own(MODULES[module]):
        below = room_of(other)
        assert below == room or height(below, ROOMS) < height(room, ROOMS), f"{module} imports {other}, which does not stand below it"
        if below == room and room in INSIDE and inside(other) != inside(module):
            table = INSIDE[room]
            assert height(inside(other), table) < height(inside(module), table), f"{module} imports {other}, which does not stand below it"


def test_no_file_imports_itself_by_way_of_others():
    def reached(start: str) -> set[str]:
        found, left = set[str](), [start]
        while left:
            new = own(MODULES[left.pop()]) - found
            found |= new
            left += new
        return found

    assert [module for module in MODULES if module in reached(module)] == []


@pytest.mark.parametrize("room", [names[0] for names in INSIDE["diagnose"][1:-1]])
def test_a_room_of_the_diagnosis_is_small_and_flat(room: str):
    files = {module for module in MODULES if module.startswith(f"rovval.diagnose.{room}.")}
    assert 0 < len(files) <= MOST_FILES
    assert max(longest(module, files) for module in files) <= DEEPEST


@pytest.mark.parametrize("room", ["keeping", "execution", "planning"])
def test_a_room_of_the_batch_is_small(room: str):
    assert 0 < sum(module.startswith(f"rovval.pipeline.{room}.") for module in MODULES) <= MOST_FILES


@pytest.mark.parametrize("module", MODULES)
def test_heavy_libraries_stay_in_their_rooms(module: str):
    tops = {name.partition(".")[0] for name in imported(MODULES[module])}
    for library, rooms in ALLOWED.items():
        assert library not in tops or room_of(module) in rooms, f"{module} imports {library}; only {', '.join(sorted(rooms))} may"


@pytest.mark.parametrize("module", [module for module in MODULES if room_of(module) in NO_NUMPY])
def test_light_rooms_load_no_numpy_when_imported(module: str):
    """Inside a function is fine: it is loaded when the function runs."""
    tree = ast.parse(MODULES[module].read_text(encoding="utf-8"))
    assert "numpy" not in {a.name for node in tree.body if isinstance(node, ast.Import) for a in node.names}


def test_the_walk_sees_an_import_inside_a_function(tmp_path):
    """The rules would be empty if they saw only the top of a file: most imports of the command line are inside functions."""
    file = tmp_path / "x.py"
    file.write_text(
        "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    import polars\n"
        "def f():\n    from rovval.storage import archive\n    import numba.core\n    from rovval.cli.app import app\n"
    )
    assert imported(file) == {"typing", "polars", "rovval.storage.archive", "numba.core", "rovval.cli.app"}
