"""What benchmarks/robot_coverage.py measures, small."""

from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

import pin_metaik as mik

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"


def test_a_robot_of_six_joints_is_covered_and_its_row_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(BENCHMARKS))
    measured = import_module("robot_coverage")
    (name,) = (robot for robot in mik.robot_names() if robot == "ur5")
    found = measured.coverage(name, 20, 5)
    assert (found.joints, found.closed_form, found.solved, found.decided) == (6, True, 1.0, 1.0)
    assert 0.0 < found.us < 1e5 and found.pairs > 5 and np.isfinite(found.check)
    assert "| ur5 | example-robot-data | 6 | 6 | `tool0` | yes | 100.0% |" in measured.page([found], 20, 5)
