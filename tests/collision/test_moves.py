"""Moves between configurations: what is called free is free all the way, and what is called touching touches."""

from __future__ import annotations

import math
import pickle
from dataclasses import dataclass
from pathlib import Path

import coal
import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose

import pin_metaik as mik
from benchmarks.collision_cases import around_an_arm, bin_of, gantry
from benchmarks.collision_truth import Truth
from pin_metaik.collision import (
    Box,
    Capsule,
    HalfSpace,
    HeightField,
    MoveStatus,
    Obstacle,
    Octree,
    PointCloud,
    Sphere,
    load_scene,
)
from pin_metaik.collision.passage import _Passage
from pin_metaik.errors import InvalidConfiguration, InvalidSetting, UnsupportedJoint
from tests.collision.worlds import configurations, robot_of, world_of

HAIR = 1e-5  # m; more than what coal's distances may be off by, and less than the resolution


@dataclass(frozen=True)
class Bodies:
    """A robot put together in code."""

    model: pin.Model
    collision_model: pin.GeometryModel
    name: str = "bodies"
    srdf: Path | None = None


class Builder:
    """Joints one by one, each with a body."""

    def __init__(self) -> None:
        self.model, self.geometry = pin.Model(), pin.GeometryModel()

    def add(self, joint: pin.JointModel, shape: object, at: tuple[float, ...] = (0, 0, 0), parent: int = 0) -> int:
        number = self.model.njoints
        limits = [np.full(size, 10.0) for size in (joint.nv, joint.nv)]
        bounds = -np.full(joint.nq, 10.0), np.full(joint.nq, 10.0)
        made = self.model.addJoint(
            parent, joint, pin.SE3(np.eye(3), np.array(at, float)), f"j{number}", *limits, *bounds
        )
        self.model.addJointFrame(made, -1)
        frame = self.model.addBodyFrame(f"b{number}", made, pin.SE3.Identity(), -1)
        self.geometry.addGeometryObject(pin.GeometryObject(f"g{number}", made, frame, pin.SE3.Identity(), shape))
        return int(made)

    def world(self, *obstacles: Obstacle, **settings: object) -> mik.CollisionWorld:
        return mik.CollisionWorld(Bodies(self.model, self.geometry), obstacles, **settings)


def slide(shape: object) -> Builder:
    """A body on a slide along x."""
    builder = Builder()
    builder.add(pin.JointModelPX(), shape)
    return builder


def arm(length: float, radius: float) -> Builder:
    """A ball at the end of an arm that turns about z."""
    builder = Builder()
    hub = builder.add(pin.JointModelRZ(), coal.Sphere(0.01), (0.0, 0.0, 5.0))
    builder.add(pin.JointModelRZ(), coal.Sphere(radius), (length, 0.0, -5.0), hub)
    return builder


def test_a_wall_of_two_millimetres_between_two_free_places_is_never_passed() -> None:
    rng = np.random.default_rng(0)
    builder = Builder()
    builder.add(pin.JointModelTranslation(), coal.Sphere(0.005))
    for _ in range(100):
        turn = pin.Quaternion(*rng.normal(size=4)).normalized().matrix()
        wall = Obstacle("wall", Box((0.002, 1.0, 1.0)), pin.SE3(turn, rng.uniform(-1.0, 1.0, 3)))
        world = builder.world(wall)
        side = rng.uniform(-0.1, 0.1, 2)
        ends = [wall.pose.act(np.array([x, *(side + rng.uniform(-0.01, 0.01, 2))])) for x in (-0.025, 0.025)]
        assert not world.in_collision(ends[0])
        assert not world.in_collision(ends[1])
        assert not world.clear_between(*ends)
        move = world.first_contact(*ends)
        assert move.status is MoveStatus.TOUCHES
        assert world.in_collision(move.q)
        assert move.contact is not None
        assert {move.contact.first, move.contact.second} == {"b1", "wall"}
        depth = wall.pose.actInv(move.q)[0]  # the ball touches 6 mm before the middle of the wall
        assert -0.006 - 1e-6 <= depth <= -0.006 + 1e-4
        assert move.clear <= move.touch


@pytest.mark.parametrize("margin", [0.0, 0.01])
def test_a_gap_is_passed_if_it_is_a_hair_wider_and_not_if_it_is_a_hair_narrower(margin: float) -> None:
    for spare, free in ((HAIR, True), (-HAIR, False)):
        half = 0.01 + margin + spare / 2
        posts = [Obstacle(f"post {s}", Box((0.02, 0.2, 0.2)), (0.5, s * (0.1 + half), 0.0)) for s in (-1, 1)]
        world = slide(coal.Box(0.1, 0.02, 0.02)).world(*posts, margin=margin)
        assert world.clear_between([0.0], [1.0], resolution=1e-6) is free
        move = world.first_contact([0.0], [1.0], resolution=1e-6)
        assert bool(move) is free
        if not free:
            before = math.sqrt(max(margin**2 - (margin + spare / 2) ** 2, 0.0))
            assert move.touch == pytest.approx(0.5 - 0.01 - 0.05 - before, abs=1e-5)


def test_a_ball_at_the_end_of_a_long_arm_grazes_or_misses() -> None:
    length, radius = 3.0, 0.02
    for spare, status in ((HAIR, MoveStatus.FREE), (-HAIR, MoveStatus.TOUCHES)):
        for angle in np.linspace(-2.5, 2.5, 23):
            away = length + 2 * radius + spare
            ball = Obstacle("ball", Sphere(radius), (away * math.cos(angle), away * math.sin(angle), 0.0))
            world = arm(length, radius).world(ball)
            assert world.first_contact([-3.0, 0.0], [3.0, 0.0], resolution=1e-6).status is status
            assert world.clear_between([-3.0, 1.0], [3.0, -2.0], resolution=1e-6) is (status is MoveStatus.FREE)


def test_two_bodies_that_both_move_pass_each_other_or_not() -> None:
    for spare, free in ((HAIR, True), (-HAIR, False)):
        builder = Builder()
        builder.add(pin.JointModelPX(), coal.Box(0.1, 0.1, 0.1))
        builder.add(pin.JointModelPX(), coal.Box(0.02, 0.02, 0.02), (1.0, 0.06 + spare, 0.0))
        world = builder.world()
        assert world.clear_between([0.0, 0.0], [1.0, -1.0], resolution=1e-6) is free
        assert world.clear_between([0.0, 0.0], [1.0, 0.5])
        back = world.first_contact([0.0, 0.0], [1.0, -1.0], resolution=1e-6)
        assert back.touch == pytest.approx(0.47, abs=1e-5) if not free else math.isnan(back.touch)


def test_a_move_that_begins_or_ends_in_collision_or_stands_still() -> None:
    world = slide(coal.Sphere(0.1)).world(Obstacle("wall", Box((0.1, 1.0, 1.0)), (0.5, 0.0, 0.0)))
    inside = world.first_contact([0.5], [0.0])
    assert (inside.clear, inside.touch) == (0.0, 0.0)
    assert not world.clear_between([0.5], [0.0])
    assert not world.clear_between([0.0], [0.5])
    assert world.clear_between([0.0], [0.0])
    assert not world.clear_between([0.5], [0.5])
    sunk = robot_of("ur5"), [Obstacle("floor", Box((1.0, 1.0, 0.2)), (0.0, 0.0, 0.0))]
    base = mik.CollisionWorld(*sunk)
    assert base.first_contact(np.zeros(6), np.ones(6)).touch == 0.0
    assert not base.clear_between(np.zeros(6), np.ones(6))


def test_what_comes_nearer_than_the_resolution_and_is_not_seen_to_touch_is_undecided() -> None:
    wall = Obstacle("wall", Box((2.0, 0.1, 1.0)), (0.5, -0.15 - 1e-5, 0.0))
    world = slide(coal.Box(0.2, 0.2, 0.2)).world(wall)  # glides 10 micrometres above it
    move = world.first_contact([0.0], [1.0], resolution=1e-3)
    assert move.status is MoveStatus.UNDECIDED
    assert not move
    assert not world.clear_between([0.0], [1.0], resolution=1e-3)
    assert world.clear_between([0.0], [0.01], resolution=1e-6)


def test_joints_without_limits_take_the_short_way_round() -> None:
    builder = Builder()
    builder.add(pin.JointModelRUBZ(), coal.Box(1.0, 0.05, 0.05))
    ball = Obstacle("ball", Sphere(0.05), (0.4, 0.0, 0.0))
    world = builder.world(ball)
    turned = [[math.cos(a), math.sin(a)] for a in (0.4, -0.4, 2.7)]
    assert not world.clear_between(turned[0], turned[1])
    assert world.clear_between(turned[0], turned[2])
    builder = Builder()
    builder.add(pin.JointModelRZ(), coal.Box(1.0, 0.05, 0.05))
    assert not builder.world(ball).clear_between([0.4], [2.0 * math.pi - 0.4 - 2.0 * math.pi])
    with_limits = builder.world(ball)
    assert not with_limits.clear_between([0.4], [0.5 + 2.0 * math.pi])  # all the way round
    builder.model.lowerPositionLimit[:], builder.model.upperPositionLimit[:] = -math.inf, math.inf
    without = builder.world(ball)
    assert without.clear_between([0.4], [0.5 + 2.0 * math.pi])
    assert_allclose(without.first_contact([0.4], [0.5 + 2.0 * math.pi]).at(1.0), [0.5])


def test_what_is_held_counts_on_the_way() -> None:
    builder = Builder()
    builder.add(pin.JointModelTranslation(), coal.Sphere(0.01))
    world = builder.world(Obstacle("post", Box((0.1, 0.1, 0.1)), (0.5, 0.3, 0.0)))
    assert world.clear_between(np.zeros(3), [1.0, 0.0, 0.0])
    world.attach("rod", Box((0.02, 0.6, 0.02)), "b1", (0.0, 0.0, 0.0))
    move = world.first_contact(np.zeros(3), [1.0, 0.0, 0.0])
    assert move.touch == pytest.approx(0.44, abs=2e-4)
    assert move.contact is not None
    assert {move.contact.first, move.contact.second} == {"post", "rod"}
    world.detach("rod", np.zeros(3))
    world.remove("rod")
    assert world.clear_between(np.zeros(3), [1.0, 0.0, 0.0])


def test_many_bodies_beside_many_others_are_decided() -> None:
    for spare, free in ((2e-3, True), (-1e-4, False)):
        builder = Builder()
        for side in (0.0, 0.04 + spare):  # two combs of ten balls that slide past each other
            carrier = builder.add(pin.JointModelPX(), coal.Sphere(0.02), (0.0, side, 0.0))
            frame = builder.model.getFrameId(f"b{carrier}")
            for k in range(1, 10):
                at = pin.SE3(np.eye(3), np.array([0.04 * k, 0.0, 0.0]))
                ball = pin.GeometryObject(f"{carrier} {k}", carrier, frame, at, coal.Sphere(0.02))
                builder.geometry.addGeometryObject(ball)
        world = builder.world()
        assert world.clear_between([0.0, 1.0], [1.0, 0.0]) is free


JOINTS = {
    "free": pin.JointModelFreeFlyer(),
    "ball": pin.JointModelSpherical(),
    "angles": pin.JointModelSphericalZYX(),
    "planar": pin.JointModelPlanar(),
    "translation": pin.JointModelTranslation(),
    "cardan": pin.JointModelUniversal(np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])),
    "screw": pin.JointModelHX(0.3),
    "continuous": pin.JointModelRUBZ(),
    "turn": pin.JointModelRevoluteUnaligned(np.array([0.6, 0.8, 0.0])),
    "slide": pin.JointModelPrismaticUnaligned(np.array([0.0, 0.6, 0.8])),
}


@pytest.mark.parametrize("name", JOINTS)
def test_no_body_moves_farther_than_its_bound(name: str) -> None:
    rng = np.random.default_rng(1)
    pin.seed(1)
    builder = Builder()
    before = builder.add(pin.JointModelRY(), coal.Box(0.3, 0.1, 0.2))
    middle = builder.add(JOINTS[name], coal.Capsule(0.1, 0.4), (0.5, 0.1, 0.2), before)
    builder.add(pin.JointModelRX(), coal.Box(0.3, 0.4, 0.2), (0.1, 0.5, -0.3), middle)
    builder.add(pin.JointModelRZ(), coal.Box(0.2, 0.1, 0.7), (0.4, -0.5, 0.3), before)  # another branch
    model, world = builder.model, builder.world()
    bodies, own = world.checker.solids.moving, world.checker.asked.own
    corners = [np.column_stack([body.solid.corners, np.ones(8)]).T for body in bodies]
    data, tightest = model.createData(), 0.0

    def places(q: np.ndarray) -> list[np.ndarray]:
        pin.forwardKinematics(model, data, q)
        return [data.oMi[body.joint].homogeneous @ points for body, points in zip(bodies, corners, strict=True)]

    for _ in range(20):
        size = rng.choice([0.01, 0.3, 2.0])
        q0, way = (
            pin.randomConfiguration(model, -np.ones(model.nq), np.ones(model.nq)),
            size * rng.normal(size=model.nv),
        )
        passage = _Passage(world.passages, q0, way)
        begin, end = np.sort(rng.uniform(0.0, 1.0, 2))
        passage.look(begin, end)
        at = places(passage._at(0.5 * (begin + end)))
        passage.look(begin, end)
        for fraction in np.linspace(begin, end, 25):
            for i, (here, there) in enumerate(zip(at, places(passage._at(fraction)), strict=True)):
                moved = np.linalg.norm((there - here)[:3], axis=0).max()
                assert moved <= passage._travel.moved[i, 0] + 1e-12
                tightest = max(tightest, moved / passage._travel.moved[i, 0])
    assert tightest > 0.5
    for (i, j), reach in zip(
        own.tolist(), passage._travel.reaches, strict=True
    ):  # the distance of two bodies of the last move
        solids, levels = world.checker.solids, world.checker.solids.levels
        here = solids.place(passage._at(0.5 * (begin + end))).distance(levels[i].hull, levels[j].hull)
        for fraction in np.linspace(begin, end, 25):
            there = solids.place(passage._at(fraction)).distance(levels[i].hull, levels[j].hull)
            assert min(here, there) < 0.0 or abs(there - here) <= reach + 1e-6


def test_a_finger_that_mimics_the_other_moves_within_its_bound() -> None:
    world = world_of("panda")
    model, data, bodies = world.model, world.model.createData(), world.checker.solids.moving
    assert len(model.mimicking_joints)
    q0, q1 = configurations("panda", 2, seed=3)
    passage = _Passage(world.passages, q0, world.passages.screws.way(q0, q1))

    def places(q: np.ndarray) -> np.ndarray:
        pin.forwardKinematics(model, data, q)
        return np.array([data.oMi[body.joint].act(body.placement.translation) for body in bodies])

    passage.look(0.2, 0.6)
    for fraction in np.linspace(0.2, 0.6, 20):
        moved = np.linalg.norm(places(passage._at(fraction)) - places(passage._at(0.4)), axis=1)
        assert (moved <= passage._travel.moved[:, 0] + 1e-12).all()


@pytest.mark.parametrize("simplify", ["none", "convex", "capsule"])
@pytest.mark.parametrize("name", ["ur5", "panda"])
def test_moves_among_obstacles_agree_with_samples_of_the_original_geometry(name: str, simplify: str) -> None:
    world = mik.CollisionWorld(robot_of(name), around_an_arm(), simplify=simplify)
    truth = Truth.of(world)
    Q = configurations(name, 40, seed=5)
    Q = Q[~world.in_collision_batch(Q)]
    k = 4 if simplify == "none" else 8
    moves = world.first_contact_batch(Q[:k], Q[k : 2 * k], workers=1)
    for move in moves:
        for fraction in np.linspace(0.0, move.clear, 20):
            assert truth.least(move.at(min(fraction, 1.0))) > -1e-6
        if move.status is MoveStatus.TOUCHES:
            assert truth.least(move.q) <= 1e-6
    assert [bool(move) for move in moves] == world.clear_between_batch(Q[:k], Q[k : 2 * k]).tolist()
    assert MoveStatus.TOUCHES in {move.status for move in moves}


@pytest.mark.parametrize("simplify", ["convex", "capsule"])
def test_where_simplified_solids_decide_what_is_free_is_free_of_these(simplify: str) -> None:
    world = mik.CollisionWorld(robot_of("panda"), around_an_arm(), simplify=simplify, exact=False)
    Q = configurations("panda", 60, seed=6)
    Q = Q[~world.in_collision_batch(Q)]
    moves = world.first_contact_batch(Q[:12], Q[12:24])
    for move in moves:
        before = min(move.clear, 1.0) * (1.0 - 1e-9)
        assert not any(world.in_collision(move.at(fraction)) for fraction in np.linspace(0.0, before, 200))
    assert MoveStatus.TOUCHES in {move.status for move in moves}


def test_every_kind_of_obstacle_stops_a_move_and_a_concave_link_too() -> None:
    cloud = np.array([[0.3, y, 0.0] for y in np.linspace(-0.2, 0.2, 40)])
    for obstacle in (
        Obstacle("cloud", PointCloud(cloud, 0.01), (0.0, 0.0, 0.0)),
        Obstacle("octree", Octree(cloud, 0.02), (0.0, 0.0, 0.0)),
        Obstacle("field", HeightField((0.1, 0.4), np.full((5, 5), 0.05), -0.2), (0.3, 0.0, 0.0)),
        Obstacle("bin", bin_of(0.1, 0.4, 0.2, 0.01), (0.3, 0.0, -0.1)),
        Obstacle("pole", Capsule(0.02, 0.5), (0.3, 0.0, 0.0)),
        Obstacle("half", HalfSpace(), pin.SE3(pin.utils.rotate("y", -math.pi / 2), np.array([0.3, 0.0, 0.0]))),
    ):
        for name in ("gantry, box", "gantry, concave mesh"):
            world = mik.CollisionWorld(gantry(name), [obstacle])
            move = world.first_contact([-0.4, 0.0, 0.0, 0.0], [0.4, 0.05, -0.05, 0.3])
            assert move.status is MoveStatus.TOUCHES, (obstacle.name, name)
            assert world.clear_between([-0.4, 0.0, 0.0, 0.0], [0.0, 0.05, -0.05, 0.3])


def test_answers_are_the_same_in_batches_after_a_pickle_and_with_workers() -> None:
    world = world_of("panda", "shelf")
    Q = configurations("panda", 16, seed=2)
    moves = world.first_contact_batch(Q[:8], Q[8:], workers=2)
    again = pickle.loads(pickle.dumps(world)).first_contact_batch(Q[:8], Q[8:])
    for one, other, q0, q1 in zip(moves, again, Q[:8], Q[8:], strict=True):
        alone = world.first_contact(q0, q1)
        assert str(one) == str(other) == str(alone)
        assert_allclose(one.at(1.0), q1, atol=1e-12)
    assert moves[0].as_dict()["status"] in list(MoveStatus)


def test_a_changed_world_is_asked_anew() -> None:
    world = slide(coal.Sphere(0.1)).world()
    assert world.clear_between([0.0], [1.0])
    world.add(Obstacle("wall", Box((0.1, 1.0, 1.0)), (0.5, 0.0, 0.0)))
    assert not world.clear_between([0.0], [1.0])
    world.move("wall", (3.0, 0.0, 0.0))
    assert world.clear_between([0.0], [1.0])


def test_bad_input_is_told_by_name() -> None:
    world = mik.CollisionWorld(robot_of("ur5"), load_scene("table"))
    q = np.zeros(6)
    with pytest.raises(InvalidConfiguration, match="ur5"):
        world.clear_between(q, np.zeros(5))
    with pytest.raises(InvalidSetting, match="resolution"):
        world.first_contact(q, q, resolution=0.0)
    with pytest.raises(InvalidConfiguration, match="Q1"):
        world.clear_between_batch([q, q], [q])
    with pytest.raises(InvalidSetting, match="fraction"):
        world.first_contact(q, q).at(1.5)
    builder = Builder()
    builder.add(pin.JointModelRUBZ(), coal.Sphere(0.1))
    with pytest.raises(InvalidConfiguration, match="length 1"):
        builder.world().clear_between([1.0, 0.0], [1.0, 0.5])
    builder = Builder()
    both = pin.JointModelComposite()
    both.addJoint(pin.JointModelRX())
    both.addJoint(pin.JointModelPY())
    builder.add(both, coal.Sphere(0.1))
    with pytest.raises(UnsupportedJoint, match="composite"):
        builder.world().clear_between(np.zeros(2), np.zeros(2))
