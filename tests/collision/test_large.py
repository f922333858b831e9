"""Kind 22: among many obstacles a world asks about those that are near, keeps nothing by pair, and answers the same."""

from __future__ import annotations

import pickle
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import pin_metaik as mik
from pin_metaik.collision import Box, HalfSpace, Obstacle, Plane, Sphere
from tests.collision.worlds import configurations, robot_of


def boxes(count: int, seed: int = 0) -> list[Obstacle]:
    rng = np.random.default_rng(seed)
    spots = (spot for spot in rng.uniform(-1.2, 1.2, (10 * count, 3)) if np.linalg.norm(spot) > 0.45)
    return [Obstacle(f"box {k}", Box((0.04, 0.04, 0.04)), spot) for k, spot in zip(range(count), spots, strict=False)]


def test_a_large_world_answers_as_its_parts_do() -> None:
    every, Q = boxes(300), configurations("panda", 60)
    whole = mik.CollisionWorld(robot_of("panda"), every)
    parts = [mik.CollisionWorld(robot_of("panda"), every[k : k + 100]) for k in (0, 100, 200)]
    assert (whole.in_collision_batch(Q) == np.any([part.in_collision_batch(Q) for part in parts], axis=0)).all()
    least = np.min([part.min_distance_batch(Q) for part in parts], axis=0)
    assert whole.min_distance_batch(Q) == pytest.approx(least, abs=1e-9)
    for q in Q[:20]:
        hits = {(c.first, c.second) for part in parts for c in part.pairs_in_collision(q)}
        assert {(c.first, c.second) for c in whole.pairs_in_collision(q)} == hits


def test_changes_leave_a_world_as_if_it_had_been_built_so() -> None:
    Q = configurations("panda", 60, seed=2)
    world = mik.CollisionWorld(robot_of("panda"), boxes(100))
    world.in_collision_batch(Q)
    world.add(Obstacle("floor", HalfSpace(), (0.0, 0.0, -0.1)))
    world.in_collision_batch(Q)
    world.remove("box 7")
    world.move("box 8", (0.4, 0.0, 0.5))
    world.in_collision_batch(Q)
    world.attach("held", Box((0.05, 0.05, 0.2)), "panda_hand_tcp", (0.0, 0.0, 0.1))
    world.allow("panda_hand", "box 8")
    world.allow("panda_link1", "panda_hand")
    world.in_collision_batch(Q)
    world.check("panda_link1", "panda_hand")

    fresh = [obstacle for obstacle in boxes(100) if obstacle.name not in ("box 7", "box 8")]
    fresh += [Obstacle("box 8", Box((0.04, 0.04, 0.04)), (0.4, 0.0, 0.5), touching=("panda_hand",))]
    again = mik.CollisionWorld(robot_of("panda"), [*fresh, Obstacle("floor", HalfSpace(), (0.0, 0.0, -0.1))])
    again.attach("held", Box((0.05, 0.05, 0.2)), "panda_hand_tcp", (0.0, 0.0, 0.1))
    assert (world.in_collision_batch(Q) == again.in_collision_batch(Q)).all()
    assert world.min_distance_batch(Q) == pytest.approx(again.min_distance_batch(Q), abs=1e-12)
    world.detach("held", Q[0])
    world.remove("held")
    assert set(world.names) == set(again.names) - {"held"}


def test_what_is_sampled_of_two_bodies_is_sampled_once() -> None:
    world = mik.CollisionWorld(robot_of("ur5"), boxes(20))
    before = dict(world.checker and world._samples)
    world.add(Obstacle("new", Sphere(0.1), (1.0, 1.0, 1.0)))
    assert dict(world.checker and world._samples) == before
    world.attach("held", Sphere(0.02), "tool0")
    kept = world.checker and world._samples
    assert {pair: kept[pair] for pair in before} == before
    world.remove("held")
    assert dict(world.checker and world._samples) == before


def test_a_world_keeps_what_there_is_not_every_pair_of_it() -> None:
    pairs = mik.CollisionWorld(robot_of("panda"), boxes(400)).checker.asked
    assert len(pairs.own) < 60
    assert pairs.against.nbytes < 20 * 400


def test_sheets_without_end_are_met_from_afar() -> None:
    robot = robot_of("ur5")
    low = np.array([0.0, 0.5, 0.5, 0.0, 0.0, 0.0])
    for pose in ((0.0, 0.0, 0.0), (1e3, -1e3, 0.0)):
        for shape in (HalfSpace((0.0, 0.0, 2.0), 0.4), Plane((0.0, 0.0, 1.0), -0.1)):
            assert mik.CollisionWorld(robot, [Obstacle("sheet", shape, pose)]).in_collision(low)
    below = mik.CollisionWorld(robot, [Obstacle("floor", HalfSpace((1.0, 2.0, 3.0), -3.0), (0.0, 0.0, 0.0))])
    q = np.array([0.0, -1.5708, 0.0, -1.5708, 0.0, 0.0])
    assert not below.in_collision(q)
    assert 0.3 < below.min_distance(q).distance < 3.0 or below.min_distance(q).first != "floor"


def test_threads_ask_one_world_and_a_pickled_one_answers_the_same() -> None:
    Q = configurations("ur5", 80, seed=3)
    world = mik.CollisionWorld(robot_of("ur5"), boxes(100))
    alone = world.in_collision_batch(Q).tolist()
    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(world.in_collision, Q)) == alone
    assert pickle.loads(pickle.dumps(world)).in_collision_batch(Q).tolist() == alone
