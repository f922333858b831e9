"""``pin-metaik warm``: everything compiled ahead, once."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from pin_metaik.compiled import ahead, sources


def warm(folder: Path, *arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "pin_metaik", "warm", *arguments],
        env={**os.environ, "PYTHONPATH": str(folder), **environment},
        cwd=folder,
        capture_output=True,
        text=True,
    )


@pytest.mark.slow
def test_every_loop_is_compiled_and_then_left_alone() -> None:
    loops, missing = ahead.versions()
    first, second = warm(sources.PACKAGE.parent), warm(sources.PACKAGE.parent, "--robot", "ur5")
    assert first.returncode == second.returncode == 0, first.stderr + second.stderr
    assert f"{len(loops)} loops" in first.stdout
    assert second.stdout.startswith(f"all {len(loops)} loops are there\n")
    assert "meshes of ur5" in second.stdout and second.stderr == ""
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
