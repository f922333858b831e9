"""Kinds 2 and 21: what a world calls free is free, and what it calls a collision is one, whatever was asked before."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

import pin_metaik as mik
from benchmarks.collision_cases import aligned, around_an_arm, gantry, l_block, prism
from benchmarks.collision_truth import Truth, apart
from pin_metaik.collision import Box, Capsule, Cone, Cylinder, HalfSpace, Mesh, Obstacle, Shape, Sphere
from pin_metaik.collision.touch import random_configurations
from tests.collision.worlds import configurations, robot_of

WAYS = ("none", "convex", "capsule")
TURNS = [np.eye(3), *(pin.utils.rotate(axis, turn * np.pi) for axis, turn in (("z", 0.25), ("x", 0.5), ("y", 0.25)))]
SHAPES: dict[str, Shape] = {
    "box": Box((0.1, 0.1, 0.2)),
    "sphere": Sphere(0.05),
    "capsule": Capsule(0.03, 0.1),
    "cylinder": Cylinder(0.05, 0.1),
    "cone": Cone(0.05, 0.1),
    "hull": Mesh(0.05 * np.array([[x, y, 2 * z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)),
}


@cache
def slide(name: str = "gantry, box") -> mik.Robot:
    return gantry(name)


def at(x: float, y: float, z: float, turn: float = 0.0) -> np.ndarray:
    return np.array([x, y, z, turn])


@pytest.mark.parametrize("simplify", WAYS)
def test_boxes_on_a_raster_collide_where_arithmetic_says_so(simplify: str) -> None:
    size, half = np.array([0.1, 0.1, 0.2]) / 2, np.full(3, 0.02)
    for turn in TURNS:
        pose = pin.SE3(turn, np.zeros(3))
        world = mik.CollisionWorld(slide(), [Obstacle("part", Box((0.04, 0.04, 0.04)), pose)], simplify=simplify)
        for x, y, z in np.mgrid[-9:10:3, -9:10:3, -13:14:4].reshape(3, -1).T * 0.01:
            gap = apart(size, pin.SE3(np.eye(3), np.array([x, y, z])), half, pose)
            if abs(gap) > 1e-6:
                assert world.in_collision(at(x, y, z)) == (gap < 0.0)


@pytest.mark.parametrize("obstacle", SHAPES)
@pytest.mark.parametrize("name", ["gantry, box", "gantry, cylinder"])
def test_aligned_solids_that_overlap_are_never_free(name: str, obstacle: str) -> None:
    shape = SHAPES[obstacle]
    hits = 0
    for turn in TURNS:
        world = mik.CollisionWorld(slide(name), [Obstacle("part", shape, pin.SE3(turn, np.zeros(3)))])
        truth = Truth.of(world)
        for x, y, z in np.mgrid[-10:11:5, -10:11:5, -15:16:5].reshape(3, -1).T * 0.01:
            q = at(x, y, z)
            least = truth.least(q)
            if abs(least) > 1e-6:
                hits += least < 0.0
                assert world.in_collision(q) == (least < 0.0)
                assert bool(world.pairs_in_collision(q)) == (least < 0.0)
                assert (world.min_distance(q).distance <= 0.0) == (least < 0.0)
    assert hits > 50


def test_a_solution_on_a_raster_is_not_solved_where_it_overlaps() -> None:
    world = mik.CollisionWorld(slide(), [Obstacle("part", Box((0.04, 0.04, 0.04)), (0.0, 0.0, 0.0))])
    chain = mik.Chain(slide().model, "tool")
    assert mik.solve_ik(chain, [0.05, -0.01, 0.01], world=world).status is mik.IKStatus.IN_COLLISION
    batch = mik.solve_ik_batch(chain, [[0.05, -0.01, 0.01], [0.3, 0.3, 0.3]], world=world)
    assert batch.success.tolist() == [False, True]


@pytest.mark.parametrize("name", ["ur5", "panda"])
def test_answers_do_not_depend_on_what_was_asked_before(name: str) -> None:
    robot = robot_of(name)
    obstacles = around_an_arm()
    Q = np.concatenate([aligned(robot.model, np.random.default_rng(0), 60), configurations(name, 60)])
    world = mik.CollisionWorld(robot, obstacles)
    before, distances = world.in_collision_batch(Q), world.min_distance_batch(Q)
    world.in_collision_batch(configurations(name, 300, seed=9))
    order = np.random.default_rng(1).permutation(len(Q))
    assert (world.in_collision_batch(Q[order]) == before[order]).all()
    assert (world.min_distance_batch(Q[order]) == distances[order]).all()


@pytest.mark.parametrize("name", ["ur5", "rv7fl", "gantry, concave mesh"])
def test_every_simplification_agrees_with_distances_and_solid_angles(name: str) -> None:
    robot = slide(name) if name.startswith("gantry") else robot_of(name)
    rng = np.random.default_rng(4)
    Q = np.concatenate([aligned(robot.model, rng, 40), random_configurations(robot.model, rng, 40)])
    truth = Truth.of(mik.CollisionWorld(robot, around_an_arm()))
    least = np.array([truth.least(q) for q in Q])
    sure = np.abs(least) > 1e-6
    for simplify in WAYS:
        hit = mik.CollisionWorld(robot, around_an_arm(), simplify=simplify).in_collision_batch(Q)
        assert (hit[sure] == (least[sure] < 0.0)).all()
        coarse = mik.CollisionWorld(robot, around_an_arm(), simplify=simplify, exact=False).in_collision_batch(Q)
        assert coarse[sure & (least < 0.0)].all()


@pytest.mark.parametrize("simplify", WAYS)
@pytest.mark.parametrize("exact", [True, False])
def test_a_body_inside_a_concave_solid_collides(simplify: str, exact: bool) -> None:
    block = Obstacle("block", l_block(1.0), (0.0, 0.0, -0.25))  # an L: free in one quarter, solid in three
    world = mik.CollisionWorld(slide(), [block], simplify=simplify, exact=exact)
    assert world.in_collision(at(-0.25, 0.25, 0.0))
    assert world.in_collision(at(-0.25, -0.25, 0.0))
    assert not world.in_collision(at(0.25, 0.25, 0.0))
    assert world.min_distance(at(-0.25, 0.25, 0.0)).distance < -0.1


@pytest.mark.parametrize("simplify", WAYS)
def test_an_obstacle_inside_a_concave_link_collides_and_in_its_notch_is_free(simplify: str) -> None:
    robot = slide("gantry, concave mesh")  # an L of 20 cm
    world = mik.CollisionWorld(robot, [Obstacle("pea", Sphere(0.004), (0.0, 0.0, 0.05))], simplify=simplify)
    assert world.in_collision(at(0.05, 0.05, 0.0))  # the pea is at (-5, -5) cm of the L
    assert not world.in_collision(at(-0.05, -0.05, 0.0))  # in the notch
    assert not world.in_collision(at(-0.005, -0.005, 0.0))
    assert world.in_collision(at(-0.0035, -0.0035, 0.0))


def test_a_mesh_inside_a_mesh_collides_whichever_is_the_obstacle() -> None:
    robot = slide("gantry, concave mesh")
    around = mik.CollisionWorld(robot, [Obstacle("block", l_block(1.0), (0.0, 0.0, -0.2))])
    assert around.in_collision(at(-0.25, 0.25, 0.0))
    assert not around.in_collision(at(0.25, 0.25, 0.0))
    small = l_block(0.04)
    within = mik.CollisionWorld(robot, [Obstacle("small", small, (-0.05, -0.05, 0.03))])
    assert within.in_collision(at(0.0, 0.0, 0.0))
    assert not within.in_collision(at(-0.1, -0.1, 0.0))


@pytest.mark.parametrize("inward", [True, False])
def test_a_hollow_is_free_and_its_wall_is_not_whichever_way_the_inner_wall_faces(inward: bool) -> None:
    world = mik.CollisionWorld(slide(), [Obstacle("room", room(inward), (0.0, 0.0, -0.8))])
    assert not world.in_collision(at(0.0, 0.0, 0.0))
    assert not world.in_collision(at(0.5, 0.0, 0.0))
    assert world.in_collision(at(0.7, 0.0, 0.0))


def room(inward: bool) -> Mesh:
    """A closed box with a hollow, whose triangles face into it or away from it."""
    outline = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    outer, faces = prism(0.8 * outline, 1.6)
    inner, _ = prism(0.7 * outline, 1.4)
    vertices = np.concatenate([outer, inner + np.array([0.0, 0.0, 0.1])])
    return Mesh(vertices, np.concatenate([faces, (faces[:, ::-1] if inward else faces) + len(outer)]), "room")


def test_triangles_turned_at_random_enclose_the_same() -> None:
    block = l_block(1.0)
    assert block.triangles is not None
    turn = np.random.default_rng(0).random(len(block.triangles)) < 0.5
    mixed = Mesh(block.vertices, np.where(turn[:, None], block.triangles[:, ::-1], block.triangles))
    world = mik.CollisionWorld(slide(), [Obstacle("block", mixed, (0.0, 0.0, -0.25))])
    assert world.in_collision(at(-0.25, 0.25, 0.0))
    assert not world.in_collision(at(0.25, 0.25, 0.0))


def test_a_link_that_is_no_closed_mesh_collides_by_its_surface_alone(tmp_path: Path) -> None:
    text = gantry_of_a_bowl(tmp_path)
    world = mik.CollisionWorld(text, [Obstacle("pea", Sphere(0.01), (0.0, 0.0, 0.0))])
    assert not world.in_collision(at(0.0, 0.0, -0.1))  # in the open bowl
    assert world.in_collision(at(0.1, 0.0, -0.1))  # at its side


def gantry_of_a_bowl(folder: Path) -> mik.Robot:
    """Slides that carry an open box: a bottom and four sides without thickness."""
    ring = [(i, (i + 1) % 4) for i in range(4)]
    corners = 0.1 * np.array([[x, y, z] for z in (0, 2) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))], dtype=float)
    faces = [(0, 2, 1), (0, 3, 2)] + [t for i, j in ring for t in ((i, j, i + 4), (j, j + 4, i + 4))]
    lines = [f"v {x} {y} {z}" for x, y, z in corners.tolist()] + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces]
    (folder / "bowl.obj").write_text("\n".join(lines) + "\n")
    names, axes = ["base", "x", "y", "z", "tool"], ["1 0 0", "0 1 0", "0 0 1", "0 0 1"]
    shape = f'<collision><geometry><mesh filename="{folder}/bowl.obj"/></geometry></collision>'
    text = "".join(f'<link name="{n}">{shape if n == "tool" else ""}</link>' for n in names)
    for parent, child, axis in zip(names, names[1:], axes, strict=False):
        text += (
            f'<joint name="to {child}" type="{"revolute" if child == "tool" else "prismatic"}">'
            f'<parent link="{parent}"/><child link="{child}"/><axis xyz="{axis}"/>'
            '<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>'
        )
    (folder / "bowl.urdf").write_text(f'<robot name="bowl">{text}</robot>')
    robot = mik.load_robot(folder / "bowl.urdf")
    assert robot.collision_model.ngeoms == 1
    return robot


def test_a_thin_wall_beside_a_concave_link_is_free() -> None:
    robot, wall = robot_of("ur5"), Box((0.01, 0.3, 0.25))
    q = np.array([5.2004, -0.2997, 2.2857, 2.533, -2.5896, 3.3634])  # the mesh is 4 mm away, its hull 14 mm deep
    for simplify in WAYS:
        world = mik.CollisionWorld(robot, [Obstacle("wall", wall, (0.3, 0.0, 0.125))], simplify=simplify)
        assert not [c for c in world.pairs_in_collision(q) if "wall" in c[:2]]
        assert not world.in_collision(q)
        assert world.min_distance(q).distance > 0.0


@pytest.mark.parametrize("name", ["ur5", "panda"])
def test_among_thin_walls_only_what_meets_the_mesh_collides(name: str) -> None:
    walls = [Obstacle(f"wall {k}", Box((0.01, 0.3, 0.25)), (0.3 - 0.1 * k, 0.2 * k, 0.3)) for k in range(4)]
    world = mik.CollisionWorld(robot_of(name), walls)
    truth = Truth.of(world)
    for q in configurations(name, 60, seed=8):
        least = truth.least(q)
        if abs(least) > 1e-6:
            assert world.in_collision(q) == (least < 0.0)


def test_a_base_stands_on_what_it_touches_and_collides_with_what_it_sinks_into() -> None:
    world = mik.CollisionWorld(robot_of("ur5"), [Obstacle("floor", HalfSpace(), (0.0, 0.0, 0.0))])
    (sunk,) = world.checker.fixed  # the mesh of its base reaches below the base's origin
    world.move("floor", (0.0, 0.0, -sunk.depth))
    assert not world.checker.fixed
    world.move("floor", (0.0, 0.0, -sunk.depth + 1e-5))
    assert world.checker.fixed
