"""Nothing outside effects/ decides by the name of an effect: what the engine must know of one, the effect states itself."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

from rovval import effects

PACKAGE = Path(effects.__file__).parent.parent
# Rooms whose names are not the engine's: labels of the blind plant, readers of other tools' vehicles, the thesis's scenarios.
OTHERS = ("effects", "blind", "vehicle", "fly")
# Strings that hold a name and decide nothing by it.
JUSTIFIED = {
    "demo/__init__.py": {"inflow_loss:loss=0.3"},  # what is planted in the sample log
    "fit/calibration/unknowns.py": {  # numbers of a file, which effects that scale them are named after; and what a calibration writes into its [effects]
        "added_mass", "added_mass[", "linear_drag", "linear_drag[", "quadratic_drag", "quadratic_drag[", "attitude_bias", "dvl_lever_arm",
        "dvl_misalignment", "tether_drag", "thrust_lag",
    },
    "plant/platforms/freefloating.py": {"added_mass", "linear_drag"},  # keys of the vehicle's file, which the platform has no use for
    "plant/platforms/uuv.py": {"quadratic_drag"},  # the same, of which it takes the diagonal
}  # fmt: skip
FILES = sorted(p for p in PACKAGE.rglob("*.py") if p.relative_to(PACKAGE).parts[0] not in OTHERS)


def named(source: str) -> set[str]:
    """String constants of a source, docstrings and help texts excepted, that are or begin with the name of an effect."""
    tree = ast.parse(source)
    documented = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
    prose = {id(node.body[0].value) for node in ast.walk(tree) if isinstance(node, documented) and node.body and isinstance(node.body[0], ast.Expr)}
    pattern = re.compile(rf"\b({'|'.join(effects.names())})\b")
    constants = (n.value for n in ast.walk(tree) if isinstance(n, ast.Constant) and id(n) not in prose)
    strings = {value for value in constants if isinstance(value, str)}
    return {value for value in strings if pattern.search(value) and (" " not in value or pattern.match(value))}


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_no_file_decides_by_the_name_of_an_effect(path):
    found = named(path.read_text(encoding="utf-8")) - JUSTIFIED.get(str(path.relative_to(PACKAGE)), set())
    assert not found, f"{sorted(found)}: state what is asked as a property of the effect (rovval.effects.effect)"


def test_the_walk_sees_a_name_with_an_axis_and_in_a_list():
    source = '"""linear_drag"""\nX = ("waves", "other")\nif name == "linear_drag[surge]":\n    print("waves " "at sea")\nh = "help on added_mass and more"\n'
    assert named(source) == {"waves", "linear_drag[surge]", "waves at sea"}


def test_no_file_of_the_library_is_imported_outside():
    for path in FILES:
        assert "effects.library" not in path.read_text(encoding="utf-8"), path
