"""Parts of loops have no machine code of their own."""

import numpy as np
import pytest

from pin_metaik.kinematics.kernel import forward


def test_of_a_part_there_is_its_code_for_llvm_and_nothing_that_python_could_call() -> None:
    part = forward.copy
    part.compile("void(f8[::1], f8[::1])")
    for code in part.overloads.values():
        assert {function.name for function in code.library.get_defined_functions()} == {code.fndesc.llvm_func_name}
        assert code.library.get_pointer_to_function(code.fndesc.llvm_cpython_wrapper_name) == 0
    with pytest.raises(TypeError, match="not callable"):
        forward.copy(np.zeros(3), np.zeros(3))
