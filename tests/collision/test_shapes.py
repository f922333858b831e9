from collections.abc import Callable

import numpy as np
import pinocchio as pin
import pytest

import pin_metaik as mik
from pin_metaik.collision import Box, Capsule, Cone, Cylinder, HalfSpace, Mesh, Obstacle, Plane, Sphere
from pin_metaik.errors import InvalidGeometry, MetaIKError


@pytest.mark.parametrize(
    "make",
    [
        lambda: Box((0.1, 0.2, -0.3)),
        lambda: Box((0.1, 0.2)),  # type: ignore[arg-type]
        lambda: Sphere(0.0),
        lambda: Sphere(float("nan")),
        lambda: Sphere("large"),  # type: ignore[arg-type]
        lambda: Cylinder(0.1, -1.0),
        lambda: Capsule(float("inf"), 1.0),
        lambda: Cone(0.1, 0.0),
        lambda: HalfSpace((0.0, 0.0, 0.0)),
        lambda: HalfSpace((0.0, 0.0, 1.0), float("nan")),
        lambda: Plane((0.0, float("inf"), 1.0)),
        lambda: Obstacle("box", Box((1, 1, 1)), np.full((4, 4), np.nan)),
        lambda: Obstacle("box", Box((1, 1, 1)), (0.0, np.nan, 0.0)),
        lambda: Obstacle("box", Box((1, 1, 1)), pin.SE3(2.0 * np.eye(3), np.zeros(3))),
        lambda: Obstacle("", Box((1, 1, 1)), (0.0, 0.0, 0.0)),
        lambda: Obstacle("box", "a box", (0.0, 0.0, 0.0)),  # type: ignore[arg-type]
        lambda: Obstacle("box", Box, (0.0, 0.0, 0.0)),  # type: ignore[arg-type]
        lambda: Obstacle("box", {"box": 1}, (0.0, 0.0, 0.0)),  # type: ignore[arg-type]
        lambda: Obstacle("box", Box((1, 1, 1)), None),
        lambda: Obstacle("box", Box((1, 1, 1)), "here"),
        lambda: Obstacle("box", Box((1, 1, 1)), [[1.0], [2.0, 3.0]]),
        lambda: Obstacle("box", Box((1, 1, 1)), ["0", "0", "1"]),
        lambda: Obstacle("box", Box((1, 1, 1)), (10**400, 0, 0)),
        lambda: Obstacle("box", Box((1, 1, 1)), touching="base_link"),  # type: ignore[arg-type]
        lambda: Obstacle("box", Box((1, 1, 1)), touching=3),  # type: ignore[arg-type]
        lambda: Obstacle("box", Box((1, 1, 1)), touching=(1, 2)),  # type: ignore[arg-type]
        lambda: Box([[1.0], [2.0, 3.0]]),  # type: ignore[arg-type]
        lambda: Box(("0.1", "0.2", "0.3")),  # type: ignore[arg-type]
        lambda: Box((1e9, 1.0, 1.0)),
        lambda: Sphere(True),
        lambda: Sphere(10**400),
        lambda: Plane("up"),  # type: ignore[arg-type]
        lambda: Plane((0.0, 0.0, 1.0), "high"),  # type: ignore[arg-type]
    ],
)
def test_what_is_no_solid_is_refused(make: Callable[[], object]) -> None:
    with pytest.raises(InvalidGeometry):
        make()


@pytest.mark.parametrize(
    ("shape", "half"),
    [
        (Box((0.2, 0.4, 0.6)), (0.1, 0.2, 0.3)),
        (Sphere(0.3), (0.3, 0.3, 0.3)),
        (Cylinder(0.1, 0.6), (0.1, 0.1, 0.3)),
        (Capsule(0.1, 0.4), (0.1, 0.1, 0.3)),
        (Cone(0.1, 0.6), (0.1, 0.1, 0.3)),
    ],
)
def test_shapes_are_as_large_as_they_say(shape: Box | Sphere, half: tuple[float, float, float]) -> None:
    geometry = shape.geometry()
    geometry.computeLocalAABB()
    np.testing.assert_allclose(geometry.aabb_local.max_, half, atol=1e-12)


def test_a_mesh_of_points_is_their_hull() -> None:
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    assert Mesh(corners).geometry().computeVolume() == pytest.approx(1.0)


def test_the_box_of_a_search_is_told_from_the_solid() -> None:
    with pytest.raises(MetaIKError, match=r"a solid is a mik\.collision\.Box\(size\)"):
        Obstacle("b", mik.Box((0.1, 0.1, 0.1)))  # type: ignore[arg-type]
    with pytest.raises(InvalidGeometry, match=r"bounds of a search; a solid one is a mik\.collision\.Box"):
        Obstacle("b", mik.Box([0.1], [0.2]))  # type: ignore[arg-type]


def test_an_obstacle_stands_at_the_origin_unless_told_otherwise() -> None:
    assert Obstacle("b", Box((1, 1, 1))).pose == pin.SE3.Identity()
