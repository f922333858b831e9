"""Kind 23: padding by name and by pair is kept in every check, layer and search, and added to the margin."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pytest

import pin_metaik as mik
from benchmarks.collision_cases import gantry, l_block
from benchmarks.collision_truth import Truth
from pin_metaik.collision import Box, HalfSpace, Obstacle, Sphere, load_scene
from pin_metaik.errors import InvalidGeometry, InvalidSetting, UnknownName
from tests.collision.worlds import configurations, robot_of

WAYS = ("none", "convex", "capsule")
UPRIGHT = np.array([0.0, -1.5708, 0.0, -1.5708, 0.0, 0.0])  # the UR5 stretched out along z


def at(x: float, y: float = 0.0, z: float = 0.0) -> np.ndarray:
    return np.array([x, y, z, 0.0])


def ends(world: mik.CollisionWorld, low: float, high: float) -> float:
    """Where the slide, a box of 10 cm, comes too near along x: low collides, high is free."""
    assert world.in_collision(at(low)) and not world.in_collision(at(high))
    while high - low > 1e-7:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if world.in_collision(at(middle)) else (low, middle)
    return high


@pytest.mark.parametrize("simplify", WAYS)
@pytest.mark.parametrize("exact", [True, False])
def test_paddings_of_two_add_up_and_that_of_the_pair_stands_instead(simplify: str, exact: bool) -> None:
    robot, ball = gantry("gantry, box"), Obstacle("ball", Sphere(0.05), (0.0, 0.0, 0.0))
    touching = 0.1  # half the box and the ball
    for padding, kept in (
        ({}, 0.01),
        ({"tool": 0.02}, 0.03),
        ({"ball": 0.03}, 0.04),
        ({"tool": 0.02, "ball": 0.03}, 0.06),
        ({"tool": 0.02, ("tool", "ball"): 0.005}, 0.015),
        ({("ball", "tool"): 0.1}, 0.11),
    ):
        world = mik.CollisionWorld(robot, [ball], 0.01, simplify=simplify, exact=exact, padding=padding)  # type: ignore[arg-type]
        x = ends(world, 0.0, 0.39)
        assert x == pytest.approx(touching + kept, abs=2e-6)
        (contact,) = world.pairs_in_collision(at(x - 0.001))
        assert contact.depth == pytest.approx(0.001, abs=1e-5)
        assert world.min_distance(at(x)).distance == pytest.approx(kept, abs=1e-5)
        (near,) = world.checker.near(at(x + 0.001))
        assert near.room == pytest.approx(0.001, abs=1e-5)


@pytest.mark.parametrize("simplify", WAYS)
def test_padded_answers_are_those_of_the_distances_of_every_pair(simplify: str) -> None:
    robot, Q = robot_of("ur5"), configurations("ur5", 80, seed=6)
    obstacles = [
        Obstacle("box", Box((0.2, 0.2, 0.2)), (0.5, 0.0, 0.2), padding={"forearm_link": 0.012}),
        Obstacle("block", l_block(0.4), (-0.5, 0.2, 0.4), padding=0.01),
        Obstacle("floor", HalfSpace(), (0.0, 0.0, -0.3)),
    ]
    padding = {"wrist_2_link": 0.006, ("wrist_3_link", "floor"): 0.015}
    world = mik.CollisionWorld(robot, obstacles, 0.002, simplify=simplify, padding=padding)  # type: ignore[arg-type]
    alone = mik.CollisionWorld(robot, margin=0.002, padding={"wrist_2_link": 0.006})
    truth, stands = Truth.of(world), {obstacle.name for obstacle in obstacles}

    def kept(a: str, b: str) -> float:
        by = {"wrist_2_link": 0.006, "block": 0.01}
        pairs = {frozenset(("wrist_3_link", "floor")): 0.015, frozenset(("box", "forearm_link")): 0.012}
        return 0.002 + pairs.get(frozenset((a, b)), by.get(a, 0.0) + by.get(b, 0.0))

    close = 0
    for q in Q:
        around = [(a, b, poses) for a, b, poses in truth.near(q) if b.name in stands]
        room = min((truth.distance(a, b, *poses) - kept(a.name, b.name) for a, b, poses in around), default=1.0)
        close += -0.02 < room < 0.0
        if abs(room) > 1e-6:
            assert world.in_collision(q) == (alone.in_collision(q) or room < 0.0)
    assert close > 3


def test_links_padded_against_each_other_are_kept_apart_and_what_is_built_so_is_not() -> None:
    robot, Q = robot_of("ur5"), configurations("ur5", 200, seed=3)
    pair = ("base_link", "wrist_3_link")
    plain, padded = mik.CollisionWorld(robot), mik.CollisionWorld(robot, padding={pair: 0.1})
    only = mik.CollisionWorld(robot)
    for first, second in only.pairs:
        if {first, second} != set(pair):
            only.allow(first, second)
    near = np.array([only.min_distance(q).distance for q in Q]) <= 0.1
    assert 0 < near.sum() < len(Q)
    assert (padded.in_collision_batch(Q) == (plain.in_collision_batch(Q) | near)).all()
    every = mik.CollisionWorld(robot, padding=dict.fromkeys(plain.names, 0.02))
    assert every.in_collision_batch(Q).mean() < 0.5


def test_a_pair_that_never_touches_is_checked_when_its_padding_reaches_farther() -> None:
    robot = robot_of("panda")
    plain = mik.CollisionWorld(robot, srdf=False)
    pair = min(pair for pair, reason in plain.disabled.items() if reason == "Never")
    assert mik.CollisionWorld(robot, srdf=False, padding={pair: 0.001}).disabled[pair] == "Never"
    assert pair not in mik.CollisionWorld(robot, srdf=False, padding={pair: 2.0}).disabled


def test_the_base_keeps_from_what_stands_only_what_was_asked_for_the_pair() -> None:
    wall = Obstacle("wall", Box((0.1, 1.0, 1.0)), (0.25, 0.0, 0.5))  # 12 cm from the base
    robot, pair = robot_of("ur5"), ("base_link", "wall")
    assert not mik.CollisionWorld(robot, [wall], padding={"base_link": 0.5}).checker.fixed
    assert not mik.CollisionWorld(robot, [wall], padding={pair: 0.1}).checker.fixed
    (contact,) = mik.CollisionWorld(robot, [wall], padding={pair: 0.3}).checker.fixed
    assert set(contact[:2]) == set(pair)


def test_solutions_batches_and_paths_keep_the_padding() -> None:
    robot, ball = gantry("gantry, box"), Obstacle("ball", Sphere(0.05), (0.0, 0.0, 0.0), padding=0.05)
    chain, world = mik.Chain(robot.model, "tool"), mik.CollisionWorld(robot, [ball])
    near, far = [0.145, 0.0, 0.0], [0.155, 0.0, 0.0]
    assert mik.solve_ik(chain, near, world=world).status is mik.IKStatus.IN_COLLISION
    assert mik.solve_ik(chain, far, world=world).success
    assert mik.solve_ik_batch(chain, [near, far], world=world).success.tolist() == [False, True]
    assert mik.solve_ik_path(chain, [[0.3, 0.0, 0.0], far], world=world).success.all()
    assert not mik.solve_ik_path(chain, [[0.3, 0.0, 0.0], near], world=world).success.all()


def test_a_search_among_padded_obstacles_ends_where_they_are_kept() -> None:
    robot = robot_of("panda")
    chain = mik.Chain(robot.model, robot.frame)
    world = mik.CollisionWorld(robot, load_scene("narrow_box"), padding={"front_wall": 0.02, "panda_hand": 0.01})
    other = mik.CollisionWorld(robot, load_scene("narrow_box"))
    found = [mik.solve_ik(chain, [0.5, 0.02 * k, 0.3], world=world, rng=k + 3) for k in range(-3, 4)]
    assert sum(result.success for result in found) > 3
    for result in found:
        if result.success:
            for first, second in (("panda_hand", "front_wall"), ("panda_link7", "front_wall")):
                assert distance(other, first, second, result.q) > (0.03 if first == "panda_hand" else 0.02) - 1e-6


def distance(world: mik.CollisionWorld, first: str, second: str, q: np.ndarray) -> float:
    copy = pickle.loads(pickle.dumps(world))
    for pair in copy.pairs:
        if set(pair) != {first, second}:
            copy.allow(*pair)
    return float(copy.min_distance(q).distance)


def test_what_is_held_or_added_brings_its_padding_and_takes_it_along() -> None:
    robot = gantry("gantry, box")
    wall = Obstacle("wall", Box((0.1, 1.0, 1.0)), (0.35, 0.0, 0.0))
    world = mik.CollisionWorld(robot, [wall])
    world.attach("peg", Sphere(0.01), "tool", (0.1, 0.0, 0.0), padding={"wall": 0.04})
    assert ends_at(world) == pytest.approx(0.3 - 0.11 - 0.04, abs=1e-5)
    assert pickle.loads(pickle.dumps(world)).padding == world.padding == {("peg", "wall"): 0.04}
    world.remove("peg")
    assert world.padding == {}
    assert ends_at(world) == pytest.approx(0.25, abs=1e-5)
    world.remove("wall")
    world.add(Obstacle("wall", wall.shape, wall.pose, padding=0.02))
    assert ends_at(world) == pytest.approx(0.23, abs=1e-5)
    world.attach("peg", Sphere(0.01), "tool", (0.1, 0.0, 0.0), padding=0.01)
    world.detach("peg", at(-0.3))
    assert world.padding == {"wall": 0.02, "peg": 0.01}


def test_what_is_given_to_the_world_goes_before_what_an_obstacle_brings_and_can_be_allowed() -> None:
    robot, ball = gantry("gantry, box"), Obstacle("ball", Sphere(0.05), (0.0, 0.0, 0.0), padding={"tool": 0.03})
    world = mik.CollisionWorld(robot, [ball], padding={("tool", "ball"): 0.02})
    assert world.padding == {("ball", "tool"): 0.02}
    assert ends(world, 0.0, 0.39) == pytest.approx(0.12, abs=1e-5)
    world.allow("tool", "ball")
    world.add(Obstacle("far", Sphere(0.05), (5.0, 0.0, 0.0), padding=0.01))  # no complaint of what was allowed
    assert not world.in_collision(at(0.0))
    world.check("tool", "ball")
    assert ends(world, 0.0, 0.39) == pytest.approx(0.12, abs=1e-5)


def ends_at(world: mik.CollisionWorld) -> float:
    """How far the slide goes along x."""
    low, high = -0.39, 0.39
    while high - low > 1e-7:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if world.in_collision(at(middle)) else (middle, high)
    return low


def test_scenes_have_paddings(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    text = '[[obstacle]]\nname = "ball"\nshape = "sphere"\nradius = 0.05\npadding = '
    path.write_text(text + "0.02\n")
    robot = gantry("gantry, box")
    assert mik.CollisionWorld(robot, load_scene(path)).padding == {"ball": 0.02}
    path.write_text(text + "{tool = 0.03}\n")
    assert mik.CollisionWorld(robot, load_scene(path)).padding == {("ball", "tool"): 0.03}
    path.write_text(text + "{hand = 0.03}\n")
    with pytest.raises(UnknownName, match="hand"):
        mik.CollisionWorld(robot, load_scene(path))
    for bad in ("-0.01", "inf", '"wide"', "true", "{tool = nan}", "{ball = 0.1}"):
        path.write_text(text + bad + "\n")
        with pytest.raises(InvalidGeometry, match="padding of 'ball'"):
            load_scene(path)


def test_paddings_that_make_no_sense_are_told() -> None:
    robot, box = robot_of("ur5"), Obstacle("box", Box((0.1, 0.1, 0.1)), (1.0, 0.0, 0.0))
    for padding in ({"wrist": 0.1}, {("wrist_1_link", "bin"): 0.1}):
        with pytest.raises(UnknownName):
            mik.CollisionWorld(robot, [box], padding=padding)
    for padding in ({"box": -0.1}, {"box": np.inf}, {("box", "box"): 0.1}, {("box", "base_link", "x"): 0.1}):
        with pytest.raises(InvalidSetting, match="padding"):
            mik.CollisionWorld(robot, [box], padding=padding)  # type: ignore[arg-type]
    with pytest.raises(InvalidSetting, match="each once"):
        mik.CollisionWorld(robot, [box], padding={("box", "base_link"): 0.1, ("base_link", "box"): 0.2})
    with pytest.raises(InvalidSetting, match="not checked"):
        mik.CollisionWorld(robot, padding={("upper_arm_link", "forearm_link"): 0.01})
    with pytest.raises(InvalidGeometry, match="is both in touching and in padding"):
        Obstacle("table", Box((1.0, 1.0, 0.1)), touching=("base_link",), padding={"base_link": 0.1})
    world = mik.CollisionWorld(robot)
    with pytest.raises(UnknownName):
        world.add(Obstacle("table", Box((1.0, 1.0, 0.1)), padding={"leg": 0.1}))
    with pytest.raises(UnknownName):
        world.add(Obstacle("table", Box((1.0, 1.0, 0.1)), touching=("leg",)))
    assert "table" not in world.names  # as if it had not been tried
