"""Parts of loops: lowered to LLVM's code once, and optimised and made machine code of in the loops that have them.

Numba compiles whatever a function calls like a function that Python calls: for each part it optimised what was to be
optimised once more in every loop, and made machine code and wrappers that nobody called. Without that, the 19 loops of
the arm's kernel are compiled in half the processor time, and the loops are as quick or quicker.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from llvmlite import binding
from numba.core import typed_passes, untyped_passes
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler, CompileResult, Flags, compile_result
from numba.core.compiler_machinery import PassManager
from numba.core.registry import CPUDispatcher

BITCODE = "bitcode"  # numba's name for a library that is kept as LLVM's code
# To look for closures and for formulas of whole arrays took a thirtieth of compiling; loops have one difference.
NEEDLESS = untyped_passes.InlineClosureLikes, typed_passes.NopythonRewrites


class QuickFlags(Flags):
    """Numba's flags.

    It compares them whenever it looks for what a call means, which took a sixtieth of compiling, and has them in the
    names of functions, where sets among them come in another order in every process.
    """

    def __hash__(self) -> int:
        return HASH

    def __eq__(self, other: object) -> bool:
        return bool((isinstance(other, Flags) and self._values == other._values) or super().__eq__(other))

    def get_mangle_string(self) -> str:
        """The same for all: functions are numbered, too."""
        return "loop"


HASH = hash(Flags())  # is that of their names, and so of all


class LoopCompiler(Compiler):
    """Numba's compiler without the passes for what loops do not have."""

    def __init__(self, *arguments: Any) -> None:
        super().__init__(*(QuickFlags(each) if isinstance(each, Flags) else each for each in arguments))

    def define_pipelines(self) -> list[PassManager]:
        """Numba's own, less these."""
        pipelines: list[PassManager] = super().define_pipelines()
        for pipeline in pipelines:
            pipeline.passes = [each for each in pipeline.passes if each[0] not in NEEDLESS]
            pipeline.finalize()
        return pipelines


class PartLibrary(JITCodeLibrary):
    """LLVM's code of a part and of those that it calls, for loops to link in.

    Attributes:
        needs: What it said on disk that it needs.
    """

    needs: Sequence[Any] = ()

    def _optimize_final_module(self) -> None:
        """Is done in the loops."""

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._finalized = True

    def serialize_using_object_code(self) -> tuple[str, str, bytes]:
        """For the disk: there is no object code."""
        return (self.name, BITCODE, self._final_module.as_bitcode())


class PartCompiler(LoopCompiler):
    """Numba's compiler up to LLVM's code."""

    library: type[JITCodeLibrary] = PartLibrary

    def compile_extra(self, function: Callable[..., Any]) -> CompileResult:
        """The part's library, which stands for it where numba would have a function that Python can call."""
        state = self.state
        state.library = library = self.library(state.targetctx.codegen(), function.__qualname__)
        state.flags.no_compile = state.flags.no_cpython_wrapper = state.flags.no_cfunc_wrapper = True
        code = super().compile_extra(function)._replace(entry_point=library)
        state.targetctx.insert_user_function(library, code.fndesc, [library])
        return code


class Part(CPUDispatcher):
    """Numba's dispatcher of a part: loops call it, Python cannot."""

    compiler = PartCompiler

    def __init__(self, function: Callable[..., Any], **options: Any) -> None:
        super().__init__(function, targetoptions={"nopython": True, **options}, pipeline_class=self.compiler)

    def add_overload(self, code: CompileResult) -> None:
        """Let loops find it; there is nothing that Python could call."""
        self.overloads[tuple(code.signature.args)] = code


def read(context: Any, payload: tuple[Any, ...]) -> CompileResult:
    """A part from what numba's ``CompileResult`` was reduced to."""
    (name, _, bitcode), *_ = payload
    library = PartLibrary(context.codegen(), name)
    library._final_module = binding.parse_bitcode(bitcode)
    library._finalize_final_module()
    *_, library.needs, _ = payload
    return result(context, library, payload)


def result(context: Any, library: JITCodeLibrary, payload: tuple[Any, ...]) -> CompileResult:
    """What numba's compiler gave when it compiled a part that now is a library read from disk."""
    _, description, environment, signature, *_ = payload
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
