"""The same functions as Python that needs nothing but its standard library."""

from __future__ import annotations

import ast
from collections.abc import Mapping
from typing import Any

RENAMED = {"np.round": "_whole", "np.ceil": "_ceil", "np.floor": "_floor"}


class Plain(ast.NodeTransformer):
    """Puts constants in the place of their names, and leaves annotations and the closed form out."""

    def __init__(self, numbers: Mapping[str, Any]) -> None:
        self.numbers = numbers

    def visit_FunctionDef(self, node: ast.FunctionDef) -> ast.FunctionDef:
        """A function without annotations."""
        node.returns = None
        node.args.args = [argument for argument in node.args.args if argument.arg != "form"]
        for argument in node.args.args:
            argument.annotation = None
        self.generic_visit(node)
        return node

    def visit_Name(self, node: ast.Name) -> ast.expr:
        """A constant, if it is one."""
        return self._constant(node)

    def visit_Subscript(self, node: ast.Subscript) -> ast.expr:
        """A number of the closed form, if it is one."""
        known = self._constant(node)
        return node if known is node else known

    def visit_Call(self, node: ast.Call) -> ast.expr:
        """A call, without the closed form; ``vector`` of a row of it is the row."""
        name = ast.unparse(node.func)
        if name == "vector":
            return self._constant(node.args[0])
        node.args = [self.visit(one) for one in node.args if ast.unparse(one) != "form"]
        node.func = ast.Name(RENAMED[name]) if name in RENAMED else node.func
        return node

    def _constant(self, node: ast.expr) -> ast.expr:
        text = ast.unparse(node)
        return ast.parse(repr(self.numbers[text]), mode="eval").body if text in self.numbers else node


def python_of(function: ast.FunctionDef, numbers: Mapping[str, Any]) -> str:
    """The text of a function, with the numbers of one arm in it."""
    return ast.unparse(ast.fix_missing_locations(Plain(numbers).visit(function)))
