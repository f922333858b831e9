"""Parts with machine code of their own are in no loop, and have the same name in every process."""

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from pin_metaik.compiled.separate_parts import Needed, needed_by
from pin_metaik.kinematics.kernel import forward

NAMES = """
import sys
from pin_metaik.kinematics.kernel import forward, goals
{"poses": forward.poses, "costs": goals.costs}[sys.argv[1]].compiled()
print([code.fndesc.llvm_func_name for code in forward.unpack.overloads.values()])
"""


def compiled() -> tuple[Any, Any]:
    """A loop, and a part that it needs."""
    loop: Any = forward.poses
    return loop.compiled(), forward.unpack


def test_the_machine_code_of_a_loop_has_none_of_such_a_part() -> None:
    loop, separate = compiled()
    (code,), (part,) = loop.overloads.values(), separate.overloads.values()
    needs = {*needed_by(code.library), *code.reload_init}  # compiled here, or read
    (needed,) = (each for each in needs if each.name == "chain_in")
    assert needed.symbol == part.fndesc.llvm_func_name
    assert needed.symbol not in {function.name for function in code.library.get_defined_functions()}
    needed()


def test_code_on_disk_that_needs_a_part_by_another_name_is_not_used() -> None:
    (part,) = compiled()[1].overloads.values()
    with pytest.raises(ValueError, match="chain_in is no longer another"):
        Needed("pin_metaik.kinematics.kernel.layout", "chain_in", tuple(part.signature.args), "another")()


def test_its_name_is_the_same_whatever_was_compiled_before(tmp_path: Path) -> None:
    names = set()
    for which in ("poses", "costs"):
        empty = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path / which)}
        names.add(subprocess.check_output([sys.executable, "-c", NAMES, which], text=True, env=empty))
    assert len(names) == 1
