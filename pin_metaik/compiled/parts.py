"""Parts of loops: lowered to LLVM's code once, and optimised and made machine code of in the loops that have them.

Numba compiles whatever a function calls like a function that Python calls: for each part it optimised what was to be
optimised once more in every loop, and made machine code and wrappers that nobody called. Without that, the 19 loops of
the arm's kernel are compiled in half the processor time, and the loops are as quick or quicker.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from llvmlite import binding
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler, CompileResult, compile_result
from numba.core.registry import CPUDispatcher

BITCODE = "bitcode"  # numba's name for a library that is kept as LLVM's code


class Part(CPUDispatcher):
    """Numba's dispatcher of a part: loops call it, Python cannot."""

    def __init__(self, function: Callable[..., Any], **options: Any) -> None:
        super().__init__(function, targetoptions={"nopython": True, **options}, pipeline_class=PartCompiler)

    def add_overload(self, code: CompileResult) -> None:
        """Let loops find it; there is nothing that Python could call."""
        self.overloads[tuple(code.signature.args)] = code


class PartCompiler(Compiler):
    """Numba's compiler up to LLVM's code."""

    def compile_extra(self, function: Callable[..., Any]) -> CompileResult:
        """The part's library, which stands for it where numba would have a function that Python can call."""
        state = self.state
        state.library = library = PartLibrary(state.targetctx.codegen(), function.__qualname__)
        state.flags.no_compile = state.flags.no_cpython_wrapper = state.flags.no_cfunc_wrapper = True
        code = super().compile_extra(function)._replace(entry_point=library)
        state.targetctx.insert_user_function(library, code.fndesc, [library])
        return code


class PartLibrary(JITCodeLibrary):
    """LLVM's code of a part and of those that it calls, for loops to link in."""

    def _optimize_final_module(self) -> None:
        """Is done in the loops."""

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._finalized = True

    def serialize_using_object_code(self) -> tuple[str, str, bytes]:
        """For the disk: there is no object code."""
        return (self.name, BITCODE, self._final_module.as_bitcode())


def lean(code: CompileResult) -> CompileResult:
    """What is to be kept of a loop or a part, without what nobody asks for.

    That is numba's report of the types, and beside the machine code of a loop its bitcode, which is three times as long
    and for others to link in: nobody links a loop. Of it there remains the name that Python calls.
    """
    if not isinstance(code.library, PartLibrary):
        called = f'define void @"{code.fndesc.llvm_cpython_wrapper_name}"() {{ unreachable }}'
        code.library._shared_module = binding.parse_assembly(called)
    return code._replace(type_annotation="")


def read(context: Any, payload: tuple[Any, ...]) -> CompileResult | None:
    """A part from what numba's ``CompileResult`` was reduced to; None: that is of a loop."""
    (name, kind, bitcode), description, environment, signature, *_ = payload
    if kind != BITCODE:
        return None
    library = PartLibrary(context.codegen(), name)
    library._final_module = binding.parse_bitcode(bitcode)
    library._finalize_final_module()
    return compile_result(
        typing_context=context.typing_context,
        target_context=context,
        entry_point=library,
        signature=signature,
        objectmode=False,
        lifted=(),
        fndesc=description,
        library=library,
        environment=environment,
    )
