"""Goals on the command line: in words, in a file, on a base that drives, and of a robot with a loop."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import pin_metaik as mik
from pin_metaik import goals
from pin_metaik.cli.goals import SPELLED, read_goals
from tests.cli.calls import caller
from tests.ik.goals.test_loop import gripper

LOOKS = "look_at frame=tool0 point=1,0,0.5 tolerance=0.01"
WORDS = {  # a goal of every kind that can be spelled
    "centre_of_mass": "centre_of_mass polygon=-1,-1;1,-1;1,1;-1,1 margin=0.1",
    "distance": "distance frame=tool0 point=0,0,0 least=0.3",
    "frame_pose": "frame_pose frame=wrist_1_link pose=0.3,0.3,0.4,0,1.5,0 orientation_tolerance=inf",
    "in_box": "in_box frame=tool0 lower=0,0,0 upper=1,1,inf",
    "look_at": LOOKS,
    "manipulability": "manipulability frame=tool0 least=0.01 of=position",
    "mid_range": "mid-range share=0.9",
    "on_line": "on_line frame=tool0 point=0,0,0.4 direction=1,1,0 least=0.2 most=0.5",
    "on_plane": "on-plane frame=tool0 point=0,0,0.4 normal=z",
    "pointing": "pointing frame=tool0 axis=z direction=-z",
    "pose": "pose pose=0.3,0.3,0.4 frame=tool0",
    "posture": "posture joints.elbow_joint=1.0 joints.wrist_1_joint=-1,0",
}


@pytest.fixture
def call(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]):
    """Calls the command as its entry point does, in a folder of its own."""
    monkeypatch.chdir(tmp_path)
    return caller(monkeypatch, capsys)


def test_every_kind_of_goal_that_has_no_code_in_it_can_be_spelled_and_solved() -> None:
    assert set(WORDS) == set(SPELLED)
    chain = mik.Chain(mik.load_robot("ur5"), "tool0")
    for kind, words in WORDS.items():
        (goal,) = read_goals([words], [], None)
        assert isinstance(goal, goals.GOALS[kind])
        assert mik.solve_ik(chain, goal).success, words


def test_goals_in_words_and_in_a_file_are_the_same_and_are_met(call) -> None:
    Path("goals.toml").write_text(
        '[[goal]]\nkind = "look_at"\nframe = "tool0"\npoint = [1, 0, 0.5]\ntolerance = 0.01\n'
        '[[wish]]\nkind = "posture"\nweight = 2\njoints = {elbow_joint = 1.0}\n'
    )
    spelled = ("--goal", LOOKS, "--wish", "posture joints.elbow_joint=1.0 weight=2")
    answers = []
    for words in (spelled, ("--goals", "goals.toml")):
        code, out, error = call("solve", "ur5", "--position", 0.3, 0.3, 0.4, *words, "--json")
        assert code == 0, error
        answers.append(json.loads(out))
    assert answers[0]["q"] == answers[1]["q"]
    assert [one["goal"] for one in answers[0]["goals"]] == ["Target of tool0", "LookAt of tool0"]
    assert [one["goal"] for one in answers[0]["wishes"]] == ["Posture"]
    code, out, _ = call("solve", "ur5", "--tip", "wrist_3_link", *spelled)
    assert code == 0
    assert "wish Posture by" in out
    code, out, _ = call(
        "solve", "ur5", "--evaluations", 500, "--goal", LOOKS, "--goal", "distance frame=tool0 point=1,0,0.5 least=9"
    )
    assert code == 1
    assert "Distance of tool0 by" in out


def test_a_base_drives_within_the_limits_that_are_given(call) -> None:
    there = ("--position", 1.5, 1.0, 0.8, "--goal", "pointing frame=arm_7_link axis=z direction=-z tolerance=0.1")
    limits = ("--limit", "root_joint.x=-2,2", "--limit", "root_joint.y=-2,2")
    code, out, error = call("solve", "tiago", "--base", "planar", *limits, *there, "--json")
    assert code == 0, error
    joints = json.loads(out)["joints"]
    assert np.hypot(joints["root_joint.x"], joints["root_joint.y"]) > 0.3


def test_loops_of_a_file_stay_closed(call) -> None:
    Path("gripper.xml").write_text(gripper())
    code, out, error = call("solve", "gripper.xml", "--tip", "finger", "--position", 0.04, 0, 0.25, "--json")
    assert code == 0, error
    answer = json.loads(out)
    assert answer["joints"]["crank"] == pytest.approx(answer["joints"]["rocker"], abs=1e-3)
    assert "Loop of coupler" in [one["goal"] for one in answer["goals"]]
