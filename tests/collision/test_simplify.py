import coal
import numpy as np
import pytest
from scipy.spatial import ConvexHull

from pin_metaik.collision.body import robot_bodies
from pin_metaik.collision.simplify import fit_capsule
from tests.collision.worlds import configurations, robot_of, world_of

ROBOTS = ["panda", "ur5", "kinova", "xarm7"]


def test_a_capsule_encloses_the_points_it_is_fitted_to() -> None:
    for seed in range(5):
        rng = np.random.default_rng(seed)
        points = rng.standard_normal((60, 3)) * rng.uniform(0.05, 1.0, 3)
        ends, radius = fit_capsule(points)
        along = ends[1] - ends[0]
        t = np.clip((points - ends[0]) @ along / max(along @ along, 1e-12), 0.0, 1.0)
        assert np.linalg.norm(points - ends[0] - t[:, None] * along, axis=1).max() <= radius


def test_a_capsule_around_a_capsule_is_hardly_larger() -> None:
    rng = np.random.default_rng(0)
    directions = rng.standard_normal((2000, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    points = 0.1 * directions + np.sign(directions[:, 2:]) * [0.0, 0.0, 0.3]
    ends, radius = fit_capsule(points @ np.linalg.qr(rng.standard_normal((3, 3)))[0])
    assert radius == pytest.approx(0.1, rel=0.05)
    assert np.linalg.norm(ends[1] - ends[0]) == pytest.approx(0.6, rel=0.05)


@pytest.mark.parametrize("name", ROBOTS)
def test_every_simplified_link_encloses_its_mesh(name: str) -> None:
    for body in robot_bodies(robot_of(name), "capsule"):
        solid = body.solid
        if not isinstance(solid.original, coal.BVHModelBase):
            continue
        vertices = np.array(solid.original.vertices())
        faces = ConvexHull(np.array(solid.hull.points())).equations
        assert (vertices @ faces[:, :3].T + faces[:, 3]).max() <= 1e-9
        local = (vertices - solid.offset.translation) @ solid.offset.rotation
        beyond = np.maximum(np.abs(local[:, 2]) - solid.coarse.halfLength, 0.0)
        assert np.hypot(np.linalg.norm(local[:, :2], axis=1), beyond).max() <= solid.coarse.radius


@pytest.mark.parametrize("simplify", ["convex", "capsule"])
@pytest.mark.parametrize("name", ROBOTS)
def test_what_is_free_simplified_is_free_and_exact_answers_are_those_of_the_meshes(name: str, simplify: str) -> None:
    Q = configurations(name, 300)
    meshes = world_of(name, simplify="none").in_collision_batch(Q)
    assert meshes.any()
    assert not meshes.all()
    assert not (meshes & ~world_of(name, None, simplify, False).in_collision_batch(Q)).any()  # type: ignore[arg-type]
    assert (meshes == world_of(name, None, simplify, True).in_collision_batch(Q)).all()  # type: ignore[arg-type]
