"""Functions of the kernels by their source."""

from __future__ import annotations

import ast
import inspect
from collections.abc import Callable
from typing import Any, cast

from pin_metaik.errors import CannotExport


def source_of(function: Callable[..., Any]) -> tuple[ast.FunctionDef, dict[str, Any]]:
    """A function's source, without its decorators, and what names mean around it."""
    plain = inspect.unwrap(getattr(function, "py_func", function))
    try:
        text = inspect.getsource(plain)
    except (OSError, TypeError) as error:
        raise CannotExport(f"the source of {plain!r} is not known") from error
    (tree,) = ast.parse(text).body
    tree = cast(ast.FunctionDef, tree)
    tree.decorator_list = []
    return tree, plain.__globals__
