"""Every example runs, quickly, and has something to say."""

import subprocess
import sys
from pathlib import Path

import pytest

SMALLER = {"12_screen_grasps": ["12"]}  # arguments with which they are quick
EXAMPLES = sorted((Path(__file__).parent.parent / "examples").glob("[0-9]*.py"))


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_example_runs(example: Path, tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, example, *SMALLER.get(example.stem, [])],
        capture_output=True,
        text=True,
        timeout=300,
        cwd=tmp_path,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip()
