"""An arm's closed form as code of its own: it has the solutions that the package has."""

import ctypes
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

import pin_metaik as mik
from pin_metaik.errors import CannotExport
from pin_metaik.export import exported, write_export
from tests.robots_under_test import chain_of

COUNTS = {"ur5": 10_000, "puma560": 10_000, "kinova": 1_000, "z1": 1_000}
NUMBERS = ctypes.POINTER(ctypes.c_double)
CLOSE = 1e-6  # rad: at 1e-3 of a singularity rounding of 1e-13 moves an angle by this


def as_numbers(array: np.ndarray) -> object:
    return array.ctypes.data_as(NUMBERS)


def flat(pose: np.ndarray) -> np.ndarray:
    return np.concatenate([pose[:3, :3].ravel(), pose[:3, 3]])


@pytest.mark.skipif(shutil.which("cc") is None, reason="there is no C compiler")
@pytest.mark.parametrize("name", COUNTS)
def test_exported_c_has_the_solutions_of_the_package_at_ten_thousand_poses(name: str, tmp_path: Path) -> None:
    chain, source, built = chain_of(name), tmp_path / "arm.c", tmp_path / "arm.so"
    write_export(chain, source)
    strict = ["cc", "-std=c99", "-O2", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC"]
    subprocess.run([*strict, str(source), "-o", str(built), "-lm"], check=True)
    arm, near = ctypes.CDLL(str(built)), chain.x(chain.reference)
    odd = 0
    for pose in chain.poses(chain.box.sample(np.random.default_rng(5), COUNTS[name]))[:, 0]:
        every, found = mik.solve_ik_all(chain, pose, certify=False), np.empty((8, 6))
        target = flat(pose)
        found = found[: arm.arm_solve(as_numbers(target), as_numbers(near), as_numbers(found))]
        proved = every.complete is not None  # else near a singularity, where their number is a matter of rounding
        if not (len(found) == len(every) and np.abs(found[:, None] - every.x).max(axis=2).min(axis=0).max() < CLOSE):
            odd += 1
            assert not proved
    assert odd <= 0.01 * COUNTS[name]


def test_exported_python_needs_nothing_and_has_the_same_solutions() -> None:
    chain, program = chain_of("ur5"), {}
    text = exported(chain, "python")
    assert "import math\n" in text and text.count("import ") == 1
    exec(compile(text, "arm.py", "exec"), program)
    near = chain.x(chain.reference)
    for pose in chain.poses(chain.box.sample(np.random.default_rng(6), 200))[:, 0]:
        every = mik.solve_ik_all(chain, pose, certify=False)
        found = np.array(program["solve"](flat(pose).tolist(), near.tolist())).reshape(-1, 6)
        if every.complete is not None:
            assert len(found) == len(every)
            assert np.abs(found[:, None] - every.x).max(axis=2).min(axis=0).max() < CLOSE


def test_what_has_no_closed_form_is_told_which_arms_have() -> None:
    with pytest.raises(CannotExport, match="as ur5, puma560"):
        exported(chain_of("panda"))
    with pytest.raises(CannotExport, match="known: c, python"):
        exported(chain_of("ur5"), "fortran")
