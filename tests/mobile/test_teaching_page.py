"""The numbers of docs/teaching_paths.md that do not depend on chance, computed again; and the files it prints."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest

from pin_metaik import mobile
from pin_metaik.optimize import Budget

PAGE = (Path(__file__).parents[2] / "docs" / "teaching_paths.md").read_text(encoding="utf-8")


def said(*words: str) -> None:
    """What the page says, whatever its lines."""
    for each in words:
        assert each in " ".join(PAGE.split())


@pytest.fixture(scope="module")
def ten() -> mobile.PathProblem:
    return mobile.PathProblem.of(mobile.load_scene("ten_obstacles"))


def test_the_path_round_a_square() -> None:
    length = mobile.plan_path(mobile.load_scene("one_square")).length
    assert length == pytest.approx(2 * np.sqrt(17) + 2, abs=1e-12)
    said(f"= {length:.5f}")


def test_the_visibility_graph(ten: mobile.PathProblem) -> None:
    graph = ten.visibility.between(ten.scene.start, ten.scene.goal)
    nodes = len(graph.points)
    said(f"of the {nodes * (nodes - 1) // 2} pairs of {nodes} nodes {graph.edges.sum() // 2} are left")
    first, *others = [plan.length for plan in mobile.plan_alternatives(ten, 4)]
    gaps = [f"{100 * (length / first - 1):.2f}" for length in others]
    said(f"are {gaps[0]}, {gaps[1]} and {gaps[2]} % longer")


def test_the_disc_between_two_squares() -> None:
    d = 0.6 / 2**0.5
    A, B = [(-3, -3), (0, -3), (0, 0), (-3, 0)], [(d, d), (3 + d, d), (3 + d, 3 + d), (d, 3 + d)]
    scene = mobile.Scene((-2, 2), (2, -2), [A, B], (-3, -3, 3 + d, 3 + d))
    with pytest.raises(mobile.NoPath):
        mobile.plan_path(mobile.PathProblem.of(scene, 0.25, join="mitre"))
    said(f"{mobile.plan_path(mobile.PathProblem.of(scene, 0.25)).length:.4f} m")


def test_the_grids(ten: mobile.PathProblem) -> None:
    gaps = [100 * (mobile.plan_path(ten, mobile.GridAStar(cells)).gap or 0.0) for cells in (25, 50)]
    said("{:.2f}, {:.2f}, 5.89 and 5.78 % with 25, 50, 100 and 200 cells".format(*gaps))
    phi = np.linspace(0, np.pi / 4, 10001)
    said(f"{(np.cos(phi) + (np.sqrt(2) - 1) * np.sin(phi)).max():.4f} times at most")


def test_trees_that_improve_and_those_that_do_not(ten: mobile.PathProblem) -> None:
    def gap(name: str, most: int) -> float:
        plans = [mobile.plan_path(ten, name, budget=Budget(evaluations=most), rng=k) for k in range(3)]
        return float(np.median([plan.gap or 0.0 for plan in plans]))

    gaps = {name: [gap(name, most) for most in (500, 5000)] for name in ("rrt", "rrtstar")}
    assert gaps["rrt"][0] == gaps["rrt"][1] > 0.1
    assert 0.03 < gaps["rrtstar"][0] < 0.15
    assert 0.01 < gaps["rrtstar"][1] < 0.04


def test_the_swarm_and_the_pocket(ten: mobile.PathProblem) -> None:
    plans = [mobile.plan_path(ten, "pso", rng=k) for k in range(12)]
    gaps = [100 * plan.gap for plan in plans if plan.gap is not None]
    assert 5 < np.median(gaps) < 25
    trap = mobile.load_scene("u_trap")
    assert not any(mobile.plan_path(trap, "ga", fitness="paper", rng=k) for k in range(3))
    cheap = mobile.plan_path(trap, "pso", fitness=mobile.ExactFitness(0.1))
    assert cheap.length < mobile.plan_path(trap).length
    assert not cheap


def test_motions_wheels_and_parking() -> None:
    motion = mobile.plan_trajectory([(0, 0), (3, 0), (3, 3)])
    said(f"{motion.time:.3f} s instead of {motion.stop_and_turn:.3f} s")
    said(f"{mobile.TURTLEBOT3_BURGER.wheels(0.22, 2.84).max() / 0.033:.2f} rad/s: the numbers of the data sheet")
    there, back = (mobile.shortest_curve((0, 0, 0), (0, 2, 0), 5.0, reverse=way).length for way in (True, False))
    said(f"{there:.3f} m with reversing and {back:.3f} m without")


def test_the_door(tmp_path: Path) -> None:
    for name, text in zip(("doors", "moving"), re.findall(r"```json\n(.*?)```", PAGE, re.DOTALL), strict=True):
        (tmp_path / f"{name}.json").write_text(text)
        json.loads(text)
    problem = mobile.PathProblem.of(mobile.load_scene(tmp_path / "doors.json"), 0.2)
    plan = mobile.plan_among_moving(problem, mobile.load_moving(tmp_path / "moving.json"), 1.0)
    ((x, y, held),) = plan.waits
    said(f"It waits {held:.2f} s at ({x:.1f}, {y:.1f})", f"arrives after {plan.duration:.3f} s")
    said(f"drives on at {plan.times[2]:.3f} s")


def test_every_picture_of_the_page_is_there() -> None:
    names = re.findall(r"\((images/[\w.]+)\)", PAGE)
    assert len(names) == 3
    for name in names:
        assert (Path(__file__).parents[2] / "docs" / name).stat().st_size > 10_000
