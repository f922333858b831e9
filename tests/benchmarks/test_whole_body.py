"""The benchmark of whole bodies runs, and every problem it makes is solved and verified."""

import subprocess
import sys
from pathlib import Path

import pytest

BENCHMARK = Path(__file__).parents[2] / "benchmarks" / "whole_body.py"


@pytest.mark.slow
def test_a_humanoid_stands_balances_and_reaches(tmp_path: Path) -> None:
    out = tmp_path / "whole_body.md"
    words = ["--count", "5", "--pink", "0", "--out", str(out)]
    done = subprocess.run([sys.executable, str(BENCHMARK), *words], capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    assert "| pin_metaik | 5 | 100 % | 100 % |" in out.read_text()
