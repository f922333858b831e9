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

# A pose off by nothing, seen by two loops, and how many of the two were compiled.
ASK = """
import numpy as np, pin_metaik as mik
chain = mik.Chain(mik.load_robot("ur5").model, "tool0")
x = np.full(6, 0.3)
problem = mik.IKProblem.of(chain, chain.placements(chain.q(x))[0])
cost, residual = problem.costs(x[None])[0], np.abs(problem.linearize(x)[0]).max()
loops = [loop.compiled() for loop in (chain.kernels.costs, chain.kernels.linearize)]
print(cost, residual, sum(sum(loop.stats.cache_misses.values()) for loop in loops))
"""
SHIP = """
import pin_metaik
from pin_metaik.compiled import ahead, on_disk
for name in ("costs", "linearize"):
    ahead.Version("pin_metaik.kinematics.kernel.goals", name, False).ship(on_disk.SHIPPED)
"""
NOWHERE = {"HOME": os.devnull, "XDG_CACHE_HOME": os.devnull, "NUMBA_CACHE_DIR": os.devnull}
PART, CHANGED = "    pose[9] = px +", "    pose[9] = 0.1 + px +"


@pytest.fixture
def copied(tmp_path: Path) -> Path:
    """A folder with a copy of the package and of the machine code beside it, which is complete for ``ASK``."""
    ask(sources.PACKAGE.parent)
    return shutil.copytree(sources.PACKAGE, tmp_path / "copy" / "pin_metaik").parent


def ask(folder: Path, **environment: str) -> tuple[float, float, float]:
    """What ``ASK`` prints when the package is that in ``folder``."""
    given = {**os.environ, "PYTHONPATH": str(folder), **environment}
    if not environment:
        given.pop("NUMBA_CACHE_DIR", None)
    done = subprocess.run([sys.executable, "-c", ASK], env=given, cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    cost, residual, compiled = done.stdout.split()
    return float(cost), float(residual), int(compiled)


def test_a_change_of_a_part_is_seen_by_every_loop_that_has_it(copied: Path) -> None:
    *exact, compiled = ask(copied)
    assert max(exact) < 1e-12 and compiled == 0
    kernels = copied / "pin_metaik" / "kinematics" / "kernel" / "forward.py"
    text = kernels.read_text()
    assert PART in text
    kernels.write_text(text.replace(PART, CHANGED))
    cost, residual, compiled = ask(copied)
    assert cost == pytest.approx(0.1) and residual == pytest.approx(0.1) and compiled == 2


def test_machine_code_that_lies_beside_the_package_is_used_where_nothing_can_be_written(copied: Path) -> None:
    folders = list(copied.rglob("__pycache__"))
    for folder in folders:
        folder.chmod(0o555)
    assert ask(copied, HOME=os.devnull, XDG_CACHE_HOME=os.devnull)[2] == 0


def test_without_any_folder_to_keep_it_in_everything_is_compiled(copied: Path) -> None:
    shutil.rmtree(copied / "pin_metaik" / "kinematics" / "kernel" / "__pycache__")
    (copied / "pin_metaik" / "kinematics" / "kernel" / "__pycache__").touch()  # a file where the folder would be
    *exact, compiled = ask(copied, **NOWHERE)
    assert max(exact) < 1e-12 and compiled == 2


def test_machine_code_that_a_wheel_carries_is_used_until_a_source_changes(tmp_path: Path) -> None:
    bare = shutil.ignore_patterns("__pycache__")
    shutil.copytree(sources.PACKAGE, tmp_path / "built" / "pin_metaik", ignore=bare)
    processor = baseline.baseline()
    assert processor is not None, "this machine is older than the baseline"
    there = {"PYTHONPATH": str(tmp_path / "built"), "NUMBA_CACHE_DIR": str(tmp_path / "parts")}
    cpu = {"NUMBA_CPU_NAME": processor.name, "NUMBA_CPU_FEATURES": ""}
    subprocess.run([sys.executable, "-c", SHIP], env={**os.environ, **there, **cpu}, cwd=tmp_path / "built", check=True)
    shutil.copytree(tmp_path / "built" / "pin_metaik", tmp_path / "site" / "pin_metaik", ignore=bare)
    *exact, compiled = ask(tmp_path / "site", **NOWHERE)
    assert max(exact) < 1e-12 and compiled == 0
    with (tmp_path / "site" / "pin_metaik" / "kinematics" / "kernel" / "forward.py").open("a") as kernels:
        kernels.write("# changed\n")
    *exact, compiled = ask(tmp_path / "site", **NOWHERE)
    assert max(exact) < 1e-12 and compiled == 2


def test_code_for_the_baseline_needs_every_one_of_its_instructions() -> None:
    for processor in (baseline.X86_64_V3, baseline.ARMV8, baseline.APPLE_M1):
        every = dict.fromkeys(processor.instructions, True)
        assert processor.fits({**every, "another": False})
        for instruction in every:
            assert not processor.fits({**every, instruction: False})


def test_two_processes_that_start_at_once_compile_each_loop_once(tmp_path: Path) -> None:
    shutil.copytree(sources.PACKAGE, tmp_path / "pin_metaik", ignore=shutil.ignore_patterns("__pycache__"))
    with ThreadPoolExecutor(2) as threads:
        answers = list(threads.map(lambda _: ask(tmp_path), range(2)))
    assert sum(compiled for *_, compiled in answers) == 2
    assert not list(tmp_path.rglob("*.lock"))


def test_machine_code_that_was_cut_off_is_compiled_again(copied: Path) -> None:
    for file in copied.rglob("*.nbc"):
        file.write_bytes(file.read_bytes()[:100])
    for file in copied.rglob("*linearize*.nbi"):
        file.write_bytes(b"")
    *exact, compiled = ask(copied)
    assert max(exact) < 1e-12 and compiled == 2
    assert ask(copied)[2] == 0


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
