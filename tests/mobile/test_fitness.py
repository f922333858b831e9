import numpy as np
import pytest
import shapely
from numpy.testing import assert_allclose

from pin_metaik.errors import InvalidSetting, UnknownName
from pin_metaik.mobile import ExactFitness, FreeSpace, PaperFitness, Scene, load_scene, plan_path, random_scene
from pin_metaik.mobile.paths.fitness import make_fitness

SQUARE = load_scene("one_square")  # box 4..6; c_p is 120


@pytest.mark.parametrize(
    ("via", "f", "hits"),
    [
        ([5, 5], 10 + 2 * 120 * (1 + np.sqrt(2)) ** 2, 2),
        ([5, 6.5], 10.440307, 0),
        ([4, 6, 6, 6], 10.246211, 0),
        ([5, 6.1], 441.121813, 2),
    ],
)
def test_the_papers_fitness_has_the_values_worked_out_by_hand(via, f, hits):
    costs = PaperFitness().on(FreeSpace.of(SQUARE), SQUARE.start, SQUARE.goal)
    X = np.array([via], dtype=float)
    assert costs(X)[0] == pytest.approx(f, abs=1e-6)
    assert costs.hits(X)[0] == hits


@pytest.mark.parametrize("fitness", ["exact", "paper"])
def test_the_corners_of_a_path_are_via_points_as_they_are(fitness):
    costs = make_fitness(fitness).on(FreeSpace.of(SQUARE), SQUARE.start, SQUARE.goal)
    path = plan_path(SQUARE).path
    assert costs(path.corners.reshape(1, -1))[0] == pytest.approx(path.length)
    assert costs([[4, 6, 6, 6]])[0] == pytest.approx(path.length)


def test_a_segment_without_length_hits_nothing():
    costs = PaperFitness().on(FreeSpace.of(SQUARE), (0, 4.5), (10, 4.5))
    assert costs(np.array([[0.0, 4.5]]))[0] == pytest.approx(10 + 120 * (1 + np.sqrt(2) - 0.5) ** 2, abs=1e-6)


def equation_5(X, scene, c_p=120.0):
    """The paper's fitness in plain Python."""
    hulls = [polygon.convex_hull for polygon in scene.obstacles]
    totals = []
    for x in X:
        points = np.vstack((scene.start, x.reshape(-1, 2), scene.goal))
        f = 0.0
        for a, b in zip(points[:-1], points[1:], strict=True):
            p = b - a
            f += np.hypot(*p)
            for hull in hulls:
                x_min, y_min, x_max, y_max = hull.bounds
                apart = max(a[0], b[0]) <= x_min or min(a[0], b[0]) >= x_max
                apart |= max(a[1], b[1]) <= y_min or min(a[1], b[1]) >= y_max
                sides = [p[0] * (y - a[1]) - p[1] * (x - a[0]) for x, y in hull.exterior.coords]
                if not apart and min(sides) < 0 < max(sides):
                    to = np.array([(x_min + x_max) / 2, (y_min + y_max) / 2]) - a
                    d = abs(to[0] * p[1] - to[1] * p[0]) / np.hypot(*p)
                    f += c_p * (1 + np.hypot(x_max - x_min, y_max - y_min) / 2 - d) ** 2
        totals.append(f)
    return np.array(totals)


@pytest.mark.parametrize("name", ["ten_obstacles", "fifteen_obstacles", "u_trap"])
def test_the_compiled_fitness_equals_the_formula(name):
    scene = load_scene(name)
    X = np.random.default_rng(0).uniform(0, 10, (200, 6))
    costs = PaperFitness().on(FreeSpace.of(scene), scene.start, scene.goal)
    assert_allclose(costs(X), equation_5(X, scene), rtol=1e-12)


def test_the_papers_hit_test_misses_nothing_and_makes_few_hits_up():
    ends = 10 * np.random.default_rng(0).random((20_000, 4))
    lines = shapely.linestrings(ends.reshape(-1, 2, 2))[:, None]
    true_hits = made_up = 0
    for scene in (load_scene("ten_obstacles"), load_scene("fifteen_obstacles"), random_scene(15, 1)):
        costs = PaperFitness().on(FreeSpace.of(scene), scene.start, scene.goal)
        said = costs.segment_hits(ends)
        true = shapely.relate_pattern(lines, np.array(costs.hulls, dtype=object), "T********")
        assert not (true & ~said).any()
        true_hits, made_up = true_hits + true.sum(), made_up + (said & ~true).sum()
    assert 0 < made_up < 0.08 * true_hits


def overlap(X, scene):
    """Length, and 120 (1 + length inside) for every stretch inside, by shapely."""
    solid = shapely.union_all(scene.obstacles)
    totals = []
    for x in X:
        points = np.vstack((scene.start, x.reshape(-1, 2), scene.goal))
        f = 0.0
        for segment in zip(points[:-1], points[1:], strict=True):
            line = shapely.LineString(segment)
            inside = [part.length for part in shapely.get_parts(line.intersection(solid)) if part.length > 1e-6]
            f += line.length + sum(120 * (1 + length) for length in inside)
        totals.append(f)
    return np.array(totals)


@pytest.mark.parametrize("name", ["ten_obstacles", "fifteen_obstacles", "u_trap"])
def test_the_exact_fitness_measures_what_lies_inside(name):
    scene = load_scene(name)
    X = np.random.default_rng(1).uniform(0, 10, (200, 6))
    costs = ExactFitness().on(FreeSpace.of(scene), scene.start, scene.goal)
    assert_allclose(costs(X), overlap(X, scene), rtol=1e-6)


def test_the_exact_fitness_lets_a_path_touch_obstacles_and_walls_but_not_squeeze_between_them():
    space = FreeSpace.of(SQUARE)
    costs = ExactFitness().on(space, SQUARE.start, SQUARE.goal)
    X = np.array([[4, 6, 6, 6], [4, 4, 6, 4], [0, 0, 10, 0]], dtype=float)
    assert not costs.hits(X).any()
    flush = Scene((0, 5), (10, 5), (shapely.box(4, 0, 6, 3),), (0, 0, 10, 10))
    assert ExactFitness().on(FreeSpace.of(flush), flush.start, flush.goal).hits(np.array([[0.0, 0, 10, 0]]))[0] == 1


@pytest.mark.parametrize("fitness", ["exact", "paper"])
@pytest.mark.parametrize("radius", [0.0, 0.1])
def test_a_fitness_below_the_penalty_means_a_path_that_is_free(fitness, radius):
    scene = random_scene(6, 3, fill=0.15)
    space = FreeSpace.of(scene, radius)
    X = np.random.default_rng(2).uniform(radius, 10 - radius, (4000, 4))
    costs = make_fitness(fitness).on(space, scene.start, scene.goal)(X)
    below = X[costs < 120]
    assert 100 < len(below) < len(X)
    assert all(space.holds(np.vstack((scene.start, x.reshape(-1, 2), scene.goal))) for x in below)


def test_the_detour_penalty_acts_on_the_whole_path_only_if_told():
    scene = Scene((0, 0), (1, 0), (), (0, -10, 10, 10))
    space, X = FreeSpace.of(scene), np.array([[0.0, 2.9], [0.0, 3.5]])
    segment = PaperFitness().on(space, scene.start, scene.goal)(X)
    assert_allclose(segment, [2.9 + 2.2 * np.hypot(1, 2.9), 2.2 * (3.5 + np.hypot(1, 3.5))])
    path = PaperFitness(detour_of="path").on(space, scene.start, scene.goal)(np.array([[0.5, 1.0], [0.5, 2.0]]))
    assert_allclose(path, [2 * np.hypot(0.5, 1), 2.2 * 2 * np.hypot(0.5, 2)])


def test_settings_out_of_range_and_unknown_names_are_refused():
    for wrong in ({"penalty": -1}, {"detour_penalty": 0.5}, {"detour_of": "everything"}):
        with pytest.raises(InvalidSetting):
            PaperFitness(**wrong)
    with pytest.raises(InvalidSetting):
        ExactFitness(penalty=float("nan"))
    with pytest.raises(UnknownName, match="known: exact, paper"):
        make_fitness("eq5")
