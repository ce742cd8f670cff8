"""Partial evaluation of the kernel's typed functions (`rovval.plant.codegen.kernel`) for one kind of plant.

Constants are put in and sums of them worked out, branches that cannot be taken go, loops over tuples are written out turn by turn, functions that are
not compiled by themselves are written into their callers, and calls of insertion points are replaced by what they insert.

Locals of a function that is written into another keep their names, so that the source stays readable; `Specialiser` refuses a name that its caller
uses, too, unless it is what the caller assigns the result to.
"""

from __future__ import annotations

import ast
import copy
import operator
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

Insertion = Callable[[ast.Call], tuple[list[ast.stmt], ast.expr]]  # statements that go before, and what stands for the call
Bindings = dict[str, ast.expr]

ARITHMETIC: Mapping[type[ast.AST], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.FloorDiv: operator.floordiv,
    ast.Lt: operator.lt, ast.LtE: operator.le, ast.Gt: operator.gt, ast.GtE: operator.ge, ast.Eq: operator.eq, ast.NotEq: operator.ne,
}  # fmt: skip
CHOICE: Mapping[str, Callable[..., Any]] = {"min": min, "max": max}


@dataclass(frozen=True, slots=True)
class Specialiser:
    """``functions`` by name, the numbers and choices that stand for ``constants``, and the ``insertions`` by the name that is called; functions in
    ``compiled`` stay calls."""

    functions: Mapping[str, ast.FunctionDef]
    constants: Mapping[str, float]
    insertions: Mapping[str, Insertion]
    compiled: frozenset[str]

    def function(self, name: str) -> ast.FunctionDef:
        """One compiled function with everything that it calls written into it, without types."""
        found = self.functions[name]
        body, value = _Block(self, found, {}).run(found.body)
        documentation = [ast.Expr(ast.Constant(ast.get_docstring(found)))]
        ending = [] if value is None else [ast.Return(value)]
        arguments = ast.arguments([], [ast.arg(a.arg) for a in found.args.args], None, [], [], None, [])
        decorators = [ast.parse("njit(**OPTIONS)", mode="eval").body]
        return ast.fix_missing_locations(ast.FunctionDef(name, arguments, [*documentation, *body, *ending], decorators, lineno=0))


class _Block(ast.NodeTransformer):
    """The statements of one function, for one call of it: ``bound`` is what stands for its arguments and for the names of tuples."""

    def __init__(self, specialiser: Specialiser, function: ast.FunctionDef, bound: Bindings) -> None:
        self.all, self.where, self.bound = specialiser, function.name, bound
        self.own = {n.id for n in ast.walk(function) if isinstance(n, ast.Name)} | {a.arg for a in function.args.args}
        self.before: list[ast.stmt] = []  # statements that the expression at hand needs
        self.inserted: set[str] = set()  # names that they assign

    def run(self, statements: Iterable[ast.stmt]) -> tuple[list[ast.stmt], ast.expr | None]:
        """Statements as they are to stand, and what a return at their end gives."""
        done: list[ast.stmt] = []
        for statement in statements:
            if isinstance(statement, ast.Return):
                assert statement.value is not None
                value = self.visit(copy.deepcopy(statement.value))
                return [*done, *self._taken()], value
            done += self._statement(copy.deepcopy(statement))
        return done, None

    def _statement(self, node: ast.stmt) -> list[ast.stmt]:
        if isinstance(node, ast.Expr):
            return self._expression(node)
        if isinstance(node, ast.If):
            return self._branch(node)
        if isinstance(node, ast.For):
            return self._loop(node)
        if isinstance(node, ast.Assign):
            return self._assignment(node)
        new = self.visit(node)
        if isinstance(new, ast.AugAssign) and isinstance(new.op, ast.Add) and isinstance(new.value, ast.Constant) and new.value.value == 0:
            return self._taken()
        return [*self._taken(), new]

    def _expression(self, node: ast.Expr) -> list[ast.stmt]:
        if isinstance(node.value, ast.Constant):
            return []  # a docstring
        value = self.visit(node.value)
        return [*self._taken(), *([ast.Expr(value)] if isinstance(value, ast.Call) else [])]

    def _branch(self, node: ast.If) -> list[ast.stmt]:
        test = self.visit(node.test)
        if isinstance(test, ast.Constant):
            return self.run(node.body if test.value else node.orelse)[0]
        before = self._taken()
        return [*before, ast.If(test, self.run(node.body)[0] or [ast.Pass()], self.run(node.orelse)[0])]

    def _loop(self, node: ast.For) -> list[ast.stmt]:
        if isinstance(node.iter, ast.Call) and isinstance(node.iter.func, ast.Name) and node.iter.func.id == "pruned":
            (lanes,) = node.iter.args
            return [ast.For(node.target, self.visit(lanes), _pruned(self.run(node.body)[0]), [], lineno=0)]
        turns = self.visit(node.iter)
        before = self._taken()
        if not isinstance(turns, ast.Tuple):
            return [*before, ast.For(node.target, turns, self.run(node.body)[0], [], lineno=0)]
        assert isinstance(node.target, ast.Name)
        for turn in turns.elts:
            self.bound[node.target.id] = turn
            before += self.run(node.body)[0]
        return before

    def _assignment(self, node: ast.Assign) -> list[ast.stmt]:
        value = self.visit(node.value)
        if len(node.targets) == 1 and isinstance(node.targets[0], ast.Name) and isinstance(value, ast.Tuple):
            self.bound[node.targets[0].id] = value
            return self._taken()
        targets = [self.visit(target) for target in node.targets]
        before = self._taken({n.id for t in targets for n in ast.walk(t) if isinstance(n, ast.Name)})
        same = len(targets) == 1 and ast.unparse(targets[0]) == ast.unparse(value)
        return before if same else [*before, ast.Assign(targets, value, lineno=0)]

    def _taken(self, targets: Iterable[str] = ()) -> list[ast.stmt]:
        """Statements that go before the one at hand; refuses those that would change a variable of this function."""
        before, clash = self.before, self.inserted & self.own - set(targets)
        self.before, self.inserted = [], set()
        if clash:
            raise ValueError(f"{self.where}: {', '.join(sorted(clash))} are names of a function that is written into it, too; rename them there")
        return before

    def visit_Name(self, node: ast.Name) -> ast.expr:
        """What stands for a name: an argument, a tuple, a constant, or itself."""
        if node.id in self.bound:
            value = copy.deepcopy(self.bound[node.id])
            if isinstance(node.ctx, ast.Store):
                if not isinstance(value, ast.Name):
                    raise ValueError(f"{self.where}: {node.id} is assigned to, but stands for {ast.unparse(value)}")
                value.ctx = ast.Store()
            return value
        if node.id in self.all.constants and isinstance(node.ctx, ast.Load):
            return ast.Constant(self.all.constants[node.id])
        return node

    def visit_Call(self, node: ast.Call) -> ast.expr:
        """What an insertion point inserts; a function written out; a call as it is."""
        self.generic_visit(node)
        name = node.func.id if isinstance(node.func, ast.Name) else ""
        if name in self.all.insertions:
            statements, value = self.all.insertions[name](node)
            self.before += statements
            return value
        if name in self.all.functions and name not in self.all.compiled:
            return self._written_in(self.all.functions[name], node)
        if name in CHOICE and all(isinstance(a, ast.Constant) for a in node.args):
            return ast.Constant(CHOICE[name](*(ast.literal_eval(a) for a in node.args)))
        return node

    def _written_in(self, function: ast.FunctionDef, call: ast.Call) -> ast.expr:
        names = [a.arg for a in function.args.args]
        if len(names) != len(call.args) or call.keywords:
            raise ValueError(f"{self.where}: {function.name}() takes {len(names)} arguments by place")
        statements, value = _Block(self.all, function, dict(zip(names, call.args, strict=True))).run(function.body)
        self.inserted |= {n.id for s in statements for n in ast.walk(s) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)}
        self.before += statements
        return ast.Constant(None) if value is None else value

    def visit_BinOp(self, node: ast.BinOp) -> ast.expr:
        """Whole numbers are worked out; floating-point ones are left to Python."""
        self.generic_visit(node)
        a, b = node.left, node.right
        if isinstance(a, ast.Constant) and isinstance(b, ast.Constant) and type(a.value) is type(b.value) is int and type(node.op) in ARITHMETIC:
            return ast.Constant(ARITHMETIC[type(node.op)](a.value, b.value))
        return node

    def visit_Compare(self, node: ast.Compare) -> ast.expr:
        """Decided where both sides are known."""
        self.generic_visit(node)
        sides = [node.left, *node.comparators]
        if not all(isinstance(s, ast.Constant) for s in sides):
            return node
        values = [ast.literal_eval(s) for s in sides]
        return ast.Constant(all(ARITHMETIC[type(op)](a, b) for op, a, b in zip(node.ops, values, values[1:], strict=False)))

    def visit_BoolOp(self, node: ast.BoolOp) -> ast.expr:
        """Decided as soon as one side decides it; sides that do not matter are left out."""
        decides, left = isinstance(node.op, ast.Or), list[ast.expr]()
        for part in (self.visit(v) for v in node.values):
            if isinstance(part, ast.Constant):
                if bool(part.value) == decides:
                    return ast.Constant(decides)
            else:
                left += part.values if isinstance(part, ast.BoolOp) and type(part.op) is type(node.op) else [part]
        return ast.Constant(not decides) if not left else left[0] if len(left) == 1 else ast.BoolOp(node.op, left)

    def visit_UnaryOp(self, node: ast.UnaryOp) -> ast.expr:
        """``not`` of what is known."""
        self.generic_visit(node)
        return ast.Constant(not node.operand.value) if isinstance(node.op, ast.Not) and isinstance(node.operand, ast.Constant) else node

    def visit_IfExp(self, node: ast.IfExp) -> ast.expr:
        """The branch that is taken, where that is known."""
        test = self.visit(node.test)
        if isinstance(test, ast.Constant):
            return self._visited(node.body if test.value else node.orelse)
        return ast.IfExp(test, self._visited(node.body), self._visited(node.orelse))

    def visit_Subscript(self, node: ast.Subscript) -> ast.expr:
        """A member of a tuple by its number."""
        self.generic_visit(node)
        if isinstance(node.value, ast.Tuple) and isinstance(node.slice, ast.Constant):
            member: int = ast.literal_eval(node.slice)
            return node.value.elts[member]
        return node

    def _visited(self, node: ast.expr) -> ast.expr:
        found = self.visit(node)
        assert isinstance(found, ast.expr)
        return found


def _pruned(statements: list[ast.stmt]) -> list[ast.stmt]:
    """Without assignments of names that nothing after them reads."""
    needed, kept = set[str](), list[ast.stmt]()
    for statement in reversed(statements):
        targets = [n for t in statement.targets for n in (t.elts if isinstance(t, ast.Tuple) else [t])] if isinstance(statement, ast.Assign) else []
        if targets and all(isinstance(t, ast.Name) and t.id not in needed for t in targets):
            continue
        needed |= {n.id for n in ast.walk(statement) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Load)}
        kept.append(statement)
    return kept[::-1]
