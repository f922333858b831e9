"""Parts that have machine code of their own, which every loop that has them calls by its name.

For what many loops have and call seldom, such as a whole descent: it is optimised once and not once in each of them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from llvmlite import binding
from numba.core import sigutils
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompileResult

from pin_metaik.compiled import parts

OBJECT = "object of a part"
SEPARATE: dict[tuple[str, str], Separate] = {}  # by module and name: those of the modules imported so far


@dataclass(frozen=True)
class Needed:
    """What code on disk calls, to be had before it is read.

    Attributes:
        module: Of the function.
        name: Of the function, in its module.
        arguments: Numba's types of its arguments.
        symbol: That the code calls it by.
    """

    module: str
    name: str
    arguments: tuple[Any, ...]
    symbol: str

    def __call__(self) -> None:
        """Compile it, or read it.

        Raises:
            ValueError: It has another name now.
        """
        part = SEPARATE[self.module, self.name]
        part.compile(self.arguments)
        if part.overloads[self.arguments].fndesc.llvm_func_name != self.symbol:
            raise ValueError(f"{self.name} is no longer {self.symbol}")


class SeparateLibrary(JITCodeLibrary):
    """Machine code of a part, and nothing for loops to link in.

    Attributes:
        itself: What a loop needs that calls it.
    """

    itself: Needed

    def __init__(self, codegen: Any, name: str) -> None:
        super().__init__(codegen, name)
        self.enable_object_caching()

    def _get_module_for_linking(self) -> Any:
        self._ensure_finalized()
        return binding.parse_assembly(str(self._codegen._create_empty_module(self.name)))

    def serialize_using_object_code(self) -> tuple[str, str, bytes]:
        """For the disk."""
        self._ensure_finalized()
        return (self.name, OBJECT, self._get_compiled_object())


class SeparateCompiler(parts.PartCompiler):
    """Numba's compiler up to machine code with a name that is the same in every process."""

    library = SeparateLibrary

    def _compile_bytecode(self) -> CompileResult:
        self.state.func_id.unique_id = 0  # numba counts the functions of a process
        return super()._compile_bytecode()


class Separate(parts.Part):
    """Numba's dispatcher of such a part."""

    compiler = SeparateCompiler

    def __init__(self, function: Callable[..., Any], **options: Any) -> None:
        super().__init__(function, **options)
        SEPARATE[function.__module__, function.__qualname__] = self

    def compile(self, signature: Any) -> Any:
        """The library, made now or read; while one process makes it, others wait for it."""
        arguments = tuple(sigutils.normalize_signature(signature)[0])
        if arguments in self.overloads or self._cache.has(arguments):
            return super().compile(arguments)
        with self._cache.turn():
            return super().compile(arguments)

    def add_overload(self, code: CompileResult) -> None:
        """Let loops find it, and say that they need it."""
        super().add_overload(code)
        function, arguments = self.py_func, tuple(code.signature.args)
        code.library.itself = Needed(function.__module__, function.__qualname__, arguments, code.fndesc.llvm_func_name)


def needed_by(library: JITCodeLibrary) -> list[Needed]:
    """What the code of a loop or a part calls, without what that calls itself."""
    found = dict.fromkeys(getattr(library, "needs", ()))
    for each in library._linking_libraries:
        found |= dict.fromkeys([each.itself] if isinstance(each, SeparateLibrary) else needed_by(each))
    return [*found]


def read(context: Any, payload: tuple[Any, ...]) -> CompileResult:
    """Such a part from what numba's ``CompileResult`` was reduced to."""
    (name, _, machine_code), *_ = payload
    library = SeparateLibrary(context.codegen(), name)
    library._set_compiled_object(machine_code)
    library._finalize_final_module()
    return parts.result(context, library, payload)
