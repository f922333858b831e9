"""Programs that compare two trees: walks through the code are counted, answers have digests."""

import importlib
from pathlib import Path

import pytest

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"
FOUR = 4  # calls of a plain pose


def test_a_plain_pose_takes_few_python_calls(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.syspath_prepend(BENCHMARKS)
    walks = importlib.import_module("walks")
    name, walk = next(walks.walks(tmp_path))
    count = walks.counted(walk)
    assert name == "`solve_ik(chain, SE3)`, arm with a closed form"
    assert (count.calls, count.rooms, count.stays) == (FOUR, FOUR, FOUR)
    assert count.order[0] == "ik/solve.py"


def test_two_fingerprints_of_a_tree_are_equal_and_another_answer_is_told(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.syspath_prepend(BENCHMARKS)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    prints = importlib.import_module("fingerprint")
    for name, some in {"ARMS": ("ur5",), "SOME_SIX": (), "OTHERS": ("cobra600",), "FAMILIES": ("random",)}.items():
        monkeypatch.setattr(prints, name, some)
    monkeypatch.setattr(prints, "scene_names", lambda: ["table"])
    first, second = prints.fingerprint(0.003), prints.fingerprint(0.003)
    assert list(first) == [
        "solve_ik/ur5/random", "solve_ik/ur5/parts", "solve_ik_all/ur5", "solve_ik_all/cobra600", "solve_ik_path/ur5",
        "world/table",
    ]  # fmt: skip
    assert list(prints.differences(first, second)) == []
    group = second["solve_ik/ur5/random"]
    group["answers"][0], group["digest"] = "STOPPED 00000000", "00000000"
    told = "solve_ik/ur5/random: 1 of 3 answers differ: 1 SOLVED -> STOPPED"
    assert list(prints.differences(second, first)) == [told]
