"""The kernel's source is its typed functions, specialised: nothing of the insertion points is left, and what a plant lacks is not in it."""

from __future__ import annotations

import ast
import itertools

import plant_cases as cases
import pytest

from rovval.plant import Plant, parse_settings
from rovval.plant.codegen.kernel import symbols
from rovval.plant.codegen.layout import constants, layout
from rovval.plant.codegen.spec import BODY_NAMES, PER_THRUSTER, THRUSTER_NAMES, Spec, effect_rows, hooks, switches
from rovval.plant.codegen.specialise import Insertion, Specialiser
from rovval.plant.codegen.text import render
from rovval.plant.lowering import lower

SPECS = [Spec(k, *choice) for k, choice in itertools.product((1, 7), itertools.product((False, True), repeat=3))]
INSERTED = {name for name in vars(symbols) if name.isupper() or callable(getattr(symbols, name))}


def names(tree: ast.AST) -> set[str]:
    return {n.id for n in ast.walk(tree) if isinstance(n, ast.Name)}


@pytest.mark.parametrize("spec", SPECS, ids=lambda s: s.name)
def test_every_insertion_point_is_filled(spec):
    tree = ast.parse(render(spec))
    assert not names(tree) & INSERTED - {"OPTIONS"}
    assert [f.name for f in tree.body if isinstance(f, ast.FunctionDef)][-1] == "run"


@pytest.mark.parametrize("spec", SPECS, ids=lambda s: s.name)
def test_every_function_reads_only_what_it_sets_or_is_given(spec):
    """A branch that was folded away may not leave a name behind that another one reads."""
    tree = ast.parse(render(spec))
    known = {n.asname or n.name for node in tree.body if isinstance(node, (ast.Import, ast.ImportFrom)) for n in node.names}
    known |= {f.name for f in tree.body if isinstance(f, ast.FunctionDef)} | set(vars(__builtins__) if not isinstance(__builtins__, dict) else __builtins__)
    for function in (f for f in tree.body if isinstance(f, ast.FunctionDef)):
        own = {a.arg for a in function.args.args} | {n.id for n in ast.walk(function) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)}
        assert names(function) <= own | known


def test_every_constant_of_the_kernel_has_a_number():
    wanted = {name for name in vars(symbols) if name.isupper()}
    for spec in SPECS:
        assert set(constants(spec)) == wanted


def test_a_nominal_kernel_holds_no_effect_and_a_full_one_all():
    nominal, full = (render(Spec(7, False, False, full)) for full in (False, True))
    assert not any(f"{h.name}_{h.kind}_" in nominal for h in hooks(True))
    assert "acts[" not in nominal
    with_locals = [h for h in hooks(True) if h.function.__code__.co_nlocals > len(h.arguments)]
    assert with_locals and all(f"{h.name}_{h.kind}_" in full for h in with_locals)


def test_what_effects_ask_for_is_offered_by_name():
    for hook in hooks(True):
        offered = THRUSTER_NAMES if hook.kind in PER_THRUSTER else BODY_NAMES
        assert set(hook.arguments) <= {*offered, *effect_rows(hook.effect)[0]}


@pytest.mark.parametrize("spec", SPECS, ids=lambda s: s.name)
def test_no_two_numbers_of_a_lane_stand_in_one_place(spec):
    where, k = layout(spec), spec.thrusters
    each = [where.body_rows + i * where.stride + r for i in range(k) for r in where.thruster_first.values()]
    first = [*where.first.values()]
    assert len({*each, *first}) == len(each) + len(first) and max(each, default=0) < where.rows
    assert constants(spec)["ROWS"] > constants(spec)["STATE"] == where.rows


def specialised(source: str, **numbers: float) -> str:
    functions = {f.name: f for f in ast.parse(source).body if isinstance(f, ast.FunctionDef)}
    insertions: dict[str, Insertion] = {
        "turns": lambda call: ([], ast.Tuple([ast.Constant(i) for i in range(ast.literal_eval(call.args[0]))], ast.Load()))
    }
    whole = Specialiser(functions, numbers, insertions, frozenset({"main"})).function("main")
    return ast.unparse(ast.Module(whole.body[1:], []))


@pytest.mark.parametrize(
    ("source", "result"),
    [
        ("def main(x):\n    if WIDE and x:\n        return 1\n    return 2", "return 2"),
        ("def main(x):\n    y = x[3 * N + 1] + 0.5 * 2.0\n    return y", "y = x[13] + 0.5 * 2.0\nreturn y"),
        ("def main(x):\n    for i in turns(2):\n        x[i + N] += (x, 0.0)[i]\n    return x", "x[4] += x\nreturn x"),
        ("def main(x):\n    y = twice(x + 1)\n    return y\ndef twice(a):\n    return 2 * a", "y = 2 * (x + 1)\nreturn y"),
        ("def main(x):\n    y, z = pair(x)\n    return z\ndef pair(a):\n    y = a\n    z = -a\n    return y, z", "y = x\nz = -x\nreturn z"),
        ("def main(x):\n    for j in pruned(range(N)):\n        a = x\n        b = x\n        x[j] = b", "for j in range(4):\n    b = x\n    x[j] = b"),
    ],
    ids=["a branch that is not taken", "whole numbers alone are worked out", "a loop written out", "an expression written in", "results by name", "pruned"],
)
def test_what_is_known_is_put_in(source, result):
    assert specialised(source, WIDE=False, N=4) == result


def test_a_local_that_would_change_a_variable_of_the_caller_is_refused():
    with pytest.raises(ValueError, match="main: a are names of a function that is written into it"):
        specialised("def main(x):\n    a = 1\n    y = f(x)\n    return a + y\ndef f(x):\n    a = 2 * x\n    return a + 1")


@pytest.mark.parametrize(("setting", "wanted"), [("waves:cosine=0.5,direction=1", ["waves"]), ("waves:sine=0.5,cosine_3=0.2,period_3=9", ["waves", "waves_3"])])
def test_a_lane_has_the_components_that_it_gives_sizes_to(setting: str, wanted: list[str]):
    plant = Plant(cases.merlin())
    found = lower(plant.nominal, plant.slots, plant.index, plant.null, parse_settings(plant, [setting])[None])
    assert [name for name, column in switches().items() if found.acts[0, column]] == wanted
