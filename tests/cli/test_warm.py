"""``pin-metaik warm``: everything compiled ahead, once."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from pin_metaik.compiled import ahead, sources

FEW = {"distances", "stopping", "exact_pose", "seen_from"}  # quick to compile; one of them in two versions


def warm(folder: Path, *arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
    given = {key: value for key, value in os.environ.items() if key != "NUMBA_CACHE_DIR"}
    return subprocess.run(
        [sys.executable, "-m", "pin_metaik", "warm", *arguments],
        env={**given, "PYTHONPATH": str(folder), **environment},
        cwd=folder,
        capture_output=True,
        text=True,
    )


@pytest.mark.slow
def test_what_is_missing_is_compiled_and_then_everything_left_alone(tmp_path: Path) -> None:
    loops, missing = ahead.versions()
    whole = warm(sources.PACKAGE.parent)  # compiles every loop, unless that was done before
    assert whole.returncode == 0 and f"{len(loops)} loops" in whole.stdout, whole.stderr
    shutil.copytree(sources.PACKAGE, tmp_path / "pin_metaik")
    shutil.copy(sources.PACKAGE.parent / "pin_metaik_command.py", tmp_path)
    for code in (tmp_path / "pin_metaik").rglob("*.nb[ci]"):
        if code.name.split(".")[1].rpartition("-")[0] in FEW:
            code.unlink()
    first, second = warm(tmp_path), warm(tmp_path, "--robot", "ur5")
    assert first.returncode == second.returncode == 0, first.stderr + second.stderr
    few = sum(loop.name in FEW for loop in loops)
    assert len(FEW) < few < 10
    assert first.stdout.startswith(f"compiled {few} of {len(loops)} loops in ")
    assert second.stdout.startswith(f"all {len(loops)} loops are there\n")
    assert "meshes of ur5" in second.stdout and "compiling" not in second.stderr
    assert second.stdout.count("left out") == len(missing)


def test_where_nothing_can_be_kept_nothing_is_begun(tmp_path: Path) -> None:
    shutil.copytree(sources.PACKAGE, tmp_path / "pin_metaik", ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(sources.PACKAGE.parent / "pin_metaik_command.py", tmp_path)
    for folder in {path.parent for path in (tmp_path / "pin_metaik").rglob("*.py")}:
        (folder / "__pycache__").touch()  # a file where the folder would be
    nowhere = dict.fromkeys(("HOME", "XDG_CACHE_HOME", "NUMBA_CACHE_DIR", "PIN_METAIK_CACHE"), os.devnull)
    done = warm(tmp_path, **nowhere)
    assert done.returncode == 2 and "set NUMBA_CACHE_DIR" in done.stderr
    assert "compiling" not in done.stderr
