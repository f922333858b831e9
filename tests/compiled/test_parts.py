"""Parts of loops have no machine code of their own."""

from importlib import import_module
from typing import Any

import numpy as np
import pytest

from pin_metaik.compiled.parts import Part
from pin_metaik.compiled.sources import modules
from pin_metaik.errors import MissingExtra
from pin_metaik.kinematics.kernel import forward


def test_of_a_part_there_is_its_code_for_llvm_and_nothing_that_python_could_call() -> None:
    part: Any = forward.copy
    part.compile("void(f8[::1], f8[::1])")
    for code in part.overloads.values():
        assert {function.name for function in code.library.get_defined_functions()} == {code.fndesc.llvm_func_name}
        assert code.library.get_pointer_to_function(code.fndesc.llvm_cpython_wrapper_name) == 0
    with pytest.raises(TypeError, match="not callable"):
        forward.copy(np.zeros(3), np.zeros(3))


def test_every_part_says_how_it_is_compiled_or_its_first_caller_would() -> None:
    parts: list[Part] = []
    for name in modules():
        try:
            parts += [each for each in vars(import_module(name)).values() if isinstance(each, Part)]
        except MissingExtra:
            continue
    assert len(parts) > 200
    assert [part for part in parts if not {"fastmath", "forceinline", "error_model"} <= set(part.targetoptions)] == []
