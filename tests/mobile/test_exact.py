import numpy as np
import pytest
import shapely
from numpy.testing import assert_allclose
from shapely import affinity

from benchmarks import mobile_truth as oracle
from pin_metaik.mobile import (
    Blocked,
    FreeSpace,
    NoPath,
    PathProblem,
    Scene,
    Visibility,
    grid_of,
    load_scene,
    plan_path,
    random_scene,
)
from pin_metaik.mobile.paths.exact import Search
from pin_metaik.mobile.world.scene import scene_names

OPTIMA = {  # by an independent planner
    "ten_obstacles": 11.815274943,
    "fifteen_obstacles": 12.101205654,
    "u_trap": 13.959653242,
    "one_square": 2 * np.sqrt(17) + 2,
}


@pytest.mark.parametrize("name", scene_names())
def test_the_shortest_path_has_the_known_length_and_is_free(name):
    scene = load_scene(name)
    plan = plan_path(scene)
    assert plan.length == pytest.approx(OPTIMA[name], abs=1e-6)
    x_min, y_min, x_max, y_max = scene.bounds
    assert (plan.path.points >= (x_min, y_min)).all()
    assert (plan.path.points <= (x_max, y_max)).all()
    line = shapely.LineString(plan.path.points)
    assert not any(line.intersects(obstacle.buffer(-1e-9)) for obstacle in scene.obstacles)
    assert (plan.success, plan.gap, plan.status) == (True, 0, "OPTIMAL")


def overlapping_scene(rng):
    """Triangles and quadrangles thrown on each other, some over the walls."""
    obstacles = []
    for _ in range(9):
        centre, count = rng.uniform(1, 9, 2), rng.integers(3, 6)
        hull = shapely.MultiPoint(centre + rng.uniform(-1.5, 1.5, (count, 2))).convex_hull
        if hull.area > 0.05 and hull.distance(shapely.MultiPoint([(0, 0), (10, 10)])) > 0.2:
            obstacles.append(hull)
    return Scene((0, 0), (10, 10), tuple(obstacles), (0, 0, 10, 10))


def test_random_overlapping_scenes_agree_with_an_unpruned_planner():
    rng = np.random.default_rng(0)
    found = 0
    for _ in range(40):
        scene = overlapping_scene(rng)
        expected = oracle.shortest_length(scene.start, scene.goal, scene.obstacles, scene.bounds)
        if np.isfinite(expected):
            found += 1
            assert plan_path(scene).length == pytest.approx(expected, abs=1e-6)
        else:
            with pytest.raises(NoPath):
                plan_path(scene)
    assert found > 30


def test_grids_full_of_collinear_corners_agree_with_an_unpruned_planner():
    rng = np.random.default_rng(3)
    for _ in range(15):
        cells = np.argwhere(rng.random((8, 8)) < 0.25)
        obstacles = tuple(shapely.box(x + 0.1, y + 0.1, x + 1, y + 1) for x, y in cells if 0 < x + y < 14)
        scene = Scene((0, 0), (8, 8), obstacles, (0, 0, 8, 8))
        expected = oracle.shortest_length(scene.start, scene.goal, obstacles, scene.bounds)
        assert plan_path(scene).length == pytest.approx(expected, abs=1e-6)


def test_no_line_of_sight_of_a_map_runs_through_its_walls():
    rng = np.random.default_rng(5)
    for _ in range(10):
        grid = grid_of(rng.random((20, 20)) < 0.35, resolution=0.05)  # walls, corners that touch, aligned edges
        visibility = Visibility(FreeSpace.of(Scene((0, 0), (1, 1), grid.polygons, grid.bounds)))
        i, j = np.nonzero(np.triu(visibility.mutual))
        ends = visibility.border.vertices[visibility.border.corners]
        assert not shapely.intersects(visibility.space.core, shapely.linestrings(np.stack((ends[i], ends[j]), 1))).any()


@pytest.mark.parametrize("angle", [0.0, 0.3, 1.0, 2.2])
def test_there_is_no_way_along_a_seam(angle):
    wall = [shapely.box(4, 0, 6, 3), shapely.box(4, 3, 5, 8), shapely.box(5, 3, 6, 5.5), shapely.box(5, 5.5, 6, 10)]
    turned = [affinity.rotate(part, angle, (0, 0), use_radians=True) for part in wall]
    cos, sin = np.cos(angle), np.sin(angle)
    start, goal = ((cos * x - sin * y, sin * x + cos * y) for x, y in ((1, 3), (9, 5.5)))
    shortest = plan_path(Scene(start, goal, tuple(turned))).length
    around = np.hypot(3, 3) + 2 + np.hypot(3, 5.5)
    assert shortest == pytest.approx(around, abs=1e-6)


def test_walls_are_walls_for_obstacles_that_touch_them():
    scene = Scene((1, 5), (9, 5), (shapely.box(4, 0, 6, 9),), (0, 0, 10, 10))
    assert plan_path(scene).length == pytest.approx(2 * 5 + 2)
    with pytest.raises(NoPath, match="obstacles or walls close every way"):
        plan_path(Scene((1, 5), (9, 5), (shapely.box(4, 0, 6, 10),), (0, 0, 10, 10)))
    with pytest.raises(NoPath, match="try a smaller radius or margin"):
        plan_path(PathProblem.of(scene, radius=0.6))


@pytest.mark.parametrize("join", ["mitre", "round"])
def test_the_path_keeps_its_clearance_and_is_no_shorter_with_more_of_it(join):
    scene = load_scene("ten_obstacles").between((0.5, 0.1), (7.9, 8))
    lengths = []
    for r in (0.0, 0.01, 0.03, 0.05, 0.08):
        plan = plan_path(PathProblem.of(scene, radius=r, join=join))
        assert plan.clearance >= r - 1e-9
        assert plan.path.points.min() >= r - 1e-9
        assert plan.path.points.max() <= 10 - r + 1e-9
        lengths.append(plan.length)
    assert (np.diff(lengths) >= -1e-9).all()
    assert lengths[-1] > lengths[0]


def test_concave_obstacles_keep_their_clearance_too():
    scene = load_scene("u_trap")
    lengths = [plan_path(PathProblem.of(scene, radius=r, margin=0.1)).length for r in (0.0, 0.1, 0.2)]
    assert (np.diff(lengths) > 0).all()


@pytest.mark.parametrize("name", ["ten_obstacles", "u_trap"])
def test_moving_turning_scaling_and_swapping_change_nothing(name):
    world = load_scene(name)
    scene = Scene(world.start, world.goal, world.obstacles)
    length = plan_path(scene).length
    assert plan_path(scene.between(world.goal, world.start)).length == pytest.approx(length, rel=1e-12)
    for scale, angle, shift in ((1, 0.7, (3, -8)), (250, 2.0, (0, 0)), (1e-3, -1.1, (1, 1))):
        cos, sin = scale * np.cos(angle), scale * np.sin(angle)

        def place(x, y, cos=cos, sin=sin, shift=shift):
            return cos * x - sin * y + shift[0], sin * x + cos * y + shift[1]

        moved = [shapely.transform(p, lambda c: np.column_stack(place(*c.T))) for p in world.obstacles]
        turned = plan_path(Scene(place(*world.start), place(*world.goal), tuple(moved)))
        assert turned.length == pytest.approx(scale * length, rel=1e-9)


def test_a_path_may_begin_and_end_on_corners_edges_and_walls():
    square = (shapely.box(4, 4, 6, 6),)
    for start, goal, length in (
        ((4, 4), (6, 6), 4),
        ((4, 5), (6, 5), 4),
        ((4, 5), (4, 5.5), 0.5),
        ((4, 4), (4, 6), 2),
        ((5, 4), (5, 6), 4),
        ((0, 0), (10, 0), 10),
        ((4, 4), (4, 4), 0),
    ):
        plan = plan_path(Scene(start, goal, square, (0, 0, 10, 10)))
        assert plan.length == pytest.approx(length, abs=1e-9)
        assert plan.success


@pytest.mark.parametrize(
    ("start", "goal", "role", "nearest"),
    [((5, 4.5), (9, 9), "start", (5, 4)), ((0, 0), (5.5, 5), "goal", (6, 5)), ((-1, 3), (9, 9), "start", (0, 3))],
)
def test_a_start_or_goal_that_is_not_free_is_refused_with_the_nearest_place_that_is(start, goal, role, nearest):
    scene = Scene(start, goal, (shapely.box(4, 4, 6, 6),), (0, 0, 10, 10))
    with pytest.raises(Blocked, match=f"the {role}.*nearest free place") as error:
        plan_path(scene)
    assert error.value.role == role
    assert_allclose(error.value.nearest, nearest, atol=1e-12)


def test_a_robot_wider_than_the_workspace_is_nowhere_free():
    with pytest.raises(Blocked, match="no place is free"):
        PathProblem.of(Scene((5, 5), (6, 6), (), (0, 0, 10, 10)), radius=5)
    covered = Scene((5, 5), (6, 6), (shapely.box(-1, -1, 11, 11),), (0, 0, 10, 10))
    with pytest.raises(Blocked, match="no place is free"):
        plan_path(covered)


def test_an_empty_world_has_straight_paths():
    assert plan_path(Scene((0, 0), (3, 4))).length == 5
    assert plan_path(Scene((0, 0), (0, 0))).length == 0


@pytest.mark.filterwarnings("ignore:invalid value encountered in linestrings")
def test_the_exact_test_refuses_what_crosses_a_corner_by_a_hair():
    space = FreeSpace.of(load_scene("one_square"))
    assert space.holds(np.array([(0, 5), (4, 6), (6, 6), (10, 5)]))
    assert not space.holds(np.array([(0, 5), (4, 6 - 1e-6), (6, 6), (10, 5)]))
    assert not space.holds(np.array([(0, 5), (4, 10 + 1e-6), (10, 5)]))
    assert not space.holds(np.array([(0, 5), (np.nan, 6), (10, 5)]))


def specks(count, rng):
    """A map of 50 x 50 m, cells of 5 cm, with single occupied ones."""
    cells = np.zeros((1000, 1000), dtype=bool)
    cells[tuple(np.random.default_rng(rng).integers(5, 995, (2, count)))] = True
    return grid_of(cells, resolution=0.05)


class Counting(Search):
    """A search that counts the nodes whose lines of sight it looks for."""

    opened = 0

    def _opened(self, *given):
        self.opened += 1
        return super()._opened(*given)


def test_open_maps_of_a_thousand_specks_are_opened_near_the_straight_line_only():
    """A shortest path swerves by cells from the diagonal; how quickly, the benchmark says."""
    grid = specks(1000, 0)
    problem = PathProblem.of(Scene((0.1, 0.1), (49.9, 49.9), grid.polygons, grid.bounds))
    plan = plan_path(problem)
    assert plan.length == pytest.approx(70.428, abs=1e-3)
    assert plan.verify()
    search = Counting(problem.visibility, *problem.visibility.nodes((0.1, 0.1), (49.9, 49.9)))
    search.route(set())
    assert 0 < search.opened < 0.02 * len(search.points)


def test_a_thousand_polygons_have_the_known_shortest_path():
    plan = plan_path(random_scene(1000, 0, size=100.0, gap=0.05))
    assert plan.length == pytest.approx(127.942, abs=1e-3)
    assert plan.verify()


def test_an_outline_of_thousands_of_vertices_is_gone_round():
    """Like the string round its hull, as far as it has to be."""
    angle = 2 * np.pi * np.arange(4000) / 4000
    outline = (3 + 0.4 * np.sin(37 * angle))[:, None] * np.column_stack((np.cos(angle), np.sin(angle)))
    for radius in (0.0, 0.2):
        plan = plan_path(PathProblem.of(Scene((-6, 0), (6, 0), [outline]), radius, join="round"))
        grown = shapely.Polygon(outline).buffer(radius, quad_segs=500)
        upper = shapely.union_all([shapely.clip_by_rect(grown, -9, 0, 9, 9), shapely.LineString([(-6, 0), (6, 0)])])
        assert plan.length == pytest.approx(upper.convex_hull.exterior.length - 12, rel=2e-3)
        assert plan.verify()


def test_mitred_corners_close_no_way_that_round_ones_leave():
    """Two corners 0.60 m apart: a disc of radius 0.25 has 0.10 m to spare; mitred corners overlap."""
    d = 0.6 / 2**0.5
    squares = [[(-3, -3), (0, -3), (0, 0), (-3, 0)], [(d, d), (3 + d, d), (3 + d, 3 + d), (d, 3 + d)]]
    scene = Scene((-2, 2), (2, -2), squares, (-3, -3, 3 + d, 3 + d))
    plan = plan_path(PathProblem.of(scene, 0.25))
    assert plan.length == pytest.approx(5.6791, abs=1e-3)
    assert (plan.status, plan.problem.space.join) == ("SHORTEST", "round")
    with pytest.raises(NoPath, match=r"mitred corners .* close every way .* and 0\.24\d+ leaves one; try join='round'"):
        plan_path(PathProblem.of(scene, 0.25, join="mitre"))
    with pytest.raises(NoPath, match=r"obstacles or walls close every way that keeps a clearance of 0\.31"):
        plan_path(PathProblem.of(scene, 0.31))


def test_random_scenes_with_room_for_the_robot_have_a_path_whatever_mitred_corners_say():
    for seed in range(40):
        scene = random_scene(15, seed, gap=0.55)
        plan = plan_path(PathProblem.of(scene, 0.25))
        assert plan.clearance >= 0.25 - 1e-9
        assert plan.verify()
    keeps = Scene((0.5, 0.5), (9, 9), [[(1, 1), (3, 1), (1, 3)]], (0, 0, 10, 10)).between((0.7, 0.7), None)
    assert plan_path(PathProblem.of(keeps, 0.4)).success  # its mitred corner covers the start, the disc does not
