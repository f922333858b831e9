"""Planners that others made: their paths are free by the exact test, repeatable, and no shorter than the shortest."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from pin_metaik import mobile
from pin_metaik.errors import InvalidBudget, InvalidSetting, UnknownName
from pin_metaik.interrupts import Interrupted
from pin_metaik.mobile.paths.planners.protocol import LineTests
from pin_metaik.optimize import Budget
from pin_metaik.watching import Progress

FEW = Budget(evaluations=1500)
WALL = mobile.Scene((1.0, 1.0), (4.0, 1.0), [[(2.0, -1.0), (3.0, -1.0), (3.0, 5.0), (2.0, 5.0)]], (0.0, 0.0, 5.0, 4.0))
DOOR = mobile.Scene((1.0, 1.0), (4.0, 1.0), [[(2.0, 0.0), (3.0, 0.0), (3.0, 3.0), (2.0, 3.0)]], (0.0, 0.0, 5.0, 4.0))


@pytest.fixture(scope="module")
def problem() -> mobile.PathProblem:
    return mobile.PathProblem.of(mobile.load_scene("ten_obstacles", (0.3, 0.3), (9.5, 9.5)), 0.05)


@pytest.mark.parametrize("name", mobile.PLANNERS)
def test_a_planner_s_path_is_free_repeatable_and_no_shorter_than_the_shortest(
    name: str, problem: mobile.PathProblem
) -> None:
    plan = mobile.plan_path(problem, name, budget=FEW, rng=3)
    again = mobile.plan_path(problem, name, budget=FEW, rng=3)
    assert plan.status is mobile.PathStatus.FREE
    assert plan.verify()
    assert plan.length >= problem.optimum.length - 1e-9
    assert_array_equal(plan.path.points, again.path.points)
    assert_array_equal(plan.path.points[[0, -1]], [problem.scene.start, problem.scene.goal])
    assert plan.evaluations > 0
    assert plan.cost == plan.length


@pytest.mark.parametrize("name", mobile.PLANNERS)
def test_where_there_is_no_way_none_is_found(name: str) -> None:
    plan = mobile.plan_path(WALL, name, budget=Budget(evaluations=300))
    assert plan.status is mobile.PathStatus.NOT_FOUND
    assert not plan
    assert plan.gap is None
    assert plan.as_dict()["cost"] is None
    assert "NOT_FOUND: no path" in str(plan)


@pytest.mark.parametrize("name", ["astar", "rrtstar", "prm"])
def test_a_watch_ends_the_work_with_what_was_found(name: str, problem: mobile.PathProblem) -> None:
    heard: list[Progress] = []

    def watch(at: Progress) -> bool:
        heard.append(at)
        return at.done >= 400

    plan = mobile.plan_path(problem, name, budget=Budget(evaluations=10**6), watch=watch)
    assert plan.interrupted
    assert heard[-1].total == 10**6


def test_control_c_is_heard_between_two_steps_and_carries_the_plan(problem: mobile.PathProblem) -> None:
    def press(at: Progress) -> None:
        if at.done >= 800:
            raise KeyboardInterrupt

    with pytest.raises(Interrupted) as stop:
        mobile.plan_path(problem, "rrtstar", budget=Budget(evaluations=10**6), watch=press)
    assert stop.value.result.interrupted
    assert stop.value.result.evaluations < 2000


def test_what_improves_its_path_tells_how() -> None:
    plan = mobile.plan_path(mobile.load_scene("ten_obstacles"), "rrtstar", budget=FEW, trace=True)
    assert plan.trace is not None
    assert (np.diff(plan.trace[:, 0]) >= 0).all()
    assert (np.diff(plan.trace[:, 1]) <= 1e-9).all()
    assert plan.trace[-1, 1] == plan.length


def test_a_finer_grid_finds_gaps_that_a_coarse_one_misses() -> None:
    narrow = mobile.Scene(
        (1.0, 2.0), (4.0, 2.0), [[(2.4, -1.0), (2.6, -1.0), (2.6, 3.9), (2.4, 3.9)]], (0.0, 0.0, 5.0, 4.0)
    )
    assert not mobile.plan_path(narrow, mobile.GridAStar(cells=10))
    assert mobile.plan_path(narrow, mobile.GridAStar(cells=100))


def test_the_best_grid_path_has_the_length_that_eight_directions_allow() -> None:
    plan = mobile.plan_path(DOOR, mobile.GridAStar(cells=200))
    free = mobile.plan_path(DOOR)
    assert free.length < plan.length < free.length / np.cos(np.pi / 8) + 0.1


def test_start_and_goal_in_one_place_need_no_search() -> None:
    scene = mobile.Scene((1.0, 1.0), (1.0, 1.0))
    for name in mobile.PLANNERS:
        assert mobile.plan_path(scene, name).length == 0.0


def test_planners_of_one_s_own_need_no_registration(problem: mobile.PathProblem) -> None:
    class Cheat:
        def route(self, problem: mobile.PathProblem, tests: LineTests, rng: np.random.Generator) -> mobile.Found:
            return mobile.Found(problem.optimum)

    plan = mobile.plan_path(problem, Cheat())
    assert plan.method == "Cheat"
    assert plan.gap == 0.0


def test_what_makes_no_sense_is_told() -> None:
    with pytest.raises(UnknownName, match="did you mean 'rrtstar'"):
        mobile.plan_path(DOOR, "rrtstart")
    with pytest.raises(InvalidBudget, match="target"):
        mobile.plan_path(DOOR, "rrt", budget=Budget(evaluations=10, target=1.0))
    with pytest.raises(InvalidSetting, match="planner must be one of"):
        mobile.RandomTree("RTT")  # type: ignore[arg-type]
    with pytest.raises(InvalidSetting, match="cells"):
        mobile.GridAStar(cells=1)
    with pytest.raises(InvalidSetting, match="not a metaheuristic"):
        mobile.plan_path(DOOR, mobile.GridAStar)  # type: ignore[arg-type]
