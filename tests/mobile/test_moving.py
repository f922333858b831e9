"""Obstacles that move: what is planned keeps clear by another test, and is the quickest over its places."""

from __future__ import annotations

import itertools
import json
import math
from heapq import heappop, heappush
from pathlib import Path

import numpy as np
import pytest
import shapely
from numpy.testing import assert_allclose

from pin_metaik import mobile
from pin_metaik.errors import InvalidGeometry, InvalidSetting
from pin_metaik.mobile.moving.windows import Departures
from pin_metaik.watching import Progress

WALLS = [[(3.0, 0.0), (4.0, 0.0), (4.0, 2.0), (3.0, 2.0)], [(3.0, 3.0), (4.0, 3.0), (4.0, 5.0), (3.0, 5.0)]]
CORRIDOR = mobile.Scene((0.5, 2.5), (9.5, 2.5), WALLS, (0.0, 0.0, 10.0, 5.0))
PLUG = mobile.MovingObstacle(mobile.Footprint.rectangle(1.0, 1.0), [(0.0, 3.5, 2.5), (6.0, 3.5, 2.5), (8.0, 3.5, 4.5)])


def drawn(seed: int) -> tuple[mobile.PathProblem, list[mobile.MovingObstacle], float]:
    """A random scene with three to five things that drive about."""
    rng = np.random.default_rng(seed)
    problem = mobile.PathProblem.of(mobile.random_scene(5, seed, gap=0.6), 0.1)
    moving = []
    for _ in range(rng.integers(3, 6)):
        times = np.cumsum(rng.uniform(0.5, 6.0, 4))
        outline = mobile.Footprint(rng.uniform(-0.8, 0.8, (5, 2)), rng.uniform(0.0, 0.2))
        moving.append(mobile.MovingObstacle(outline, np.column_stack((times, rng.uniform(1.5, 8.5, (4, 2))))))
    return problem, moving, float(rng.uniform(0.5, 2.0))


@pytest.mark.parametrize("seed", range(12))
def test_what_is_planned_keeps_clear_of_all_that_moves_by_dense_samples(seed: int) -> None:
    problem, moving, speed = drawn(seed)
    plan = mobile.plan_among_moving(problem, moving, speed, cells=8)
    assert plan.success
    assert plan.duration >= plan.direct - 1e-9
    times = np.linspace(plan.times[0], plan.times[-1] + 20.0, 4000)
    robot = plan.at(times)
    for obstacle in moving:
        outline = shapely.buffer(obstacle.footprint.at(np.zeros((1, 3)))[0], obstacle.footprint.around)
        gaps = shapely.distance(shapely.points(robot - obstacle.at(times)), outline)
        assert gaps.min() >= 0.1 - 1e-3  # shapely's buffer has 16 sides a quarter
        assert gaps.min() >= plan.clearance - 1e-3
    moved = np.hypot(*np.diff(plan.points, axis=0).T)
    assert_allclose(moved[moved > 0] / np.diff(plan.times)[moved > 0], speed, rtol=1e-9)


def stepped(problem: mobile.PathProblem, moving: list[mobile.MovingObstacle], speed: float, dt: float) -> float:
    """Arrival by Dijkstra over the same places and steps of time, each line tested by the distance of shapely."""
    border = problem.visibility.border
    places = np.vstack((problem.scene.start, problem.scene.goal, border.vertices[border.corners]))
    outlines = [m.footprint.at(np.zeros((1, 3)))[0] for m in moving]
    keep = [problem.space.clearance + m.footprint.around for m in moving]

    def clear(a: np.ndarray, b: np.ndarray, begin: float, end: float) -> bool:
        for m, outline, room in zip(moving, outlines, keep, strict=True):
            inside = m.way[:, 0][(m.way[:, 0] > begin) & (m.way[:, 0] < end)]
            t = np.array([begin, *inside, end])
            seen = a + (t - begin)[:, None] / (end - begin) * (b - a) - m.at(t)
            if shapely.LineString(seen).distance(outline) < room:
                return False
        return True

    lines = {
        (i, j): math.dist(places[i], places[j]) / speed
        for i, j in itertools.permutations(range(len(places)), 2)
        if problem.space.holds(places[[i, j]]) and math.dist(places[i], places[j]) > 0
    }
    last = max(m.way[-1, 0] for m in moving)
    best, heap = {}, [(0.0, 0)]
    while heap:
        now, node = heappop(heap)
        if (node, now) in best:
            continue
        best[node, now] = True
        if node == 1 and clear(places[1], places[1], now, max(last, now) + 1.0):
            return now
        if now <= last and clear(places[node], places[node], now, now + dt):
            heappush(heap, (round(now + dt, 9), node))
        for (i, j), took in lines.items():
            there = math.ceil((now + took) / dt - 1e-9) * dt  # waits there until the next step
            if i == node and clear(places[i], places[j], now, now + took):
                rest = there - now - took
                if rest < 1e-9 or clear(places[j], places[j], now + took, there):
                    heappush(heap, (round(there, 9), j))
    return math.inf


@pytest.mark.parametrize("seed", [0, 1, 2, 3])
def test_no_motion_over_the_same_places_in_steps_of_time_is_quicker(seed: int) -> None:
    rng = np.random.default_rng(seed)
    square = [(2.0, 2.0), (3.0, 2.0), (3.0, 3.0), (2.0, 3.0)]
    problem = mobile.PathProblem.of(mobile.Scene((0.5, 2.5), (4.5, 2.5), [square], (0.0, 0.0, 5.0, 5.0)), 0.1)
    moving = [
        mobile.MovingObstacle(
            mobile.Footprint.rectangle(*rng.uniform(0.4, 1.2, 2)),
            np.column_stack((np.cumsum(rng.uniform(1.0, 3.0, 3)), rng.uniform(1.0, 4.0, (3, 2)))),
        )
        for _ in range(3)
    ]
    dt = 0.25
    theirs = stepped(problem, moving, 1.0, dt)
    try:
        ours = mobile.plan_among_moving(problem, moving, 1.0, cells=0).duration
    except mobile.NoTimedPath:
        ours = math.inf
    assert ours <= theirs + 1e-9
    assert math.isinf(ours) or ours >= problem.optimum.length - 1e-9
    if math.isfinite(theirs):
        assert theirs - ours < 8 * dt  # theirs waits for the next step at every place


def test_a_robot_waits_before_a_door_until_it_opens() -> None:
    problem = mobile.PathProblem.of(CORRIDOR, 0.2)
    plan = mobile.plan_among_moving(problem, [PLUG], 1.0)
    (wait,) = plan.waits
    assert wait[2] > 3.0
    assert plan.clearance == pytest.approx(0.2, abs=1e-9)
    assert plan.duration > plan.direct + 3.0
    assert "waits: 3.9" in str(plan)
    assert json.loads(json.dumps(plan.as_dict(), allow_nan=False))["success"] is True


def test_nothing_that_moves_is_the_shortest_path() -> None:
    plan = mobile.plan_among_moving(mobile.load_scene("ten_obstacles"), [], 2.0)
    assert plan.duration == pytest.approx(plan.direct, abs=1e-9)
    assert plan.waits == []
    assert math.isinf(plan.clearance)


def test_what_comes_towards_a_robot_is_given_way_to_where_there_are_places() -> None:
    problem = mobile.PathProblem.of(CORRIDOR, 0.2)
    truck = mobile.MovingObstacle(mobile.Footprint.disc(0.4), [(0.0, 9.0, 2.5), (20.0, 0.0, 2.5)])
    with pytest.raises(mobile.NoTimedPath, match="more places"):
        mobile.plan_among_moving(problem, [truck], 1.0, cells=0)
    assert mobile.plan_among_moving(problem, [truck], 1.0).success
    assert mobile.plan_among_moving(problem, [truck], 1.0, cells=0, places=[(2.0, 1.0), (6.0, 4.0)]).success


@pytest.mark.parametrize(
    ("place", "says"), [((0.5, 2.5), "covers the start at 0 s"), ((9.5, 2.5), "stays over the goal for ever")]
)
def test_what_stands_on_start_or_goal_is_named(place: tuple[float, float], says: str) -> None:
    parked = mobile.MovingObstacle(mobile.Footprint.disc(0.3), [(0.0, *place)])
    with pytest.raises(mobile.NoTimedPath, match=says):
        mobile.plan_among_moving(CORRIDOR, [parked], 1.0)


def test_another_time_to_begin_meets_other_obstacles() -> None:
    later = mobile.plan_among_moving(mobile.PathProblem.of(CORRIDOR, 0.2), [PLUG], 1.0, start_time=8.0)
    assert later.duration == pytest.approx(later.direct)
    assert later.times[0] == 8.0


def test_refused_departures_are_those_at_which_a_dense_drive_meets_something() -> None:
    rng = np.random.default_rng(5)
    for _ in range(30):
        outline = mobile.Footprint(rng.uniform(-1.0, 1.0, (4, 2)))
        way = np.column_stack((np.cumsum(rng.uniform(0.2, 3.0, 4)), rng.uniform(0.0, 5.0, (4, 2))))
        obstacle = mobile.MovingObstacle(outline, way)
        a, b = rng.uniform(0.0, 5.0, (2, 2))
        speed, shape = float(rng.uniform(0.3, 2.0)), outline.at(np.zeros((1, 3)))[0]
        windows = Departures([obstacle], speed, 0.0).along(a, b)
        took = math.dist(a, b) / speed
        for departure in rng.uniform(-2.0, 10.0, 20):
            t = np.linspace(departure, departure + took, 2000)
            seen = a + ((t - departure) / took)[:, None] * (b - a) - obstacle.at(t)
            gap = shapely.distance(shapely.points(seen), shape).min()
            inside = any(low <= departure <= high for low, high in windows)
            edge = min((abs(departure - end) for window in windows for end in window), default=1.0)
            if edge > 0.01:
                assert inside == (gap > 0.0)


def test_a_watch_ends_the_search() -> None:
    problem, moving, _ = drawn(3)
    heard: list[Progress] = []

    def watch(at: Progress) -> bool:
        heard.append(at)
        return True

    with pytest.raises(mobile.NoTimedPath, match="its watch ended the search"):
        mobile.plan_among_moving(problem, [*moving, PLUG], 0.3, cells=30, watch=watch)
    assert heard


def test_files_of_moving_obstacles_are_read_and_mistakes_named(tmp_path: Path) -> None:
    file = tmp_path / "moving.json"
    file.write_text(json.dumps([PLUG.as_dict(), {"radius": 0.3, "way": [[0, 1, 1]]}]))
    plug, disc = mobile.load_moving(file)
    assert_allclose(plug.way, PLUG.way)
    assert disc.footprint.around == 0.3
    assert disc.name == "obstacle 2"
    for content, says in (
        ({}, "a list of objects"),
        ([{"way": [[0, 1, 1]]}], "an outline or a radius"),
        ([{"radius": 1, "way": [[0, 1]]}], "obstacle 1: way"),
        ([{"radius": 1, "way": [[1, 0, 0], [0, 1, 1]]}], "times rise"),
        ([{"radius": -1, "way": [[1, 0, 0]]}], "around"),
        ([{"radius": 1, "way": [[1, 0, 0]], "arround": 1}], "did you mean 'around'"),
    ):
        file.write_text(json.dumps(content))
        with pytest.raises(InvalidGeometry, match=says):
            mobile.load_moving(file)


def test_speeds_and_places_that_make_no_sense_are_refused() -> None:
    with pytest.raises(InvalidSetting, match="speed"):
        mobile.plan_among_moving(CORRIDOR, [], 0.0)
    with pytest.raises(InvalidSetting, match="cells"):
        mobile.plan_among_moving(CORRIDOR, [], 1.0, cells=1000)
