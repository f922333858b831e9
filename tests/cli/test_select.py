"""A choice among solutions on the command line, with joints that count more than others."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from tests.cli.calls import caller

POSE = ("--position", 0.3, 0.3, 0.4, "--rpy", 0, 1.5, 0)


@pytest.fixture
def call(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]):
    """Calls the command as its entry point does, in a folder of its own."""
    monkeypatch.chdir(tmp_path)
    return caller(monkeypatch, capsys)


def test_a_joint_that_counts_more_moves_less(call) -> None:
    moved = []
    for weight in ((), ("--weight", "elbow_joint=50")):
        code, out, error = call("solve", "ur5", *POSE, "--select", "nearest", *weight, "--json")
        assert code == 0, error
        moved.append(np.array(list(json.loads(out)["joints"].values())))
    assert abs(moved[1][2]) < abs(moved[0][2]) - 0.1
    assert np.linalg.norm(moved[0]) < np.linalg.norm(moved[1])


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("--select", "nearst"), "did you mean 'nearest'"),
        (("--select", "clearance", "--weight", "elbow_joint=2"), "limits, nearest, torque"),
        (("--select", "nearest", "--weight", "elbow_joint"), "--weight takes JOINT=WEIGHT"),
        (("--select", "nearest", "--weight", "elbow=2"), "elbow_joint"),
        (("--weight", "elbow_joint=2"), "limits, nearest, torque"),
    ],
)
def test_a_choice_that_makes_no_sense_is_refused_by_name(call, words: tuple[str, ...], says: str) -> None:
    code, _, error = call("solve", "ur5", *POSE, *words)
    assert code == 2 and says in error
