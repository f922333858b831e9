from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pinocchio as pin
import pytest

import pin_metaik as mik
from pin_metaik.collision import Box, HalfSpace, Mesh, Obstacle, Sphere, load_scene, scene_names
from pin_metaik.errors import FrameNotFound, InvalidConfiguration, InvalidGeometry, InvalidSetting, UnknownName
from tests.collision.worlds import brute_force, configurations, robot_of, world_of

UPRIGHT = np.array([0.0, -1.5708, 0.0, -1.5708, 0.0, 0.0])  # the UR5 stretched out along z


@pytest.mark.parametrize("scene", scene_names())
@pytest.mark.parametrize("name", ["panda", "ur5"])
def test_answers_are_those_of_every_pair_of_the_original_geometry(name: str, scene: str) -> None:
    world = world_of(name, scene)
    Q = configurations(name, 60, seed=3)
    assert world.in_collision_batch(Q).tolist() == [brute_force(world, q) for q in Q]


def test_the_nearest_distance_agrees_with_the_check_and_with_its_points() -> None:
    world = world_of("ur5", "table")
    for q in configurations("ur5", 60, seed=4):
        at = world.min_distance(q)
        assert (at.distance <= 0.0) == world.in_collision(q)
        if at.distance > 0.0:
            gap = np.linalg.norm(at.point_first - at.point_second)
            assert gap == pytest.approx(at.distance, abs=1e-6)


def test_the_nearest_to_one_obstacle_is_that_of_a_world_in_which_it_stands_alone() -> None:
    world = world_of("ur5", "shelf")
    Q = configurations("ur5", 10, seed=5)
    for name in (obstacle.name for obstacle in world.obstacles):
        alone = mik.CollisionWorld(robot_of("ur5"), [one for one in world.obstacles if one.name == name])
        for first, second in world.pairs:
            if name not in (first, second) and {first, second} <= set(alone.names):
                alone.allow(first, second)
        for q in Q:
            at, expected = world.min_distance(q, of=name), alone.min_distance(q)
            assert name in (at.first, at.second) and at.distance == pytest.approx(expected.distance, abs=1e-9)
    with pytest.raises(UnknownName, match="no body named 'lamp'"):
        world.min_distance(Q[0], of="lamp")


def test_contacts_name_both_and_depth_is_how_far_to_move_away() -> None:
    world = mik.CollisionWorld(robot_of("ur5"))
    tip = world.robot.model.createData()
    pin.framesForwardKinematics(world.model, tip, UPRIGHT)
    top = max(tip.oMf[world.model.getFrameId("ee_link")].translation[2], 0.9)
    world.add(Obstacle("ceiling", HalfSpace((0.0, 0.0, -1.0), -top), np.zeros(3)))
    (first, *_) = world.pairs_in_collision(UPRIGHT)
    assert {first.first, first.second} & {"ceiling"}
    assert first.depth > 0.0
    world.move("ceiling", (0.0, 0.0, first.depth + 1e-6))
    assert not world.in_collision(UPRIGHT)
    world.move("ceiling", (0.0, 0.0, first.depth - 1e-5))
    assert world.in_collision(UPRIGHT)


@pytest.mark.parametrize("exact", [True, False])
@pytest.mark.parametrize("margin", [0.0, 0.02, 0.1])
def test_the_margin_is_kept_to_a_tenth_of_a_millimetre(margin: float, exact: bool) -> None:
    world = mik.CollisionWorld(robot_of("ur5"), [Obstacle("ball", Sphere(0.05), (0.0, 0.0, 3.0))], margin, exact=exact)
    for first, second in mik.CollisionWorld(robot_of("ur5")).pairs:
        world.allow(first, second)  # so that only the ball is measured
    low, high = 0.8, 3.0  # the ball comes down onto the stretched arm
    while high - low > 1e-6:
        middle = 0.5 * (low + high)
        world.move("ball", (0.02, 0.1, middle))
        low, high = (middle, high) if world.in_collision(UPRIGHT) else (low, middle)
    assert world.min_distance(UPRIGHT).distance == pytest.approx(margin, abs=1e-4)


def test_a_margin_wider_than_links_are_apart_by_construction_leaves_room_to_move() -> None:
    Q = configurations("ur5", 100)
    free = ~world_of("ur5").in_collision_batch(Q)
    assert (~mik.CollisionWorld(robot_of("ur5"), margin=0.02).in_collision_batch(Q))[free].mean() > 0.7


def test_what_is_moved_or_removed_is_no_longer_there() -> None:
    world = mik.CollisionWorld(robot_of("ur5"))
    world.add(Obstacle("box", Box((0.2, 0.2, 0.2)), (0.0, 0.1, 0.8)))
    assert world.in_collision(UPRIGHT)
    world.move("box", (1.0, 0.0, 0.5))
    assert not world.in_collision(UPRIGHT)
    world.move("box", pin.SE3(np.eye(3), np.array([0.0, 0.1, 0.8])))
    assert world.in_collision(UPRIGHT)
    world.remove("box")
    assert not world.in_collision(UPRIGHT)
    assert "box" not in world.names


def test_an_obstacle_that_may_be_touched_is() -> None:
    box = Obstacle("box", Box((0.3, 0.3, 0.04)), (0.0, 0.0, -0.01), touching=("base_link",))
    assert mik.CollisionWorld(robot_of("ur5"), [replace(box, touching=())]).in_collision(UPRIGHT)
    assert not mik.CollisionWorld(robot_of("ur5"), [box]).in_collision(UPRIGHT)


def test_an_obstacle_around_the_base_collides_with_every_configuration() -> None:
    world = mik.CollisionWorld(robot_of("ur5"), [Obstacle("box", Box((0.3, 0.3, 0.08)), (0.0, 0.0, 0.04))])
    Q = configurations("ur5", 20)
    assert world.in_collision_batch(Q).all()
    assert all(("base_link", "box") in {c[:2] for c in world.pairs_in_collision(q)} for q in Q)


def test_a_small_obstacle_inside_a_links_mesh_is_found() -> None:
    world = mik.CollisionWorld(robot_of("ur5"))
    data = world.model.createData()
    pin.forwardKinematics(world.model, data, UPRIGHT)
    hull = next(b for b in world.checker.bodies if b.link == "upper_arm_link")
    centre = (data.oMi[hull.joint] * hull.placement).act(np.array(hull.solid.hull.points()).mean(axis=0))
    for simplify in ("none", "convex", "capsule"):
        other = mik.CollisionWorld(robot_of("ur5"), [Obstacle("pea", Sphere(0.002), centre)], simplify=simplify)  # type: ignore[arg-type]
        assert other.in_collision(UPRIGHT)


def test_a_grasped_object_moves_along_collides_and_can_be_let_go() -> None:
    world = mik.CollisionWorld(robot_of("panda"), load_scene("table"))
    q = pin.neutral(world.model)
    q[:7] = [0.0, 0.2, 0.0, -1.8, 0.0, 2.0, 0.785]
    assert not world.in_collision(q)
    world.attach("pole", Box((0.02, 0.02, 0.6)), "panda_hand_tcp", (0.0, 0.0, 0.25))
    assert ("pole", "table") in {c[:2] for c in world.pairs_in_collision(q)} | {
        c[1::-1] for c in world.pairs_in_collision(q)
    }
    raised = q.copy()
    raised[:7] = [0.0, -0.6, 0.0, -1.4, 0.0, 2.6, 0.785]
    assert not world.in_collision(raised)  # the fingers may touch what they hold
    world.detach("pole", raised)
    assert [o.name for o in world.obstacles][-1] == "pole"
    assert not world.grasped
    assert world.in_collision(raised)  # now it is in the fingers' way


def test_a_mesh_of_an_obstacle_is_where_it_is_put() -> None:
    corners = 0.1 * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)
    box = mik.CollisionWorld(robot_of("ur5"), [Obstacle("o", Box((0.2, 0.2, 0.2)), (0.3, 0.2, 0.5))])
    mesh = mik.CollisionWorld(robot_of("ur5"), [Obstacle("o", Mesh(corners), (0.3, 0.2, 0.5))])
    Q = configurations("ur5", 200, seed=5)
    assert box.in_collision_batch(Q).tolist() == mesh.in_collision_batch(Q).tolist()


def test_calls_that_make_no_sense_are_told() -> None:
    robot = robot_of("ur5")
    box = Obstacle("box", Box((0.1, 0.1, 0.1)), (1.0, 0.0, 0.0))
    world = mik.CollisionWorld(robot, [box])
    with pytest.raises(InvalidGeometry, match="already"):
        world.add(box)
    with pytest.raises(InvalidGeometry, match="already"):
        world.add(Obstacle("base_link", Box((0.1, 0.1, 0.1)), (1.0, 0.0, 0.0)))
    with pytest.raises(UnknownName, match="box"):
        world.move("bos", (0.0, 0.0, 0.0))
    with pytest.raises(InvalidGeometry, match="finite"):
        world.move("box", (0.0, np.nan, 0.0))
    with pytest.raises(UnknownName):
        world.remove("bos")
    with pytest.raises(UnknownName):
        world.allow("box", "nobody")
    with pytest.raises(UnknownName):
        world.detach("box", UPRIGHT)
    with pytest.raises(FrameNotFound):
        world.attach("held", Sphere(0.1), "gripper")
    with pytest.raises(UnknownName):
        mik.CollisionWorld(robot, [Obstacle("a", Sphere(0.1), (1.0, 0.0, 0.0), touching=("nobody",))])
    with pytest.raises(UnknownName):
        mik.CollisionWorld(robot, simplify="sphere")  # type: ignore[arg-type]
    with pytest.raises(InvalidSetting):
        mik.CollisionWorld(robot, margin=-0.1)
    with pytest.raises(InvalidConfiguration):
        world.in_collision(np.full(6, np.nan))
    with pytest.raises(InvalidConfiguration):
        world.min_distance(np.zeros(5))


def test_a_robot_without_geometry_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "bare.urdf"
    path.write_text(
        '<robot name="bare"><link name="a"/><link name="b"/><joint name="j" type="revolute"><parent link="a"/>'
        '<child link="b"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" velocity="1" effort="1"/></joint></robot>'
    )
    with pytest.raises(InvalidGeometry, match="no collision geometry"):
        mik.CollisionWorld(mik.load_robot(path))


def test_a_model_of_ones_own_will_do() -> None:
    model = pin.buildSampleModelManipulator()
    own = SimpleNamespace(
        name="own", model=model, collision_model=pin.buildSampleGeometryModelManipulator(model), srdf=None
    )
    q = pin.neutral(model)
    assert not mik.CollisionWorld(own, [Obstacle("far", Sphere(0.2), (5.0, 0.0, 0.0))]).in_collision(q)
    assert mik.CollisionWorld(own, [Obstacle("near", Sphere(2.0), (0.0, 0.0, 2.1))]).in_collision(q)
