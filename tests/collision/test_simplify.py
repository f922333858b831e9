import coal
import numpy as np
import pytest
from scipy.spatial import ConvexHull

from pin_metaik.collision import simplify
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


@pytest.mark.parametrize("off", [0.0, 1e-9, 1e-8, 1e-6, 1e-4, 1e-2])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_capsule_whose_axis_is_nearly_z_or_against_it_stands_along_it_to_the_last_digit(
    side: float, off: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    for turn in np.linspace(0.0, 6.0, 7):
        axis = np.array([off * np.cos(turn), off * np.sin(turn), side])
        ends = np.outer([0.2, 1.7], axis / np.linalg.norm(axis))
        monkeypatch.setattr(simplify, "fit_capsule", lambda _, ends=ends: (ends, 0.1))
        monkeypatch.setattr(simplify, "kept", lambda kind, content, make: make())
        capsule, at = simplify._capsule(ends)
        placed = [at.act(np.array([0.0, 0.0, z])) for z in (-capsule.halfLength, capsule.halfLength)]
        assert np.abs(np.array(placed)[:: int(side)] - ends).max() < 1e-15
        assert np.abs(at.rotation.T @ at.rotation - np.eye(3)).max() < 1e-15


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
