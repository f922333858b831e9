"""An arm's inverse kinematics as code of its own: it has the solutions that the package has."""

import ctypes
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_array_equal

import pin_metaik as mik
from pin_metaik.compare.cases.calibrated import measured
from pin_metaik.errors import CannotExport
from pin_metaik.export import exported, write_export
from tests.kinematics.roots.test_six_joints import drawn_chain
from tests.robots_under_test import chain_of

COUNTS = {"ur5": 10_000, "puma560": 10_000, "kinova": 1_000, "z1": 1_000}  # with a closed form
COUNTS |= {"aerial_arm": 500, "bravo7_no_ee": 500, "ur5 calibrated": 500, "RRPRRR": 200, "RRRRRRR": 50}  # by roots
NUMBERS = ctypes.POINTER(ctypes.c_double)
CLOSE = 1e-6  # rad or m: at 1e-3 of a singularity rounding of 1e-13 moves an angle by this
ROOM = 32

needs_compiler = pytest.mark.skipif(shutil.which("cc") is None, reason="there is no C compiler")


def arm_of(name: str) -> mik.Chain:
    if set(name) <= {"R", "P"}:  # drawn at random; of seven joints the last one follows the first one
        return drawn_chain(name, -1.0 if len(name) == 7 else 0.0)
    if name.endswith(" calibrated"):
        return measured(mik.load_robot(name.split()[0]), np.random.default_rng(1))
    return chain_of(name)


def as_numbers(array: np.ndarray) -> object:
    return array.ctypes.data_as(NUMBERS)


def flat(pose: np.ndarray) -> np.ndarray:
    return np.concatenate([pose[:3, :3].ravel(), pose[:3, 3]])


def compiled(chain: mik.Chain, folder: Path) -> ctypes.CDLL:
    source, built = folder / "arm.c", folder / "arm.so"
    write_export(chain, source)
    strict = ["cc", "-std=c99", "-O2", "-Wall", "-Wextra", "-pedantic", "-Werror", "-shared", "-fPIC"]
    subprocess.run([*strict, str(source), "-o", str(built), "-lm"], check=True)
    return ctypes.CDLL(str(built))


def solved(arm: ctypes.CDLL, pose: np.ndarray, near: np.ndarray, most: int = ROOM) -> np.ndarray:
    found, target = np.full((ROOM, 6), np.nan), flat(pose)
    return found[: arm.arm_solve(as_numbers(target), as_numbers(near), as_numbers(found), most)]


@needs_compiler
@pytest.mark.parametrize("name", COUNTS)
def test_exported_c_has_the_solutions_of_the_package(name: str, tmp_path: Path) -> None:
    chain = arm_of(name)
    arm, near, odd = compiled(chain, tmp_path), chain.x(chain.reference), 0
    for pose in chain.poses(chain.box.sample(np.random.default_rng(5), COUNTS[name]))[:, 0]:
        every, found = mik.solve_ik_all(chain, pose, certify=False), solved(arm, pose, near)
        proved = every.complete is not None  # else near a singularity, where their number is a matter of rounding
        if not (len(found) == len(every) and np.abs(found[:, None] - every.x).max(axis=2).min(axis=0).max() < CLOSE):
            odd += 1
            assert not proved
    assert odd <= 0.01 * COUNTS[name]


@needs_compiler
@pytest.mark.parametrize("name", ["puma560", "bravo7_no_ee"])
def test_solutions_of_exported_c_are_inside_the_limits_nearest_first_and_as_many_as_asked_for(
    name: str, tmp_path: Path
) -> None:
    chain = chain_of(name)
    arm, rng = compiled(chain, tmp_path), np.random.default_rng(7)
    for x in chain.box.sample(rng, 50):
        pose, near = chain.poses(x)[0, 0], chain.box.sample(rng, 1)[0]
        found = solved(arm, pose, near)
        assert (found >= chain.limits.lower).all() and (found <= chain.limits.upper).all()
        assert np.abs(chain.poses(found)[:, 0] - pose).max() < 1e-5
        assert (np.diff(np.linalg.norm(found - near, axis=1)) >= 0.0).all()
        for most in (0, 1, 3):
            assert_array_equal(solved(arm, pose, near, most), found[:most])


@needs_compiler
def test_singular_poses_and_such_as_are_out_of_reach_are_no_trouble_to_exported_c(tmp_path: Path) -> None:
    chain = chain_of("aerial_arm")
    arm, near = compiled(chain, tmp_path), chain.x(chain.reference)
    stretched, far = chain.poses(np.zeros(6))[0, 0], np.eye(4)
    far[0, 3] = 1e3
    for found in (solved(arm, stretched, near), solved(arm, far, near), solved(arm, np.full((4, 4), np.nan), near)):
        assert np.isfinite(found).all()
    assert len(solved(arm, far, near)) == 0


@pytest.mark.parametrize("name", ["ur5", "aerial_arm"])
def test_exported_c_keeps_nothing_between_calls(name: str) -> None:
    text = exported(chain_of(name))
    assert not re.search(r"^ +static ", text, re.M)
    assert all(line.startswith("static const") for line in re.findall(r"^static [^(\n]*$", text, re.M))
    assert set(re.findall(r"#include <(.*)>", text)) <= {"math.h", "complex.h"}


def test_exported_python_needs_nothing_and_has_the_same_solutions() -> None:
    chain = chain_of("ur5")
    program: dict[str, Any] = {}
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


def test_what_cannot_be_written_is_told_what_can() -> None:
    with pytest.raises(CannotExport, match="here 7 move 1"):
        exported(chain_of("panda"))
    with pytest.raises(CannotExport, match=r"as ur5, puma560.* can be written in C"):
        exported(chain_of("aerial_arm"), "python")
    with pytest.raises(CannotExport, match="known: c, python"):
        exported(chain_of("ur5"), "fortran")
