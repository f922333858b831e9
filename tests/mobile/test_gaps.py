"""What has no width: one rule for gaps, slivers and contacts, however and wherever the scene is given."""

import numpy as np
import pytest
import shapely
from shapely import affinity

from benchmarks import mobile_truth as oracle
from pin_metaik.mobile import FreeSpace, NoPath, PathProblem, Scene, grid_of, plan_path

LOWER, UPPER = shapely.box(0, 0, 1, 1), shapely.box(1, 1, 2, 2)  # they touch in (1, 1)
START, GOAL = (0.5, 1.5), (1.5, 0.5)
THROUGH = [START, (1, 1), GOAL]
AROUND = 2 + np.sqrt(2)
ROOMY, TIGHT = (-1, -1, 3, 3), (0, 0, 2, 2)  # walls far away, and at the boxes' sides


def planned(scene: Scene) -> float:
    """Length of the shortest path; infinite without one. The exact test says the same of it."""
    problem = PathProblem.of(scene)
    try:
        path = plan_path(problem).path
    except NoPath:
        return np.inf
    assert problem.space.holds(path.points)
    return path.length


def walled(scene: Scene) -> dict[str, Scene]:
    """The same world with its walls written down in other ways."""
    x_min, y_min, x_max, y_max = scene.bounds
    frame = shapely.box(x_min - 1, y_min - 1, x_max + 1, y_max + 1).difference(shapely.box(*scene.bounds))
    strips = [
        shapely.box(x_min - 1, y_min - 1, x_min, y_max + 1),
        shapely.box(x_max, y_min - 1, x_max + 1, y_max + 1),
        shapely.box(x_min - 1, y_min - 1, x_max + 1, y_min),
        shapely.box(x_min - 1, y_max, x_max + 1, y_max + 1),
    ]
    ways = {"frame": [frame], "strips": strips, "line": [shapely.box(*scene.bounds).exterior]}
    return {name: Scene(scene.start, scene.goal, [*scene.obstacles, *walls]) for name, walls in ways.items()}


@pytest.mark.parametrize("bounds", [None, ROOMY])
def test_a_point_contact_is_closed_where_there_is_a_way_round(bounds):
    assert planned(Scene(START, GOAL, [LOWER, UPPER], bounds)) == pytest.approx(AROUND, abs=1e-6)


@pytest.mark.parametrize("bounds", [None, ROOMY, TIGHT])
def test_the_planner_and_the_exact_test_agree_on_a_point_contact(bounds):
    space = FreeSpace.of(Scene(START, GOAL, [LOWER, UPPER], bounds))
    assert not space.holds(THROUGH)
    assert not space.holds(THROUGH[::-1])


def test_a_point_contact_between_walls_leaves_no_way():
    scene = Scene(START, GOAL, [LOWER, UPPER], TIGHT)
    assert planned(scene) == np.inf
    assert {name: planned(way) for name, way in walled(scene).items()} == dict.fromkeys(walled(scene), np.inf)


def test_four_squares_of_twice_the_size_are_the_same_kind_of_contact():
    squares = [[(0, 0), (2, 0), (2, 2), (0, 2)], [(2, 2), (4, 2), (4, 4), (2, 4)]]
    found = [planned(Scene((1, 3), (3, 1), squares, bounds)) for bounds in (None, (-1, -1, 5, 5), (0, 0, 4, 4))]
    assert found == [pytest.approx(2 * AROUND, abs=1e-6)] * 2 + [np.inf]


@pytest.mark.parametrize("scale", [1e-6, 1e-3, 1.0, 1e3, 1e9])
@pytest.mark.parametrize("angle", [0, 17, 45, 123])
def test_contacts_are_closed_at_any_scale_and_angle(scale, angle):
    def placed(shape):
        return affinity.scale(affinity.rotate(shape, angle, (0, 0)), scale, scale, origin=(0, 0))

    start, goal = (placed(shapely.Point(end)).coords[0] for end in (START, GOAL))
    boxes = [placed(LOWER), placed(UPPER)]
    assert planned(Scene(start, goal, boxes)) == pytest.approx(scale * AROUND, rel=1e-6)
    frame = placed(shapely.box(-1, -1, 3, 3).difference(shapely.box(*TIGHT)))
    assert planned(Scene(start, goal, [*boxes, frame])) == np.inf


@pytest.mark.parametrize("away", [1e5, 5e6, 1e8])
def test_far_from_the_origin_the_rule_is_that_of_the_digits_left(away):
    def moved(shape):
        return affinity.translate(shape, away, -away)

    start, goal = (moved(shapely.Point(end)).coords[0] for end in (START, GOAL))
    boxes = [moved(LOWER), moved(UPPER)]
    assert planned(Scene(start, goal, boxes)) == pytest.approx(AROUND, abs=1e-10 * away)
    frame = moved(shapely.box(-1, -1, 3, 3).difference(shapely.box(*TIGHT)))
    assert planned(Scene(start, goal, [*boxes, frame])) == np.inf
    apart = [boxes[0], affinity.translate(boxes[1], 0.01, 0.01)]
    through = planned(Scene(start, goal, apart))
    assert through == pytest.approx(np.sqrt(2), abs=1e-3)


@pytest.mark.parametrize(("gap", "way"), [(0.0, False), (1e-13, False), (1e-7, True), (1e-3, True)])
def test_a_gap_is_a_way_when_it_is_wider_than_rounding(gap, way):
    """Between two obstacles, between an obstacle and the bounds, and between it and a wall that is a polygon."""
    start, goal, tall = (0, 0.5), (4, 0.5), shapely.box(1, -3, 3, 0.5 - gap / 2)
    between = [tall, shapely.box(1, 0.5 + gap / 2, 3, 4)]
    assert (planned(Scene(start, goal, between)) < 4.1) is way
    below_bounds = Scene(start, goal, [shapely.box(1, -3, 3, 1 - gap)], (-1, -3, 5, 1))
    for scene in (below_bounds, *walled(below_bounds).values()):
        assert (planned(scene) < np.inf) is way


@pytest.mark.parametrize("width", [1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-12])
def test_a_sliver_is_gone_round_or_is_none_and_never_closes_the_world(width):
    """Overlays leave such slivers; there is a way round it, five metres off."""
    sliver = [(-5, 1), (5, 1), (5, 1 + width), (-5, 1 + width)]
    scene = Scene((0, 0), (0, 3), [sliver])
    around = 2 * np.hypot(5, 1) + (np.sqrt(25 + 4) - np.sqrt(25 + 1))
    length = planned(scene)
    assert length == pytest.approx(around, abs=1e-6) or length == pytest.approx(3, abs=1e-6)
    assert (length > 4) is bool(width > 2 * FreeSpace.of(scene).touch)  # the rule that is stated
    assert PathProblem.of(scene, 0.1).optimum.length > around  # grown, any of them is an obstacle


def test_a_line_has_no_width_and_is_an_obstacle_all_the_same():
    for wall in ("LINESTRING (-5 1, 5 1)", "LINESTRING (-5 1, 0 1, 5 1)", "MULTILINESTRING ((-5 1, 0 1), (0 1, 5 1))"):
        assert planned(Scene((0, 0), (0, 3), [wall])) == pytest.approx(np.hypot(5, 1) + np.hypot(5, 2), abs=1e-6)


@pytest.mark.parametrize("end", [1.0, 1.0 - 1e-13])
def test_a_line_that_ends_at_a_wall_leaves_no_gap(end):
    scene = Scene((-1, 0.5), (1, 0.5), [shapely.LineString([(0, 0), (0, end)])], (-2, 0, 2, 1))
    assert planned(scene) == np.inf
    assert {planned(way) for way in walled(scene).values()} == {np.inf}


def test_diagonal_cells_of_a_grid_and_the_same_boxes_are_one_world():
    grid = grid_of([[0, 1], [1, 0]])
    boxes = [shapely.box(1, 0, 2, 1), shapely.box(0, 1, 1, 2)]
    for obstacles in (grid.polygons, boxes, [shapely.MultiPolygon(boxes)], [shapely.union_all(boxes)]):
        assert planned(Scene((0.5, 0.5), (1.5, 1.5), obstacles, grid.bounds)) == np.inf


@pytest.mark.parametrize("family", ["cells", "lattice", "rooms"])
def test_walls_are_one_thing_however_they_are_written(family):
    found = 0
    for seed in range(12):
        scene = oracle.FAMILIES[family](np.random.default_rng(seed))
        if scene.bounds is not None:
            length = planned(scene)
            found += length < np.inf
            for name, way in walled(scene).items():
                assert planned(way) == pytest.approx(length, abs=1e-6), (seed, name)
    assert found > 0


@pytest.mark.parametrize("family", oracle.FAMILIES)
def test_random_scenes_have_the_lengths_of_another_visibility_graph(family):
    """A fifth of the 660 of ``benchmarks/mobile.py``."""
    found = 0
    for seed in range(26):
        scene = oracle.FAMILIES[family](np.random.default_rng(seed))
        expected = oracle.shortest_length(scene.start, scene.goal, scene.obstacles, scene.bounds)
        found += expected < np.inf
        assert planned(scene) == pytest.approx(expected, abs=1e-6), seed
    assert found > 3


def test_a_plane_without_end_has_room_for_a_robot_larger_than_what_stands_in_it():
    """The way round two posts, for a robot that does not fit between them, leads past the corners of both."""
    posts = ["POINT (0.55 -0.55)", "POINT (-0.55 0.55)"]
    for join, length in (("mitre", 5.7088), ("round", 4.7115)):
        lengths = [
            PathProblem.of(Scene((-0.75, -0.75), (0.75, 0.75), posts, bounds), 1.0, join=join).optimum.length
            for bounds in (None, (-99, -99, 99, 99))
        ]
        assert lengths == pytest.approx([length] * 2, abs=1e-4)


@pytest.mark.parametrize("angle", [0.0, 0.3, 1.0])
def test_a_corner_rounded_by_a_hair_is_a_corner(angle):
    """However small the arc, down to rounding: its vertices one by one look as if they stood amid a straight edge."""
    arc = np.linspace(0, np.pi / 2, 5)
    for size in 10.0 ** np.arange(-13, -6, 0.5):
        rounded = 1 - size + size * np.column_stack((np.cos(arc), np.sin(arc)))
        square = affinity.rotate(shapely.Polygon([(0, 0), (1, 0), *rounded, (0, 1)]), angle, (0, 0), use_radians=True)
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        scene = Scene(turn @ (1.5, 0.2), turn @ (0.2, 1.5), [square])
        assert planned(scene) == pytest.approx(2 * np.hypot(0.5, 0.8), abs=1e-6), size


@pytest.mark.parametrize("join", ["mitre", "round"])
@pytest.mark.parametrize("radius", [0.5, 0.3])
def test_a_robot_as_wide_as_the_gap_does_not_fit_and_one_a_hair_narrower_does(join, radius):
    for room, fits in ((0.0, False), (1e-13, False), (1e-7, True), (1e-3, True)):
        gap = 2 * radius + room
        between = [shapely.box(1, gap, 2, 4), shapely.box(1, -4, 2, 0)]
        below = Scene((-2, 0), (5, 0), [shapely.box(1, -4, 2, 4 - gap)], (-4, -4, 8, 4))
        worlds = [Scene((-2, gap / 2), (5, gap / 2), between, (-4, -4, 8, 4)), below, *walled(below).values()]
        spaces = [FreeSpace.of(world, radius, join) for world in worlds]
        assert [s.connects(w.start, w.goal) for s, w in zip(spaces, worlds, strict=True)] == [fits] * len(worlds)


@pytest.mark.parametrize("family", ["overlapping", "concave", "rooms"])
def test_with_a_radius_lengths_lie_between_those_among_buffers_of_shapely(family):
    """Shapely's buffers have chords for arcs, half a percent too near; round joins keep half a percent more."""
    for seed, radius in ((100, 0.03), (103, 0.19)):
        scene = oracle.FAMILIES[family](np.random.default_rng(seed))
        scene = scene.between(np.add(scene.start, 0.3), np.subtract(scene.goal, 0.3))
        low, high = (among_buffers(scene, share * radius) for share in (1, 1.0115))
        try:
            length = PathProblem.of(scene, radius, join="round").optimum.length
        except NoPath:
            length = np.inf
        assert low - 1e-6 <= length <= high + 1e-6, seed


def among_buffers(scene: Scene, radius: float) -> float:
    bounds = None if scene.bounds is None else tuple(np.add(scene.bounds, (radius, radius, -radius, -radius)))
    grown = [obstacle.buffer(radius, quad_segs=8) for obstacle in scene.obstacles]
    return oracle.shortest_length(scene.start, scene.goal, grown, bounds)
