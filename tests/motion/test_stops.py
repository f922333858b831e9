"""Followers in a world: nothing is touched, and braking never touches anything either."""

from __future__ import annotations

from dataclasses import dataclass

import coal
import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose
from numpy.typing import NDArray

import pin_metaik as mik
from pin_metaik import collision
from pin_metaik.collision.travel import Carriers, Travel
from pin_metaik.motion.rooms import Rooms
from pin_metaik.motion.screws import ChainScrews
from pin_metaik.motion.stops import Stopping, Stops

RATE = 200.0
HARD = (15.0, 7.5, 10.0, 12.5, 15.0, 20.0, 20.0)  # rad/s^2, of panda's data sheet
HOME = np.array([0.0, -0.3, 0.0, -2.0, 0.0, 1.8, 0.7, 0.0])


def walled(gap: float = 0.16) -> tuple[mik.Chain, mik.CollisionWorld]:
    """Panda, and a wall so far (m) in front of its hand."""
    robot = mik.load_robot("panda")
    chain = mik.Chain(robot, robot.frame)
    ahead = chain.placements(HOME)[0].translation[0] + gap
    wall = collision.Obstacle("wall", collision.Box((0.02, 2.0, 2.0)), (ahead, 0.0, 0.5))
    return chain, mik.CollisionWorld(robot, [wall])


def moved(pose: pin.SE3, *by: float) -> pin.SE3:
    return pin.SE3(pose.rotation, pose.translation + by)


def between(chain: mik.Chain, q: NDArray[np.float64], v: NDArray[np.float64], parts: int) -> NDArray[np.float64]:
    """Configurations on the way of one tick that ends at q."""
    return chain.q(chain.x(q) - np.linspace(0.0, 1.0, parts)[:, None] * v / RATE, q)


@pytest.mark.parametrize("scene", ["shelf", "table"])
def test_random_targets_among_obstacles_never_lead_into_one(scene: str) -> None:
    robot = mik.load_robot("panda")
    chain = mik.Chain(robot, robot.frame)
    world = mik.CollisionWorld(robot, collision.load_scene(scene))
    rng, limits = np.random.default_rng(0), mik.MotionLimits.of(chain, acceleration=HARD)
    follower = mik.Follower(chain, RATE, limits, world)
    q = next(q for q in chain.q(chain.box.sample(rng, 100)) if world.min_distance(q).distance > 0.01)
    for k, x in enumerate(chain.box.sample(rng, 25)):
        target = chain.placements(chain.q(x))[0]
        for _ in range(40):
            step = follower.step(target, q) if k % 3 else follower.move(chain.q(x), q)
            q = step.q
            assert not world.in_collision_batch(between(chain, q, step.v, 3), workers=1).any()
    assert world.min_distance(q).distance > 0.0


def test_from_every_tick_it_can_brake_without_a_collision() -> None:
    chain, world = walled()
    limits = mik.MotionLimits.of(chain, acceleration=HARD)
    follower, q = mik.Follower(chain, RATE, limits, world), HOME
    start = chain.placements(q)[0]
    target = moved(start, 0.5, 0.3, 0.0)
    for _ in range(80):
        step = follower.step(target, q)
        q = step.q
        braking = Stopping(
            chain,
            q,
            np.sign(step.v) * np.maximum(np.abs(step.v) - limits.acceleration / RATE, 0.0),
            limits.acceleration / RATE,
            1.0 / RATE,
        )
        ticks = np.linspace(0.0, braking.ticks, 6)
        assert not any(world.in_collision(braking.q(float(np.floor(tick)))) for tick in ticks)


def test_at_a_wall_it_slides_along_and_says_what_holds_it() -> None:
    chain, world = walled()
    follower, q = mik.Follower(chain, RATE, mik.MotionLimits.of(chain, acceleration=HARD), world, clearance=0.02), HOME
    start = chain.placements(q)[0]
    target = moved(start, 0.3, 0.25, 0.0)
    for _ in range(500):
        step = follower.step(target, q)
        q = step.q
    assert step.status is mik.FollowerStatus.NEAR_COLLISION
    assert_allclose(world.min_distance(q).distance, 0.02, atol=5e-3)
    assert chain.placements(q)[0].translation[1] > 0.15  # along the wall it has gone all the same
    for _ in range(500):
        step = follower.step(start, q)
        q = step.q
    assert step.status is mik.FollowerStatus.ON_TARGET


def test_what_it_holds_is_kept_clear_as_well() -> None:
    chain, world = walled(0.45)
    world.attach("stick", collision.Box((0.02, 0.02, 0.3)), "panda_hand_tcp", np.array([0.0, 0.0, 0.15]))
    follower, q = mik.Follower(chain, RATE, mik.MotionLimits.of(chain, acceleration=HARD), world), HOME
    pose = chain.placements(q)[0]
    forward = pin.SE3(pin.exp3(np.array([0.0, -np.pi / 2, 0.0])) @ pose.rotation, pose.translation)
    for _ in range(300):  # the stick, which hangs down, is to point through the wall
        step = follower.step(moved(forward, 0.2, 0.0, 0.0), q)
        q = step.q
        assert not world.in_collision(q)
    assert step.status is mik.FollowerStatus.NEAR_COLLISION
    assert world.min_distance(q).distance < 0.02


def test_an_obstacle_that_comes_near_pushes_it_away() -> None:
    chain, world = walled(0.1)
    follower, q = mik.Follower(chain, RATE, mik.MotionLimits.of(chain, acceleration=HARD), world), HOME
    start = chain.placements(q)[0]
    x, least = 0.07, 1.0
    for _ in range(150):
        x = max(x - 0.04 / RATE, 0.04)  # at 4 cm/s
        world.move("wall", (start.translation[0] + x, 0.0, 0.5))
        q = follower.step(start, q).q
        least = min(least, world.min_distance(q).distance)
    assert least > 0.0
    assert chain.placements(q)[0].translation[0] < start.translation[0] - 0.001


def test_begun_in_a_collision_it_goes_out_whatever_the_target() -> None:
    chain, world = walled(0.04)
    assert world.in_collision(HOME)
    limits = mik.MotionLimits.of(chain, acceleration=HARD)
    start = chain.placements(HOME)[0]
    for ahead in (0.2, -0.2):
        follower, q = mik.Follower(chain, RATE, limits, world), HOME
        deepest = world.min_distance(q).distance
        for _ in range(300):
            q = follower.step(moved(start, ahead, 0.0, 0.0), q).q
            assert world.min_distance(q).distance > deepest - 1e-3
        assert not world.in_collision(q)


def sliding() -> mik.Robot:
    """A turn, a slide, a turn, and a joint that mimics the slide, with boxes."""
    box = (
        '<collision><origin xyz="0.1 0 0.1" rpy="0.3 0 0"/><geometry><box size="0.3 0.05 0.1"/></geometry></collision>'
    )
    joint = (
        '<joint name="j{0}" type="{1}"><parent link="l{2}"/><child link="l{0}"/><origin xyz="0.2 0.1 0" rpy="0 {2} 0"/>'
        '<axis xyz="0 0 1"/><limit lower="-0.4" upper="0.9" effort="1" velocity="1"/>{3}</joint>'
    )
    kinds = ("revolute", "prismatic", "revolute", "revolute", "prismatic")
    parents = (0, 1, 2, 3, 3)
    mimics = ("", "", "", "", '<mimic joint="j2" multiplier="-0.5" offset="0.1"/>')
    links = "".join(f'<link name="l{i}">{box}</link>' for i in range(6))
    joints = "".join(
        joint.format(i + 1, kind, parent, mimic)
        for i, (kind, parent, mimic) in enumerate(zip(kinds, parents, mimics, strict=True))
    )
    return mik.load_robot(f'<robot name="sliding">{links}{joints}</robot>')


@dataclass
class Jointed:
    """A block on a joint of some kind, and a second one that turns on it."""

    model: pin.Model
    collision_model: pin.GeometryModel
    name: str = "jointed"
    srdf: None = None

    @staticmethod
    def by(joint: pin.JointModel) -> Jointed:
        model, geometry, offset = pin.Model(), pin.GeometryModel(), pin.SE3(pin.exp3(np.ones(3)), np.array([0.3, 0, 0]))
        for i, kind in enumerate((joint, pin.JointModelRY(), pin.JointModelRX())):
            model.addJoint(i, kind, offset, f"joint_{i}")
            frame = model.addFrame(pin.Frame(f"link_{i}", i + 1, 0, pin.SE3.Identity(), pin.FrameType.BODY))
            block = coal.Box(0.2, 0.1, 0.3)
            geometry.addGeometryObject(pin.GeometryObject(f"block_{i}", i + 1, frame, offset, block))
        model.lowerPositionLimit, model.upperPositionLimit = np.full(model.nq, -1.0), np.full(model.nq, 1.0)
        return Jointed(model, geometry)


def composite() -> pin.JointModelComposite:
    joint = pin.JointModelComposite(pin.JointModelRX(), pin.SE3.Identity())
    offset = pin.SE3(pin.exp3(np.ones(3)), np.array([0.1, 0.2, 0.3]))
    joint.addJoint(pin.JointModelPrismaticUnaligned(np.array([0.0, 0.6, 0.8])), offset)
    joint.addJoint(pin.JointModelRUBZ(), offset)
    return joint


JOINTED = {
    "planar": pin.JointModelPlanar(),
    "floating": pin.JointModelFreeFlyer(),
    "helical": pin.JointModelHelicalUnaligned(np.array([0.0, 0.6, -0.8]), 0.1),
    "composite": composite(),
}


@pytest.mark.parametrize("name", ["panda", "ur5", "sliding", *JOINTED])
def test_no_body_travels_farther_than_it_is_said_to(name: str) -> None:
    robot = Jointed.by(JOINTED[name]) if name in JOINTED else sliding() if name == "sliding" else mik.load_robot(name)
    frame = "link_2" if name in JOINTED else "l4" if name == "sliding" else mik.load_robot(name).frame
    chain = mik.Chain(robot.model, frame)
    world = mik.CollisionWorld(robot)
    carriers = Carriers(world.checker)
    screws, travel = ChainScrews(chain, carriers.screws), Travel(carriers)
    solids, rng = world.checker.solids, np.random.default_rng(0)
    bodies, own, tightest = solids.moving, world.checker.asked.own, 0.0
    for _ in range(20):
        x, y = chain.limits.box().sample(rng, 2)
        y = x + rng.choice([1.0, 0.1, 0.001]) * (y - x)
        points = [rng.choice(body.solid.corners, 4) for body in bodies]
        rows = [solids.place(chain.q(at)).poses[: len(bodies)].copy() for at in (x, y)]
        before, after = (
            [p @ row[:9].reshape(3, 3) + row[9:] for p, row in zip(points, one, strict=True)] for one in rows
        )
        travel.measure(1.0, solids.place(chain.q(x)).joints, screws.along(np.abs(y - x)))
        for i in range(len(bodies)):
            moved = np.linalg.norm(after[i] - before[i], axis=1).max()
            assert moved <= travel.of(i, -1) + 1e-9
            tightest = max(tightest, moved / max(travel.of(i, -1), 1e-9))
        for k, (i, j) in enumerate(own):
            gaps = (np.linalg.norm(now[i][:, None] - now[j][None], axis=2) for now in (before, after))
            assert np.abs(np.subtract(*gaps)).max() <= travel.of(i, k) + 1e-9
    assert tightest > 0.2


@pytest.mark.parametrize("simplify", ["none", "convex", "capsule"])
def test_what_is_known_of_a_distance_is_never_more_than_it(simplify: str) -> None:
    """Along a random walk, on solids of all kinds, one of them concave; and half-spaces, planes and margins."""
    robot = mik.load_robot("panda")
    chain = mik.Chain(robot, robot.frame)
    world = mik.CollisionWorld(robot, all_shapes(), simplify=simplify, margin=0.003, exact=simplify != "capsule")
    carriers, rng = world.passages.carriers, np.random.default_rng(0)
    rooms, travel, screws = Rooms(world.checker), Travel(carriers), ChainScrews(chain, carriers.screws)
    checker, x, asked = world.checker, chain.x(HOME), 0
    goal = x
    for tick in range(150):
        goal = chain.box.sample(rng, 1)[0] if tick % 30 == 0 else goal
        step = np.clip(goal - x, -0.02, 0.02)
        placed = checker.solids.place(chain.q(x + step))
        travel.measure(1.0, placed.joints, screws.along(np.abs(step)))
        rooms.went(travel)
        travel.measure(1.0, placed.joints, screws.along(np.full(chain.n, 0.05)))
        near = rooms.near(placed, travel, 0.01)
        least = rooms.least(placed, near.pairs, np.full(len(near.pairs), np.inf))
        for pair, room, part in zip(near.pairs.tolist(), near.rooms, least, strict=True):
            a, b, c, d = checker.levels_of(*pair)
            fine = (c, d) if checker.exact else (a, b)
            there = placed.gap(*fine) - checker.margin_of(*pair)
            asked += 1
            assert part <= there + 1e-7 or (there <= 0.0 and part <= 1e-7)
            assert room <= there + 1e-7 or there <= 0.0
        x = x + step
    assert asked > 500


def all_shapes() -> list[collision.Obstacle]:
    """One obstacle of every kind around panda."""
    shapes = {
        "box": (collision.Box((0.1, 0.2, 0.3)), (0.6, 0.3, 0.2)),
        "ball": (collision.Sphere(0.1), (0.5, -0.4, 0.6)),
        "cylinder": (collision.Cylinder(0.08, 0.4), (0.1, 0.6, 0.4)),
        "capsule": (collision.Capsule(0.05, 0.4), (0.3, 0.1, 1.1)),
        "cone": (collision.Cone(0.1, 0.3), (-0.4, 0.4, 0.5)),
        "floor": (collision.HalfSpace((0.0, 0.0, 1.0), -0.02), (0.0, 0.0, 0.0)),
        "curtain": (collision.Plane((1.0, 0.2, 0.0), -0.6), (0.0, 0.0, 0.0)),
    }
    outline = np.array([(0.0, 0.0), (0.3, 0.0), (0.3, 0.1), (0.1, 0.1), (0.1, 0.3), (0.0, 0.3)])  # an L
    vertices = np.array([(x, y, z) for z in (0.0, 0.4) for x, y in outline])
    flat = np.array([(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)])
    sides = [(k, (k + 1) % 6, 6 + k) for k in range(6)] + [((k + 1) % 6, 6 + (k + 1) % 6, 6 + k) for k in range(6)]
    angle = collision.Mesh(vertices, np.concatenate([flat[:, ::-1], 6 + flat, sides]))
    return [
        *(collision.Obstacle(name, shape, at) for name, (shape, at) in shapes.items()),
        collision.Obstacle("angle", angle, (0.45, -0.1, 0.1)),
    ]


def test_a_distance_that_is_remembered_is_never_larger_than_the_one_there_is() -> None:
    chain, world = walled()
    limits = mik.MotionLimits.of(chain, acceleration=HARD)
    follower, q = mik.Follower(chain, RATE, limits, world), HOME
    start, rng = chain.placements(q)[0], np.random.default_rng(0)
    for _ in range(100):
        q = follower.step(pin.SE3(start.rotation, start.translation + rng.uniform(-0.2, 0.2, 3)), q).q
        still = Stopping(chain, q, np.zeros(7), limits.acceleration / RATE, 1.0 / RATE)
        there = Stops(chain, world, 0.01).around(still)
        fresh = dict(zip(map(tuple, there.pairs.tolist()), there.rooms, strict=True))
        around = follower._around(q)
        known = dict(zip(map(tuple, around.pairs.tolist()), around.rooms, strict=True))
        assert all(known[pair] <= fresh[pair] + 1e-6 for pair in fresh.keys() & known.keys())
