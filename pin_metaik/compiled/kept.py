"""What is kept on disk of a compiled function, and how it is had from there."""

from __future__ import annotations

from typing import Any

from llvmlite import binding
from numba.core.compiler import CompileResult

from pin_metaik.compiled import parts, separate_parts


def lean(code: CompileResult) -> CompileResult:
    """What is to be kept of a loop or a part, without what nobody asks for.

    That is numba's report of the types, and beside the machine code of a loop its bitcode, which is three times as long
    and for others to link in: nobody links a loop. Of it there remains the name that Python calls.
    """
    library, description = code.library, code.fndesc
    if not isinstance(library, parts.PartLibrary | separate_parts.SeparateLibrary):
        called = f'define void @"{description.llvm_cpython_wrapper_name}"() {{ unreachable }}'
        library._shared_module = binding.parse_assembly(called)
    return code._replace(type_annotation="", reload_init=separate_parts.needed_by(library))


def read(context: Any, payload: tuple[Any, ...]) -> CompileResult | None:
    """A part from what numba's ``CompileResult`` was reduced to; None: that is of a loop."""
    (_, kind, _), *_, needed, _ = payload
    for each in needed:
        each()
    match kind:
        case parts.BITCODE:
            return parts.read(context, payload)
        case separate_parts.OBJECT:
            return separate_parts.read(context, payload)
    return None
