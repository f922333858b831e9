import numpy as np
import pytest
import shapely

from pin_metaik.errors import InvalidSetting
from pin_metaik.mobile import NoPath, PathProblem, Scene, grid_of, load_scene, random_scene

SQUARES = tuple(shapely.box(x, y, x + 1, y + 1) for x, y in ((2, 2), (5, 2.2), (5, 4)))


def signature(path, obstacles) -> tuple[int, ...]:
    """The homotopy class of a path: the order in which it crosses the rays that go up from inside each obstacle."""
    seen = []
    for a, b in zip(path.points[:-1], path.points[1:], strict=True):
        crossed = []
        for i, obstacle in enumerate(obstacles):
            x, y = obstacle.representative_point().coords[0]
            x += 1e-7 * np.sqrt(2)  # past any corner
            if (a[0] < x) != (b[0] < x):
                share = (x - a[0]) / (b[0] - a[0])
                if a[1] + share * (b[1] - a[1]) > y:
                    crossed.append((share, (i + 1) * (1 if b[0] > a[0] else -1)))
        for _, ray in sorted(crossed):
            if seen and seen[-1] == -ray:
                seen.pop()
            else:
                seen.append(ray)
    return tuple(seen)


def test_around_one_square_there_are_two_ways():
    paths = PathProblem.of(load_scene("one_square")).alternatives(5)
    assert [path.length for path in paths] == pytest.approx([2 * np.sqrt(17) + 2] * 2)
    assert paths[0].points[1][1] + paths[1].points[1][1] == pytest.approx(10)


@pytest.mark.parametrize("scene", ["ten_obstacles", "fifteen_obstacles", "squares"])
def test_alternatives_are_sorted_free_and_all_of_another_class(scene):
    scene = Scene((0, 3), (8, 3.1), SQUARES, (0, 0, 8, 7)) if scene == "squares" else load_scene(scene)
    problem = PathProblem.of(scene)
    paths = problem.alternatives(8)
    assert len(paths) == 8
    lengths = [path.length for path in paths]
    assert lengths == sorted(lengths)
    assert lengths[0] == pytest.approx(problem.optimum.length, abs=1e-9)
    assert all(problem.space.holds(path.points) for path in paths)
    assert all(shapely.LineString(path.points).is_simple for path in paths)
    assert len({signature(path, scene.obstacles) for path in paths}) == 8


def test_no_alternative_can_be_shortened_within_its_class():
    problem = PathProblem.of(random_scene(10, 5))
    for path in problem.alternatives(5):
        for i in range(1, len(path.points) - 1):
            short = path.points.copy()
            a, b, c = short[i - 1 : i + 2]
            middle = (a + c) / 2
            short[i] = b + 1e-4 * (middle - b) / np.hypot(*(middle - b))
            assert not problem.space.holds(short)


def test_every_class_of_two_obstacles_is_found_and_no_more():
    two = (shapely.box(2, 2, 3, 3), shapely.box(5, 2, 6, 3))
    paths = PathProblem.of(Scene((0, 2.5), (8, 2.5), two, (0, 0, 8, 5))).alternatives(20)
    shapes = [signature(path, two) for path in paths]
    assert {(), (1,), (2,), (1, 2)} <= set(shapes)
    assert len(set(shapes)) == len(shapes) < 20


def test_ways_round_the_obstacle_that_start_and_goal_touch_do_not_go_through_it():
    scene = Scene((4, 5), (6, 5.5), (shapely.box(4, 4, 6, 6),), (0, 0, 10, 10))
    assert [path.length for path in PathProblem.of(scene).alternatives(4)] == pytest.approx([3.5, 4.5])


def test_a_map_full_of_specks_has_its_ways_at_once():
    occupied = np.random.default_rng(1).random((60, 60)) < 0.03
    occupied[:2, :2] = occupied[-2:, -2:] = False
    grid = grid_of(occupied)
    problem = PathProblem.of(Scene((0.5, 0.5), (59.5, 59.5), grid.polygons, grid.bounds))
    paths = problem.alternatives(10)
    assert len(paths) == 10
    assert len({signature(path, grid.polygons) for path in paths}) == 10


def test_asking_for_none_is_refused_and_no_way_is_named():
    problem = PathProblem.of(load_scene("one_square"))
    with pytest.raises(InvalidSetting):
        problem.alternatives(0)
    closed = Scene((1, 5), (9, 5), (shapely.box(4, 0, 6, 10),), (0, 0, 10, 10))
    with pytest.raises(NoPath):
        PathProblem.of(closed).alternatives(3)
