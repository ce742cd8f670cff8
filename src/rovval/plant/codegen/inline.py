"""An effect's function of the state, written into the kernel's text: arguments and locals renamed, constants put in.

Compiled one by one, forty small functions cost more time than the whole kernel. What is inlined must be straight: assignments
and one return, free of branches, which is also what lets LLVM turn the loop over lanes into vector instructions.
"""

from __future__ import annotations

import ast
import inspect
import textwrap
from collections.abc import Callable, Mapping
from typing import Any

from rovval.effects import arithmetic

HELPERS = {name: f"_{name}" for name in ("positive", "clip", "sqrt", "exp", "sin", "cos")}


def inline(function: Callable[..., Any], prefix: str, arguments: Mapping[str, str]) -> tuple[list[str], list[str]]:
    """Lines that compute the function's locals and the expressions that it returns, ``arguments`` giving each argument's text."""
    tree = ast.parse(textwrap.dedent(inspect.getsource(function))).body[0]
    assert isinstance(tree, ast.FunctionDef)
    where = f"{function.__module__}.{function.__name__}"
    statements = tree.body[1:] if ast.get_docstring(tree) else tree.body
    if not all(isinstance(s, ast.Assign) for s in statements[:-1]) or not isinstance(statements[-1], ast.Return):
        raise ValueError(f"{where}: only assignments and one return can be compiled into the kernel")
    local = {n.id for s in statements for n in ast.walk(s) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)}
    scope = inspect.unwrap(function).__globals__

    class Rename(ast.NodeTransformer):
        def visit_Name(self, node: ast.Name) -> ast.AST:
            name = node.id
            if name in local:
                return ast.Name(f"{prefix}_{name}", node.ctx)
            if name in arguments:
                return ast.parse(arguments[name], mode="eval").body
            if name in HELPERS and scope.get(name) is getattr(arithmetic, name):
                return ast.Name(HELPERS[name], node.ctx)
            if name == "abs":
                return node
            value = scope.get(name)
            if isinstance(value, (int, float)):
                return ast.Constant(float(value))
            raise ValueError(f"{where}: {name} is neither an argument, a number of the module nor a helper of effects.arithmetic")

    renamed = [Rename().visit(s) for s in statements]
    result = renamed[-1].value
    values = result.elts if isinstance(result, ast.Tuple) else [result]
    return [ast.unparse(s) for s in renamed[:-1]], [ast.unparse(v) for v in values]
