import json

import numpy as np
import pytest
import shapely

from pin_metaik.errors import InvalidGeometry, InvalidSetting, UnknownName
from pin_metaik.mobile import Scene, load_scene, plan_path, random_scene, scene_names

SQUARE = [(4, 4), (6, 4), (6, 6), (4, 6)]


def test_every_shipped_scene_loads_and_has_the_numbers_of_its_paper():
    assert scene_names() == ["fifteen_obstacles", "one_square", "ten_obstacles", "u_trap"]
    ten, fifteen = load_scene("ten_obstacles"), load_scene("fifteen_obstacles")
    assert (len(ten.obstacles), ten.start, ten.goal) == (10, (0, 0), (8, 8))
    assert (len(fifteen.obstacles), fifteen.start, fifteen.goal) == (15, (0.1, 0.1), (8.5, 8))


def test_a_scene_survives_being_written_and_read(tmp_path):
    ring = shapely.box(0, 0, 3, 3).difference(shapely.box(1, 1, 2, 2))
    scene = Scene((5, 5), (9, 9), (SQUARE[:3], ring), (-1, -1, 10, 10))
    (tmp_path / "mine.json").write_text(json.dumps(scene.as_dict()))
    again = load_scene(tmp_path / "mine.json")
    assert again.name == "mine"
    assert (again.start, again.goal, again.bounds) == (scene.start, scene.goal, scene.bounds)
    assert all(one.equals(other) for one, other in zip(again.obstacles, scene.obstacles, strict=True))


def test_polygon_files_take_start_and_goal_from_the_caller(tmp_path):
    (tmp_path / "map.geojson").write_text(shapely.to_geojson(shapely.Polygon(SQUARE)))
    scene = load_scene(tmp_path / "map.geojson", start=(0, 5), goal=(10, 5))
    assert plan_path(scene).length == pytest.approx(2 * np.sqrt(17) + 2)  # no bounds: over or under
    (tmp_path / "map.json").write_text(shapely.to_geojson(shapely.Polygon(SQUARE)))
    assert len(load_scene(tmp_path / "map.json", (0, 5), (10, 5)).obstacles) == 1


def test_start_and_goal_can_be_moved():
    scene = load_scene("one_square").between(None, (10, 9))
    assert (scene.start, scene.goal) == ((0, 5), (10, 9))


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (((0, np.nan), (1, 1)), "start must be finite"),
        (((0, 0), (1, 1, 1)), r"goal is a point \(x, y\)"),
        ((None, (1, 1)), "start is a point"),
        (((0, 0), (1, 1), (), (0, 0, 0, 1)), "x_min < x_max"),
        (((0, 0), (1, 1), (), (0, 0, np.inf, 1)), "finite"),
        (((0, 0), (1, 1), (), (0, 1)), "bounds are"),
        (((0, 0), (1, 1), [[(0, 0), (1, 1), (1, 0), (0, 1)]]), "not a simple polygon"),
    ],
)
def test_scenes_that_make_no_sense_are_refused(arguments, said):
    with pytest.raises(InvalidGeometry, match=said):
        Scene(*arguments)


def test_unknown_and_malformed_scenes_are_named(tmp_path):
    with pytest.raises(UnknownName, match=r"no scene named 'ten'.*ten_obstacles"):
        load_scene("ten")
    with pytest.raises(InvalidGeometry, match="cannot read"):
        load_scene(tmp_path / "gone.json")
    for text, said in [("[1]", "expected an object"), ("{", "not JSON"), ("{}", "has no 'obstacles'")]:
        (tmp_path / "bad.json").write_text(text)
        with pytest.raises(InvalidGeometry, match=said):
            load_scene(tmp_path / "bad.json")


def test_the_same_seed_gives_the_same_random_scene_with_its_gaps():
    one, other = random_scene(15, 4), random_scene(15, 4)
    assert all(a.equals_exact(b, 0) for a, b in zip(one.obstacles, other.obstacles, strict=True))
    tree = np.array(one.obstacles)
    distances = shapely.distance(tree[:, None], tree) + 10 * np.eye(15)
    assert distances.min() >= 0.1
    assert shapely.distance(tree, shapely.Point(one.start)).min() >= 0.1
    assert random_scene(0, 1).obstacles == ()


def test_obstacles_that_do_not_fit_are_refused():
    with pytest.raises(InvalidSetting, match="of 50 obstacles fit"):
        random_scene(50, 0, fill=0.6, gap=2.0)
    with pytest.raises(InvalidSetting, match="fill"):
        random_scene(5, 0, fill=1.5)
