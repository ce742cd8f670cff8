"""An effect's function of the state, written into the kernel: arguments and locals renamed, constants put in.

Compiled one by one, forty small functions cost more time than the whole kernel. What is written in must be straight: assignments
and one return, free of branches, which is also what lets LLVM turn the loop over lanes into vector instructions.
"""

from __future__ import annotations

import ast
import copy
import inspect
import textwrap
from collections.abc import Callable, Mapping
from typing import Any

from rovval.effects import arithmetic

HELPERS = {name: f"_{name}" for name in ("positive", "clip", "sqrt", "exp", "sin", "cos")}  # of effects.arithmetic: their compiled twins in `runtime`


def inlined(function: Callable[..., Any], prefix: str, arguments: Mapping[str, ast.expr]) -> tuple[list[ast.stmt], list[ast.expr]]:
    """Statements that compute the function's locals, named ``prefix_local``, and the expressions that it returns; ``arguments`` is what stands for each
    argument.

    Raises:
        ValueError: the function has branches or loops, or a name that is neither an argument, a number of its module nor a helper.
    """
    tree = ast.parse(textwrap.dedent(inspect.getsource(function))).body[0]
    assert isinstance(tree, ast.FunctionDef)
    where = f"{function.__module__}.{function.__name__}"
    statements = tree.body[1:] if ast.get_docstring(tree) else tree.body
    *assignments, last = statements
    if not all(isinstance(s, ast.Assign) for s in assignments) or not isinstance(last, ast.Return) or last.value is None:
        raise ValueError(f"{where}: only assignments and one return can be compiled into the kernel")
    local = {n.id for s in statements for n in ast.walk(s) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)}
    scope = inspect.unwrap(function).__globals__

    class Rename(ast.NodeTransformer):
        def visit_Name(self, node: ast.Name) -> ast.AST:
            name = node.id
            if name in local:
                return ast.Name(f"{prefix}_{name}", node.ctx)
            if name in arguments:
                return copy.deepcopy(arguments[name])
            if name in HELPERS and scope.get(name) is getattr(arithmetic, name):
                return ast.Name(HELPERS[name], node.ctx)
            if name == "abs":
                return node
            value = scope.get(name)
            if isinstance(value, (int, float)):
                return ast.Constant(float(value))
            raise ValueError(f"{where}: {name} is neither an argument, a number of the module nor a helper of effects.arithmetic")

    before: list[ast.stmt] = [Rename().visit(s) for s in assignments]
    value = Rename().visit(last.value)
    return before, value.elts if isinstance(value, ast.Tuple) else [value]
