"""Kind 23: points, cells and heights as obstacles."""

import numpy as np
import pytest

import pin_metaik as mik
from pin_metaik.collision import HeightField, Obstacle, Octree, PointCloud, Sphere, load_scene
from pin_metaik.errors import InvalidGeometry, MetaIKError
from tests.collision.worlds import robot_of

ROBOT, TIP = "ur5", "tool0"


def hits(shape: PointCloud | Octree | HeightField, ball: np.ndarray, radius: float) -> bool:
    """Whether a ball at a place touches an obstacle at the origin, by a world that has only these two to check."""
    world = mik.CollisionWorld(robot_of(ROBOT), [Obstacle("seen", shape)])
    for link in world.names:
        if link != "seen":
            world.allow(link, "seen")
    q = np.zeros(world.model.nq)
    tip = mik.Chain(world.model, TIP).placements(q)[0]
    world.attach("ball", Sphere(radius), TIP, tip.actInv(ball), [link for link in world.names if link != "seen"])
    return world.in_collision(q)


def test_points_of_a_cloud_are_met_at_their_radius_and_not_farther_than_a_quarter_more() -> None:
    cloud = PointCloud(np.array([[2.0, 0.0, 0.0], [0.0, 3.0, 1.0]]), 0.05)
    rng = np.random.default_rng(0)
    for _ in range(10):
        away = rng.standard_normal(3)
        away /= np.linalg.norm(away)
        assert hits(cloud, cloud.points[1] + 0.0699 * away, 0.02)
        assert not hits(cloud, cloud.points[1] + (1.26 * 0.05 + 0.0201) * away, 0.02)


@pytest.mark.parametrize("place", [(2.05, 0.15, 0.35), (2.15, 0.15, 0.35), (2.15, 0.25, 0.35)])
def test_occupied_cells_are_solid_and_others_free(place: tuple[float, float, float]) -> None:
    cells = np.stack(np.meshgrid([2.0, 2.1, 2.2], [0.1, 0.2, 0.3], [0.2, 0.3, 0.4], indexing="ij"), axis=-1)
    tree = Octree(cells.reshape(-1, 3) + 0.05, 0.1)
    assert len(tree.cells()) == 27
    assert hits(tree, np.array(place), 0.001)  # well inside, where no surface is
    for outside in ([1.98, 0.15, 0.35], [2.32, 0.15, 0.35], [2.15, 0.15, 0.52], [2.15, 0.08, 0.35]):
        assert not hits(tree, np.array(outside), 0.01)


def test_the_surface_of_cells_that_touch_at_edges_and_corners_is_closed() -> None:
    tree = Octree(np.array([[2.0, 0.0, 0.0], [2.1, 0.1, 0.0], [2.2, 0.2, 0.1], [2.1, 0.0, 0.0]]) + 0.05, 0.1)
    for centre in tree.points:
        assert hits(tree, centre, 0.001)
    assert not hits(tree, np.array([2.05, 0.15, 0.05]), 0.04)


def test_a_field_of_heights_is_ground_between_its_points_and_solid_below() -> None:
    heights = np.array([[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
    field = HeightField((2.0, 3.0), heights, -1.0)
    assert hits(field, np.array([0.0, -0.5, 0.995]), 0.01)  # the second of four rows along y
    assert not hits(field, np.array([0.0, -0.5, 1.02]), 0.01)
    assert hits(field, np.array([0.5, -0.5, 0.49]), 0.02)
    assert not hits(field, np.array([0.5, -0.5, 0.55]), 0.02)
    assert hits(field, np.array([0.1, 1.0, -0.5]), 0.001)
    assert not hits(field, np.array([1.1, 0.0, -0.5]), 0.05)


@pytest.mark.parametrize(
    "make",
    [
        lambda: PointCloud([], 0.1),  # type: ignore[arg-type]
        lambda: PointCloud([[0.0, 0.0]], 0.1),  # type: ignore[arg-type]
        lambda: PointCloud(np.full((3, 3), np.nan), 0.1),
        lambda: PointCloud(np.zeros((3, 3)), 0.0),
        lambda: PointCloud("cloud.npy", 0.1),  # type: ignore[arg-type]
        lambda: PointCloud(np.zeros((60_000, 3)), 0.1),
        lambda: Octree(np.ones((3, 3)), 1e-9),
        lambda: Octree(np.ones((3, 3)), "fine"),  # type: ignore[arg-type]
        lambda: HeightField((1.0, 1.0), np.zeros((1, 5)), -1.0),
        lambda: HeightField((1.0, 1.0), np.zeros((3, 3)), 0.0),
        lambda: HeightField((1.0, 1.0), np.zeros((3, 3)), None),  # type: ignore[arg-type]
        lambda: HeightField((1.0,), np.zeros((3, 3)), -1.0),  # type: ignore[arg-type]
        lambda: HeightField((1.0, 1.0), [[0.0], [1.0, 2.0]], -1.0),  # type: ignore[arg-type]
    ],
)
def test_what_is_no_cloud_is_refused(make: object) -> None:
    with pytest.raises(InvalidGeometry):
        make()  # type: ignore[operator]


def test_scenes_have_clouds_octrees_and_fields(tmp_path) -> None:
    np.save(tmp_path / "seen.npy", np.array([[1.0, 2.0, 3.0]]))
    head = '[[obstacle]]\nname = "a"\nshape = '
    for body, kind in (
        ('"point_cloud"\npoints = [[1, 2, 3], [4, 5, 6]]\nradius = 0.1', PointCloud),
        ('"point_cloud"\nfile = "seen.npy"\nradius = 0.1', PointCloud),
        ('"octree"\nfile = "seen.npy"\nresolution = 0.1', Octree),
        ('"height_field"\nsize = [1, 2]\nheights = [[0, 1], [1, 0]]\nbase = -1', HeightField),
    ):
        (tmp_path / "scene.toml").write_text(head + body)
        assert isinstance(load_scene(tmp_path / "scene.toml")[0].shape, kind)
    for body in (
        '"point_cloud"\nradius = 0.1',
        '"point_cloud"\npoints = [[1, 2, 3]]\nfile = "seen.npy"\nradius = 0.1',
        '"point_cloud"\nfile = "none.npy"\nradius = 0.1',
        '"octree"\nfile = "seen.npy"\nresolution = -0.1',
        '"octree"\nfile = "seen.npy"',
        '"height_field"\nsize = [1, 2]\nheights = [[0, 1], [1, 0]]',
    ):
        (tmp_path / "scene.toml").write_text(head + body)
        with pytest.raises(MetaIKError, match=r"scene\.toml"):
            load_scene(tmp_path / "scene.toml")
