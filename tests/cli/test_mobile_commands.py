"""``pin-metaik mobile`` and what ``plan`` and ``solve`` learned with it, as users call them."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from pin_metaik import mobile
from tests.cli.calls import Call, caller

MOVING = [{"way": [[0, 5, 0], [12, 5, 10]], "radius": 0.6}]


@pytest.fixture
def call(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Call:
    """Calls the command as its entry point does, in a folder of its own."""
    monkeypatch.chdir(tmp_path)
    Path("moving.json").write_text(json.dumps(MOVING))

    return caller(monkeypatch, capsys)


def test_a_scene_is_shown_drawn_and_written_before_planning(call: Call) -> None:
    code, out, _ = call("mobile", "show", "random:3:8:1.0", "-o", "scene.svg", "--save", "s.json", "--radius", 0.1)
    assert code == 0
    assert "concave ones       8" in out
    assert Path("scene.svg").stat().st_size > 1000
    again = json.loads(call("mobile", "show", "s.json", "--json")[1])
    assert again["obstacles"] == 8
    assert again["shortest_path"] > 12.0
    code, out, _ = call("mobile", "show", "ten_obstacles", "--radius", 3)
    assert code == 1
    assert "no way" in out


def test_every_setting_of_a_planner_and_of_its_fitness_is_reached(call: Call) -> None:
    words = ("plan", "ten_obstacles", "--evaluations", 600, "--json", "--method")
    for method, settings in {
        "ga": ("agents=30", "crossover_rate=0.8", "mutation_rate=0.3", "elites=2", "selection=tournament"),
        "pso": ("agents=20", "c1=1.5", "c2=1.7", "w_max=0.8", "w_min=0.3", "v_max=0.2", "variant=inertia"),
        "astar": ("cells=40",),
        "rrtstar": ("range=2.5", "goal_bias=0.2"),
        "prm": ("nearest=8",),
    }.items():
        options = [word for setting in settings for word in ("--set", setting)]
        set_so = json.loads(call(*words, method, *options)[1])["path"]
        usual = json.loads(call(*words, method)[1])["path"]
        assert set_so["method"] == usual["method"] == method
        assert set_so["path"] != usual["path"]
    dear = json.loads(call(*words, "pso", "--set", "fitness.penalty=0.0001", "--fitness", "paper")[1])["path"]
    assert dear["cost"] < 20.0


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("plan", "ten_obstacles", "--method", "ga", "--set", "agent=3"), "did you mean 'agents'"),
        (("plan", "ten_obstacles", "--method", "ga", "--set", "agents=few"), "agents must be a whole number"),
        (("plan", "ten_obstacles", "--method", "ga", "--set", "fitness.c=3"), "known: penalty"),
        (("plan", "ten_obstacles", "--set", "agents=3"), "the exact planner has no settings"),
        (("plan", "ten_obstacles", "--network", "x.npz"), "cannot read x.npz"),
        (("plan", "random:1:5:2"), "concave"),
        (("plan", "random:1:5:0.5:7"), "random:SEED:OBSTACLES:CONCAVE"),
        (("mobile", "show", "ten_obstacles", "-o", "x.txt"), ".png, .svg, .pdf"),
        (("mobile", "show", "nowhere"), "no scene named 'nowhere'"),
        (("mobile", "compare", "ten_obstacles", "--methods", "rrx"), "did you mean 'rrt'"),
        (("mobile", "compare", "ten_obstacles", "--methods", "ga", "--set", "pso.c1=1"), "name one of the planners"),
        (("mobile", "evolve", "ten_obstacles", "-o", "x.png", "--method", "rrt"), "rrt has no generations"),
        (("mobile", "evolve", "ten_obstacles", "-o", "x.mp4"), ".gif"),
        (("mobile", "drive", "ten_obstacles", "--at", 3), "go together"),
        (("mobile", "drive", "ten_obstacles", "--after", "x.json", "--at", 3), "cannot read x.json"),
        (("mobile", "drive", "ten_obstacles", "--from", 1, 1, 0, 9, 0), "speed must be a number from 0 to 1.016"),
        (("mobile", "curve", "--turning-radius", 1, "--from", 0, 0, 0), "both ends are needed"),
        (("mobile", "curve", "--turning-radius", 0, "--from", 0, 0, 0, "--to", 1, 1, 0), "turning_radius"),
        (("mobile", "moving", "ten_obstacles", "moving.json", "--speed", 0), "speed must be a number above 0"),
        (("mobile", "moving", "ten_obstacles", "none.json", "--speed", 1), "cannot read none.json"),
        (("mobile", "learn", "-o", "x.pkl"), ".npz"),
        (("mobile", "learn", "-o", "x.npz", "--trainer", "ml"), "did you mean 'lm'"),
        (("mobile", "learn", "-o", "x.npz", "--vehicle", "turtlebot3_burger"), "is not"),
        (("solve", "puma_offset", "--position", 8, 5, 12, "--set", "hh=1"), "did you mean 'h'"),
        (("solve", "puma_offset", "--position", 8, 5, 12, "--set", "h"), "NAME=VALUE"),
        (("solve", "ur5", "--position", 0.3, 0.3, 0.4, "--set", "h=1"), "only DH tables and xacro"),
        (("solve", "ur5", "--position", 0.3, 0.3, 0.4, "--picture", "x.txt"), ".png, .svg, .pdf"),
    ],
    ids=lambda words: " ".join(map(str, words)) if isinstance(words, tuple) else "",
)
def test_a_call_that_makes_no_sense_is_one_line_and_exit_code_two(
    call: Call, words: tuple[object, ...], says: str
) -> None:
    code, out, error = call(*words)
    assert code == 2, error
    assert says in error
    assert "Traceback" not in error
    assert out == ""


def test_planners_are_compared_in_one_table_with_pictures(call: Call) -> None:
    words = ("mobile", "compare", "ten_obstacles", "--methods", "exact", "rrt", "ga", "--runs", 2)
    code, out, _ = call(*words, "--evaluations", 300, "--set", "ga.agents=30", "--out", "o")
    assert code == 0
    assert [line.split()[1] for line in out.splitlines() if line.startswith(" ten_obstacles")] == ["exact", "rrt", "ga"]
    assert {"planners.md", "planners_paths.png", "planners_convergence.png"} <= {
        file.name for file in Path("o").iterdir()
    }
    answer = json.loads(call(*words, "--evaluations", 300, "--json")[1])
    assert len(answer["runs"]) == 5
    alone = json.loads(call("plan", "ten_obstacles", "--method", "ga", "--rng", 1, "--evaluations", 300, "--json")[1])
    assert alone["path"]["path"] == answer["runs"][-1]["path"]


@pytest.mark.parametrize("file", ["steps.png", "steps.gif"])
def test_generations_are_stepped_through_in_pictures(call: Call, file: str) -> None:
    words = ("mobile", "evolve", "ten_obstacles", "--evaluations", 300, "--steps", 3, "--method", "pso")
    code, out, _ = call(*words, "-o", file)
    assert code in (0, 1)
    assert "300 evaluations" in out
    assert Path(file).stat().st_size > 5000


def test_a_plan_is_stopped_on_its_way_and_planned_again_without_a_jump(call: Call) -> None:
    assert call("plan", "random:3:8", "--trajectory", "dp", "--out", "first", "--no-figures")[0] == 0
    before = mobile.load_trajectory("first/trajectory.json").state(4.0)
    words = ("mobile", "drive", "first/scene.json", "--after", "first/trajectory.json", "--at", 4.0)
    code, out, _ = call(*words, "--out", "second", "--ros", "path.json")
    assert code == 0
    assert "with a stop at every corner" in out
    after = mobile.load_trajectory("second/trajectory.json").state(0.0)
    names = ("x", "y", "heading", "v", "omega")
    assert_allclose([getattr(after, n) for n in names], [getattr(before, n) for n in names], atol=1e-9)
    assert Path("second/trajectory.png").exists()
    assert len(json.loads(Path("path.json").read_text())["poses"]) > 50


def test_a_drive_begins_and_ends_with_the_heading_and_speed_it_is_told(call: Call) -> None:
    words = ("mobile", "drive", "random:3:4", "--from", 1, 1, 90, 0.4, 5, "--to", 9, 9, 0, 0.2, "--json")
    answer = json.loads(call(*words)[1])["trajectory"]
    motion = mobile.Trajectory([_phase(row) for row in answer["phases"]], tuple(answer["start"]), answer["v"])
    assert answer["success"]
    begin, end = motion.state(0.0), motion.state(motion.duration)
    assert_allclose((begin.x, begin.y, begin.heading, begin.v), (1, 1, np.pi / 2, 0.4), atol=1e-9)
    assert_allclose((end.x, end.y, np.sin(end.heading), end.v), (9, 9, 0, 0.2), atol=1e-6)


def _phase(row: list[float]) -> mobile.motion.trajectory.Phase:
    return mobile.motion.trajectory.Phase(*row)


def test_curves_of_cars_in_the_open_and_among_obstacles(call: Call) -> None:
    open_plane = ("mobile", "curve", "--turning-radius", 5, "--from", 0, 0, 0, "--to", 0, 2, 0)
    parked = json.loads(call(*open_plane, "--reverse", "--json")[1])["curve"]
    forwards = json.loads(call(*open_plane, "--json")[1])["curve"]
    assert parked["length"] < forwards["length"]
    assert len(parked["cusps"]) == 2
    code, out, _ = call(
        *("mobile", "curve", "random:3:5", "--turning-radius", 0.6, "--footprint", 0.8, 0.4, "--from", 0.6, 0.6, 0),
        *("-o", "curve.csv", "--picture", "curve.png", "--ros", "curve.yaml"),
    )
    assert code == 0
    assert "reverses never" in out
    assert all(Path(f"curve.{ending}").stat().st_size > 500 for ending in ("csv", "png", "yaml"))


def test_a_robot_waits_for_what_moves(call: Call) -> None:
    words = ("mobile", "moving", "ten_obstacles", "moving.json", "--start", 0.3, 0.3, "--speed", 0.4, "--radius", 0.1)
    code, out, _ = call(*words, "--picture", "moving.png", "-o", "moving.csv")
    assert code == 0
    assert "arrives after" in out
    assert Path("moving.csv").read_text().startswith("t,x,y\n0.0,")
    assert Path("moving.png").stat().st_size > 5000
    assert json.loads(call(*words, "--json")[1])["timed_path"]["success"]


def test_a_network_is_learned_saved_and_used(call: Call) -> None:
    code, out, _ = call("mobile", "learn", "-o", "net.npz", "--hidden", 4, 3, "--iterations", 80, "--trainer", "bfgs")
    assert code == 0
    assert out.startswith("2:4:3:1 by bfgs, ")
    words = ("plan", "random:3:4", "--trajectory", "ann", "--network", "net.npz")
    code, out, _ = call(*words)
    assert "the network's tangent lengths are wrong by up to" in out


def test_parameters_of_a_table_change_the_arm_and_the_solution_is_drawn(call: Call) -> None:
    lengths = [
        word
        for name, value in {"h": 10, "d1": 4, "l1": 5, "l2": 5, "l3": 5, "l4": 5}.items()
        for word in ("--set", f"{name}={value}")
    ]
    code, out, _ = call("solve", "puma_offset", *lengths, "--position", 8, 5, 12, "--picture", "arm.png")
    assert code == 0
    assert "reached                  8.000000 5.000000 12.000000 m" in out
    assert Path("arm.png").stat().st_size > 5000
    assert call("solve", "puma_offset", *lengths, "--position", 8, 5, 60)[0] == 1
    assert call("solve", "puma_offset", "--position", 8, 5, 60)[0] == 0


def test_an_arm_is_drawn_among_the_obstacles_of_its_world(call: Call) -> None:
    pose = ("--position", 0.45, 0, 0.4, "--rpy", 0, 90, 0, "--degrees")
    assert call("solve", "ur5", *pose, "--world", "table", "--picture", "arm.svg")[0] == 0
    assert Path("arm.svg").stat().st_size > 5000
    assert call("solve", "ur5", "--rpy", 0, 1, 0, "--picture", "facing.png")[0] == 0
