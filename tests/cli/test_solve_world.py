"""``pin-metaik solve --world``, as a user calls it."""

import json
from pathlib import Path

import pytest

from tests.cli.test_cli import call

POSE = ("--rpy", "0", "90", "0", "--degrees")
SCENE = '[[obstacle]]\nname = "box"\nshape = "box"\nsize = [0.2, 0.2, 0.2]\nposition = [{x}, 0.0, 0.4]\n'


def test_a_scene_is_avoided_and_what_collides_is_named(tmp_path: Path) -> None:
    scene = tmp_path / "scene.toml"
    scene.write_text(SCENE.format(x=0.45))
    done = call("solve", "ur5", "--position", "0.45", "0.0", "0.4", *POSE, "--world", str(scene), "--json")
    assert done.returncode == 1, done.stderr
    answer = json.loads(done.stdout)
    assert answer["status"] == "IN_COLLISION"
    assert "box" in {answer["collisions"][0]["first"], answer["collisions"][0]["second"]}
    assert answer["collisions"][0]["depth"] > 0.0
    scene.write_text(SCENE.format(x=-0.6))
    done = call("solve", "ur5", "--position", "0.45", "0.0", "0.4", *POSE, "--world", str(scene), "--margin", "0.01")
    assert done.returncode == 0, done.stderr
    assert "SOLVED" in done.stdout


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("--world", "kitchen"), "known: narrow_box, shelf, table"),
        (("--world", "kitchen.toml"), "cannot read kitchen.toml"),
        (("--margin", "0.1"), "give --world"),
        (("--world", "table", "--margin", "-1"), "margin"),
    ],
)
def test_worlds_that_make_no_sense_exit_with_two_and_no_traceback(words: tuple[str, ...], says: str) -> None:
    done = call("solve", "ur5", "--position", "0.45", "0.0", "0.4", *words)
    assert done.returncode == 2
    assert says in done.stderr
    assert "Traceback" not in done.stderr


def test_what_a_robot_looks_like_is_checked_unless_that_is_refused(tmp_path: Path) -> None:
    robot = tmp_path / "seen.urdf"
    box = '<visual><geometry><box size="0.8 0.1 0.1"/></geometry></visual>'
    robot.write_text(
        f'<robot name="seen"><link name="base">{box}</link><link name="arm">{box}</link>'
        '<joint name="j" type="revolute">'
        '<parent link="base"/><child link="arm"/><origin xyz="1 0 0"/><axis xyz="0 0 1"/>'
        '<limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>'
    )
    words = ("solve", str(robot), "--position", "1.0", "0.0", "0.0", "--world", "alone")
    done = call(*words)
    assert done.returncode == 0, done.stderr
    assert "its visual geometry is checked" in done.stderr
    done = call(*words, "--no-visual")
    assert done.returncode == 2
    assert "leaves out its visual geometry" in done.stderr
