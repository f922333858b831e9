"""The benchmark of goals runs, and writes what it measured."""

import subprocess
import sys
from pathlib import Path

import pytest

BENCHMARK = Path(__file__).parents[2] / "benchmarks" / "goals.py"


@pytest.mark.slow
def test_it_measures_every_section(tmp_path: Path) -> None:
    out = tmp_path / "goals.md"
    words = ["--count", "2", "--robots", "panda", "--out", str(out)]
    done = subprocess.run([sys.executable, str(BENCHMARK), *words], capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    page = out.read_text()
    for section in ("Alone and together", "Targets at the edge of a radius", "Wishes"):
        assert f"## {section}" in page
    assert "| cup upright at a place | 100 % | 100 % |" in page
