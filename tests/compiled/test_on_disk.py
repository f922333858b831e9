"""Machine code is that of the sources, wherever it can be kept or cannot."""

import os
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from pin_metaik.cache_folder import cache_folder
from pin_metaik.compiled import baseline, sources

# Two loops in one file with parts from another, one of them with machine code of its own, quick to compile; what the
# loops return, and how many of the three were compiled.
KERNELS = {
    "parts.py": """
from pin_metaik.compiled import inline, separate

@inline
def twice(x: float) -> float:
    return 2.0 * x

@separate
def added(s: float, x: float) -> float:
    return s + twice(x)
""",
    "loops.py": """
from pin_metaik.compiled import Floats, jit
from pin_metaik.toy.parts import added, twice

@jit("f8(f8[::1])")
def total(x: Floats) -> float:
    s = 0.0
    for i in range(x.shape[0]):
        s = added(s, x[i])
    return s

@jit("f8(f8)")
def fourfold(x: float) -> float:
    return twice(twice(x))
""",
}
PART, CHANGED = "2.0 * x", "3.0 * x"
ASK = """
import numpy as np
from pin_metaik.toy import loops, parts
compiled = loops.total.compiled(), loops.fourfold.compiled(), parts.added
print(loops.total(np.ones(3)), loops.fourfold(1.0), sum(sum(each.stats.cache_misses.values()) for each in compiled))
"""
RIGHT, OTHER = (6.0, 4.0), (9.0, 9.0)
SHIP = """
from pin_metaik.compiled import LOOPS, ahead
from pin_metaik.toy import loops
for loop in LOOPS.values():
    loop.compiled()
for code in ahead.machine_code():
    code.ship()
"""
KEPT = """
import pickle
from llvmlite import binding
from pathlib import Path
(file,) = Path().rglob("*.fourfold-*.nbc")
(_, kind, (machine_code, bitcode)), about, *_ = pickle.loads(file.read_bytes())
names = [function.name for function in binding.parse_bitcode(bitcode).functions]
print(kind, names == [about.llvm_cpython_wrapper_name] and len(bitcode) < len(machine_code))
"""
NOWHERE = {"HOME": os.devnull, "XDG_CACHE_HOME": os.devnull, "NUMBA_CACHE_DIR": os.devnull}


def bare(folder: Path) -> Path:
    """The folder, with a copy of the package in it that has these kernels, too, and no machine code."""
    shutil.copytree(
        sources.PACKAGE, folder / "pin_metaik", ignore=shutil.ignore_patterns("__pycache__", "machine_code")
    )
    (folder / "pin_metaik" / "toy").mkdir()
    for name, text in KERNELS.items():
        (folder / "pin_metaik" / "toy" / name).write_text(text)
    return folder


@pytest.fixture
def copied(tmp_path: Path) -> Path:
    """The same, with the machine code of these kernels beside them."""
    folder = bare(tmp_path / "copy")
    assert ask(folder) == (RIGHT, 3)
    return folder


def change(folder: Path) -> None:
    """Let the part that both loops have be another."""
    parts = folder / "pin_metaik" / "toy" / "parts.py"
    text = parts.read_text()
    assert PART in text
    parts.write_text(text.replace(PART, CHANGED))


def ask(folder: Path, **environment: str) -> tuple[tuple[float, float], int]:
    """What the loops return and how many of the three were compiled, when the package is that in ``folder``."""
    given = {**os.environ, "PYTHONPATH": str(folder), **environment}
    if not environment:
        given.pop("NUMBA_CACHE_DIR", None)
    done = subprocess.run([sys.executable, "-c", ASK], env=given, cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    total, fourfold, compiled = done.stdout.split()
    return (float(total), float(fourfold)), int(compiled)


def test_a_change_of_a_part_is_seen_by_every_loop_that_has_it(copied: Path) -> None:
    assert ask(copied) == (RIGHT, 0)
    change(copied)
    assert ask(copied) == (OTHER, 3)


def test_machine_code_that_lies_beside_the_package_is_used_where_nothing_can_be_written(copied: Path) -> None:
    for folder in copied.rglob("__pycache__"):
        folder.chmod(0o555)
    assert ask(copied, HOME=os.devnull, XDG_CACHE_HOME=os.devnull) == (RIGHT, 0)


def test_without_any_folder_to_keep_it_in_everything_is_compiled(tmp_path: Path) -> None:
    bare(tmp_path)
    (tmp_path / "pin_metaik" / "toy" / "__pycache__").touch()  # a file where the folder would be
    assert ask(tmp_path, **NOWHERE) == (RIGHT, 3)


def test_machine_code_that_a_wheel_carries_is_used_until_a_source_changes(tmp_path: Path) -> None:
    built = bare(tmp_path / "built")
    processor = baseline.baseline()
    assert processor is not None, "this machine is older than the baseline"
    there = {"PYTHONPATH": str(built), "NUMBA_CACHE_DIR": str(tmp_path / "code")}
    cpu = {"NUMBA_CPU_NAME": processor.name, "NUMBA_CPU_FEATURES": ""}
    subprocess.run([sys.executable, "-c", SHIP], env={**os.environ, **there, **cpu}, cwd=built, check=True)
    site = tmp_path / "site"
    shutil.copytree(built / "pin_metaik", site / "pin_metaik", ignore=shutil.ignore_patterns("__pycache__"))
    assert ask(site, **NOWHERE) == (RIGHT, 0)
    change(site)
    assert ask(site, **NOWHERE) == (OTHER, 3)


def test_of_a_loop_there_is_kept_its_machine_code_and_nothing_for_others_to_link(copied: Path) -> None:
    done = subprocess.run([sys.executable, "-c", KEPT], cwd=copied, capture_output=True, text=True)
    assert done.stdout.split() == ["object", "True"], done.stderr


def test_code_for_the_baseline_needs_every_one_of_its_instructions() -> None:
    for processor in (baseline.X86_64_V3, baseline.ARMV8, baseline.APPLE_M1):
        every = dict.fromkeys(processor.instructions, True)
        assert processor.fits({**every, "another": False})
        for instruction in every:
            assert not processor.fits({**every, instruction: False})


def test_two_processes_that_start_at_once_compile_each_loop_once(tmp_path: Path) -> None:
    bare(tmp_path)
    with ThreadPoolExecutor(2) as threads:
        answers = list(threads.map(lambda _: ask(tmp_path), range(2)))
    assert [answer for answer, _ in answers] == [RIGHT, RIGHT]
    assert sum(compiled for _, compiled in answers) == 3
    assert not list(tmp_path.rglob("*.lock"))


def test_a_part_that_is_gone_is_compiled_again_and_not_the_loop_that_calls_it(copied: Path) -> None:
    files = list(copied.rglob("parts.added.separate-*"))
    for file in files:
        file.unlink()
    assert ask(copied) == (RIGHT, 1)
    assert sorted(copied.rglob("parts.added.separate-*")) == sorted(files)


def test_machine_code_that_was_cut_off_is_compiled_again(copied: Path) -> None:
    for file in copied.rglob("*.nbc"):
        file.write_bytes(file.read_bytes()[:100])
    for file in copied.rglob("*fourfold*.nbi"):
        file.write_bytes(b"")
    assert ask(copied) == (RIGHT, 3)
    assert ask(copied) == (RIGHT, 0)


def test_the_digest_covers_what_loops_are_made_of() -> None:
    assert len(sources.digest()) == 32


def test_a_user_without_a_home_has_no_cache_folder(monkeypatch: pytest.MonkeyPatch) -> None:
    def homeless(cls: type[Path]) -> Path:
        raise RuntimeError("Could not determine home directory.")

    for name in ("PIN_METAIK_CACHE", "XDG_CACHE_HOME"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(Path, "home", classmethod(homeless))
    assert cache_folder() is None
    monkeypatch.setenv("PIN_METAIK_CACHE", "elsewhere")
    assert cache_folder() == Path("elsewhere")
