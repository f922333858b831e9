"""Types of calls, found out once.

For every ``a + b`` numba tries all its definitions of ``+``, those for arrays and strings among them, although the type
of the sum depends on nothing but the types of a and b. That was a sixth of the time that compiling took.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterator
from contextlib import contextmanager
from types import BuiltinFunctionType
from typing import Any

from numba.core import types
from numba.core.compiler_lock import global_compiler_lock
from numba.core.registry import cpu_target
from numba.core.targetconfig import ConfigStack

_known: dict[Hashable, Any] = {}
_options: dict[int, tuple[Any, int]] = {}  # by identity of the options: them, and the number of their like
_kinds: list[Any] = []


@contextmanager
def found_out_once() -> Iterator[None]:
    """While numba compiles here, it looks up the types of calls that it has seen with the same options."""
    context: Any = cpu_target.typing_context
    find_out = context.resolve_function_type

    def look_up(function: Any, arguments: Any, named: Any) -> Any:
        if named or not isinstance(function, types.Function | BuiltinFunctionType):  # a part, or an index
            return find_out(function, arguments, named)
        call = function, tuple(arguments), _options_here()
        if (signature := _known.get(call)) is None and (signature := find_out(function, arguments, named)) is not None:
            _known[call] = signature
        return signature

    with global_compiler_lock:  # no other thread compiles meanwhile, nor ends this
        context.resolve_function_type = look_up
        try:
            yield
        finally:
            del context.resolve_function_type


def _options_here() -> int:
    """The number of the options of what is being compiled: some of numba's definitions are compiled for them."""
    options = ConfigStack.top_or_none()
    if id(options) not in _options:
        if options not in _kinds:
            _kinds.append(options)
        _options[id(options)] = options, _kinds.index(options)
    return _options[id(options)][1]
