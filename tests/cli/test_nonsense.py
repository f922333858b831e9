"""Whatever a command is given: an answer, or one line that says what would have worked, and never a traceback."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from numpy.testing import assert_allclose

from tests.cli.calls import caller

READY = "from pin_metaik.cli import run; print('ready', flush=True); run()"
POSE = ("--position", "0.3", "0.3", "0.4")
TWO_LINKS = """<robot name="two"><link name="base"/><link name="arm"><collision><geometry><mesh filename="{mesh}"/>
</geometry></collision></link><joint name="j" type="revolute"><parent link="base"/><child link="arm"/>
<axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>"""


@pytest.fixture
def call(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]):
    """Calls the command as its entry point does, in a folder with a file, a folder and odd robots."""
    monkeypatch.chdir(tmp_path)
    Path("folder").mkdir()
    Path("file").write_text("x")
    Path("empty.urdf").write_text("")
    Path("binary.urdf").write_bytes(bytes(range(256)))
    Path("nan.obj").write_text("v 0 0 0\nv nan 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n")
    Path("nan.urdf").write_text(TWO_LINKS.format(mesh="nan.obj"))
    Path("lost.urdf").write_text(TWO_LINKS.format(mesh="no.stl"))
    Path("scene.json").write_text('{"obstacles": []}')

    return caller(monkeypatch, capsys)


NONSENSE: list[tuple[tuple[object, ...], str]] = [
    (("export", "panda", "-o", "arm.c"), "has no finite set of solutions to write"),
    (("export", "aerial_arm", "-o", "arm.py"), "has no closed form to write"),
    (("export", "ur5", "-o", "arm.f90"), "the suffix gives the language"),
    (("solve", "ur5", *POSE, "--frame", ""), "no frame named ''"),
    (("solve", "ur5", *POSE, "--refiner", "lma"), "did you mean 'lm'"),
    (("solve", "ur5", *POSE, "--lock", "elbow"), "did you mean 'elbow_joint'"),
    (("solve", "ur5", *POSE, "--q0", "1,2"), r"shape (6,)"),
    (("solve", "ur5", *POSE, "--q0", "elbow_joint=x"), "'x' is not a number"),
    (("solve", "ur5", *POSE, "--q0", "elbow=1"), "did you mean 'elbow_joint'"),
    (("solve", "ur5", *POSE, "--q0", "elbow_joint=1,2"), "JOINT=VALUE for some joints or all entries"),
    (("solve", "ur5", *POSE, "--q0", "nan,0,0,0,0,0"), "finite numbers, got 'nan'"),
    (("solve", "ur5", *POSE, "--q0", "elbow_joint=inf"), "finite numbers, got 'inf'"),
    (("solve", "ur5", *POSE, "--allow", "a,b"), "--world"),
    (("solve", "ur5", *POSE, "--srdf", "file"), "--world"),
    (("solve", "ur5", *POSE, "--world", "alone", "--allow", "a"), "two names"),
    (("solve", "ur5", *POSE, "--world", "alone", "--allow", "arm,tool0"), "no body named 'arm'"),
    (("solve", "ur5", *POSE, "--world", "alone", "--srdf", "file"), "file"),
    (("solve", "ur5", *POSE, "--world", "alone", "--margin", "nan"), "margin"),
    (("solve", "ur5", *POSE, "--world", "nowhere"), "nowhere"),
    (("solve", "ur5", "--position", "1e999", "0", "0"), "finite"),
    (("solve", "ur5", "--goal", "lok_at frame=tool0 point=1,0,0"), "did you mean 'look_at'"),
    (("solve", "ur5", "--goal", "look_at frame=tool0"), "look_at: point is missing"),
    (("solve", "ur5", "--goal", "look_at frame=tool0 pont=1,0,0"), "did you mean 'point'"),
    (("solve", "ur5", "--goal", "look_at frame=tool0 point=1,0"), "expected shape (3,)"),
    (("solve", "ur5", "--goal", "look_at frame"), "NAME=VALUE"),
    (("solve", "ur5", "--goal", ""), "no kind of goal named ''"),
    (("solve", "ur5", "--goal", "look_at frame=base_link point=1,0,1"), "moves frame 'base_link'"),
    (("solve", "ur5", *POSE, "--wish", "mid_range share=2"), "share is from 0 to 1"),
    (("solve", "ur5", *POSE, "--goals", "none.toml"), "none.toml"),
    (("solve", "ur5", *POSE, "--goals", "file"), "is not TOML"),
    (("solve", "ur5", *POSE, "--base", "wheels"), "no base named 'wheels'; known: fixed, free-flyer, planar"),
    (("solve", "ur5", *POSE, "--base", "planar"), "root_joint.x"),
    (("solve", "ur5", *POSE, "--limit", "elbow_joint=1"), "JOINT=LEAST,MOST"),
    (("solve", "ur5", *POSE, "--limit", "elbow=1,2"), "limits given for 'elbow'"),
    (("solve", "folder", *POSE), "folder"),
    (("solve", "file", *POSE), "file"),
    (("solve", "empty.urdf", *POSE), "empty.urdf"),
    (("solve", "binary.urdf", *POSE), "binary.urdf"),
    (("solve", "nan.urdf", *POSE, "--world", "alone"), "vertices that are not finite"),
    (("solve", "lost.urdf", *POSE, "--world", "alone"), "no.stl"),
    (("urdf", "ur5", "-o", "folder"), "it is a folder"),
    (("urdf", "ur5", "-o", "none/x.urdf"), "there is no folder none"),
    (("urdf", "--all", "-o", "file"), "is a file, not a folder"),
    (("plan", "scene.json"), "--start X Y"),
    (("plan", "ten_obstacles", "--out", "file"), "is a file, not a folder"),
    (("plan", "ten_obstacles", "--radius", "nan"), "radius"),
    (("plan", "ten_obstacles", "--start", "nan", "0"), "start"),
    (("reproduce", "rv7fl", "--out", "file/deeper"), "is a file, not a folder"),
    (("reproduce", "nothing"), "no paper named 'nothing'"),
    (("compare", "--robot", "ur5", "--cases", "random", "--methods", "lm", "--out", "o", "--jobs", "0"), "jobs"),
    (("compare", "--robot", "ur5", "--cases", "random", "--methods", "lm", "--out", "file/o"), "not a folder"),
    (("compare", "--robot", "ur5", "--cases", "a:b", "--methods", "lm", "--out", "o"), "a:b"),
    (("report", "folder"), "holds no comparison"),
    (("report", "file"), "holds no comparison"),
    (("replay", "folder", "x"), "holds no comparison"),
    (("stewart", "analyse", "file"), "no mechanism named 'file'"),
    (("stewart", "analyse", "stroke_50", "--picture", "none/x.png"), "there is no folder none"),
    (("stewart", "analyse", "stroke_50", "--picture", "x.txt"), ".png, .svg, .pdf"),
    (("stewart", "design", "stroke_50", "-o", "folder"), "it is a folder"),
    (("stewart", "show", "stroke_50", "--urdf", "none/x.urdf"), "there is no folder none"),
]


@pytest.mark.parametrize(("words", "says"), NONSENSE, ids=[" ".join(map(str, words)) for words, _ in NONSENSE])
def test_a_call_that_makes_no_sense_is_one_line_and_exit_code_two(call, words: tuple[object, ...], says: str) -> None:
    code, out, error = call(*words)
    assert code == 2, error
    assert says in error
    assert "Traceback" not in error
    assert out == ""


def test_an_error_of_the_system_names_its_file(call, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(self: Path, *_: object, **__: object) -> None:
        raise OSError(28, "No space left on device", str(self))

    monkeypatch.setattr(Path, "write_text", full)
    code, _, error = call("urdf", "rv7fl", "-o", "new.urdf")
    assert code == 2
    assert error == "pin-metaik: new.urdf: No space left on device\n"


def test_the_version_is_told(call) -> None:
    code, out, _ = call("--version")
    assert code == 0
    assert out.startswith("pin-metaik 0.")


def test_json_says_versions_units_and_why(call) -> None:
    for words, unit, said in ((POSE, "rad", 0), (("--position", 3, 0, 0, "--degrees"), "deg", 1)):
        code, out, _ = call("solve", "ur5", *words, "--json")
        answer = json.loads(out)
        assert code == said
        assert answer["units"]["angle"] == unit
        assert answer["why"]
        assert {"pin_metaik", "pin", "coal", "numpy"} <= answer["versions"].keys()


@pytest.mark.parametrize(
    "words",
    [
        ("plan", "ten_obstacles"),
        ("stewart", "analyse", "stroke_50", "--cells", "8"),
        ("stewart", "forward", "stroke_50", *("200",) * 6),
        ("stewart", "follow", "stroke_50", "way.csv"),
        ("stewart", "design", "stroke_50", "--evaluations", "20"),
        ("stewart", "types", "stroke_50", "--evaluations", "20", "--runs", "1"),
    ],
    ids=lambda words: " ".join(words[:2]),
)
def test_every_json_says_versions_and_units(call, words: tuple[str, ...]) -> None:
    Path("way.csv").write_text("time,x,y,z\n0,0,0,200\n1,0,0,205\n")
    answer = json.loads(call(*words, "--json")[1])
    assert {"pin_metaik", "pin", "coal", "numpy"} <= answer["versions"].keys()
    assert answer["units"]["angle"] == "rad"


def test_a_warning_is_one_line_without_a_place_in_our_code(call) -> None:
    Path("weak.urdf").write_text(TWO_LINKS.format(mesh="nan.obj").replace('effort="1"', 'effort="-1"'))
    code, _, error = call("solve", "weak.urdf", "--position", "0", "0", "0")
    assert code == 0
    assert error == "warning: two: joint 'j' has effort = -1: taken as 1\n"


def test_locked_joints_stay_where_the_start_has_them(call) -> None:
    words = ("--lock", "wrist_3_joint", "--lock", "wrist_2_joint", "--q0", "wrist_3_joint=90,wrist_2_joint=-45")
    answer = json.loads(call("solve", "ur5", *POSE, *words, "--degrees", "--json")[1])
    assert answer["status"] == "SOLVED"
    assert "wrist_3_joint" not in answer["joints"]
    assert_allclose(answer["q"][4:], [-45.0, 90.0], atol=1e-9)
    entries = json.loads(call("solve", "ur5", *POSE, "--q0", "-0.1,-1,1,0.1,0.1,0.1", "--json")[1])
    assert entries["status"] == "SOLVED"


def test_pairs_that_may_collide_are_left_alone(call) -> None:
    straight = ("--position", "0.1", "0.0", "0.3", "--world", "alone", "--json")
    answer = json.loads(call("solve", "ur5", *straight, "--allow", "forearm_link,base_link")[1])
    assert answer["status"] == "SOLVED"


def test_degrees_given_as_radians_are_asked_about(call) -> None:
    assert "--degrees" in call("solve", "ur5", *POSE, "--rpy", 0, 90, 0)[2]
    assert "positions are in metres" in call("solve", "ur5", "--position", 300, 300, 400)[1]
    assert "--degrees" not in call("solve", "ur5", *POSE, "--rpy", 0, 1.5, 0)[2]


def test_robots_can_be_filtered(call) -> None:
    listed = call("robots", "PANDA")[1]
    assert "panda" in listed
    assert "ur5" not in listed


def test_the_list_of_commands_has_whole_sentences(call) -> None:
    out = call("--help")[1]
    assert "e.g.\n" not in out


@pytest.mark.parametrize(
    "command", [("plan", "ten_obstacles", "--method", "de", "--evaluations", "100000000"), ("demo",)]
)
def test_control_c_ends_with_130(command: tuple[str, ...]) -> None:
    done = subprocess.Popen(
        [sys.executable, "-c", READY, *command], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert done.stdout is not None
    assert done.stdout.readline() == "ready\n"
    time.sleep(0.5)
    if done.poll() is not None:
        pytest.skip("it was over before it could be interrupted")
    done.send_signal(signal.SIGINT)
    _, error = done.communicate(timeout=300)
    assert done.returncode in (130, -signal.SIGINT)  # the same to a shell; the latter while Python ends
    assert "Traceback" not in error
