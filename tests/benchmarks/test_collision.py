"""The benchmark of collisions runs, and writes what it measured."""

import subprocess
import sys
from pathlib import Path

import pytest

BENCHMARK = Path(__file__).parents[2] / "benchmarks" / "collision.py"
ORACLE = BENCHMARK.with_name("collision_oracle.py")


@pytest.mark.slow
def test_it_measures_every_section(tmp_path: Path) -> None:
    out = tmp_path / "collision.md"
    words = ["--robots", "panda", "--configurations", "20", "--safety", "50", "--targets", "3", "--out", str(out)]
    done = subprocess.run([sys.executable, str(BENCHMARK), *words], capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    page = out.read_text()
    for section in ("Checking time", "Safety", "Free of self-collision", "Among obstacles", "Each method on its own"):
        assert f"## {section}" in page
    assert "| shelf | panda |" in page


@pytest.mark.slow
def test_the_oracle_finds_nothing_missed_or_invented(tmp_path: Path) -> None:
    out = tmp_path / "oracle.md"
    words = ["--configurations", "25", "--thin", "10", "--boxes", "10", "--batch", "20000", "--out", str(out)]
    done = subprocess.run([sys.executable, str(ORACLE), *words], capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    rows = [line.split(" | ") for line in out.read_text().splitlines() if "%" in line]
    assert len(rows) == 11
    assert all(set(cell.strip(" |")) <= set("0, ") for row in rows for cell in row[3:])
    assert "| 10 |" in out.read_text()
