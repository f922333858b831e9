"""Where to put a base: better than at random, and as it says."""

from __future__ import annotations

from collections.abc import Generator
from functools import cache

import numpy as np
import pinocchio as pin
import pytest

import pin_metaik as mik
from pin_metaik.collision import Box, Obstacle
from pin_metaik.errors import InvalidBounds, InvalidTarget
from pin_metaik.reachable import BasePlacement, place_base
from tests.collision.worlds import robot_of
from tests.robots_under_test import chain_of


@cache
def poses() -> list[pin.SE3]:
    """Ten poses on a table that stands far from the origin."""
    rng, found = np.random.default_rng(7), []
    for _ in range(10):
        turn = pin.rpy.rpyToMatrix(np.pi, 0.0, rng.uniform(-1.0, 1.0))
        found.append(pin.SE3(turn, np.array([3.0, 2.0, 0.0]) + rng.uniform([-0.3, -0.3, 0.1], [0.3, 0.3, 0.4])))
    return found


def check(place: BasePlacement, targets: list[pin.SE3], chain: mik.Chain) -> None:
    """Every answer puts the tip where its target is in the world."""
    for result, target in zip(place.results, targets, strict=True):
        if result.success:
            there = place.pose * chain.placements(result.q)[0]
            assert np.linalg.norm(there.translation - target.translation) < 2e-5
            assert np.linalg.norm(pin.log3(there.rotation.T @ target.rotation)) < 2e-5


class Anywhere:
    """Places at random."""

    def search(self, run: mik.Search) -> Generator[np.ndarray, np.ndarray, None]:
        while True:
            yield run.space.sample(run.rng, 20)


def test_ten_poses_are_reached_and_better_than_from_random_places() -> None:
    chain = chain_of("ur5")
    around = mik.Box([2.0, 1.0, -np.pi], [4.0, 3.0, np.pi])
    place = place_base(chain, poses(), region=around, budget=mik.Budget(evaluations=500))
    assert place
    assert place.reached == 10
    check(place, poses(), chain)
    assert (place.manipulability > 0.0).all()
    anywhere = place_base(chain, poses(), region=around, algorithm=Anywhere(), budget=mik.Budget(evaluations=100))
    assert place.cost < anywhere.cost


def test_the_same_place_again_and_plain_values() -> None:
    chain = chain_of("ur5")
    first, again = (place_base(chain, poses()[:3], budget=mik.Budget(evaluations=60), rng=3) for _ in range(2))
    assert (first.x, first.y, first.yaw) == (again.x, again.y, again.yaw)
    values = first.as_dict()
    assert values["reached"] == first.reached
    assert len(values["q"]) == 3
    assert "of 3 poses reached" in str(first)


def test_obstacles_stay_where_they_are_while_the_robot_is_put_elsewhere() -> None:
    chain, robot = chain_of("ur5"), robot_of("ur5")
    targets = poses()[:2]
    pillar = Obstacle("pillar", Box((0.5, 0.5, 2.0)), (2.3, 2.0, 1.0))
    world = mik.CollisionWorld(robot, [pillar])
    place = place_base(chain, targets, world=world, budget=mik.Budget(evaluations=80))
    assert place
    check(place, targets, chain)
    there = mik.CollisionWorld(robot, [Obstacle("pillar", pillar.shape, place.pose.inverse() * pin.SE3(pillar.pose))])
    assert not any(there.in_collision(result.q) for result in place.results)
    assert world.obstacles == (pillar,)  # the world that was given is left as it was
    inside = mik.Box([2.3, 2.0, -0.1], [2.31, 2.01, 0.1])
    assert not place_base(chain, targets, world=world, region=inside, budget=mik.Budget(evaluations=20)).reached


def test_loose_targets_and_positions_and_a_watch() -> None:
    chain = chain_of("ur5")
    loose = [mik.Target(pose, orientation_tolerance=(0.1, 0.1, np.inf)) for pose in poses()[:2]]
    assert place_base(chain, loose, budget=mik.Budget(evaluations=60)).reached == 2
    stopped = place_base(chain, [[3.0, 2.0, 0.3]], watch=lambda at: True)
    assert stopped.interrupted
    assert stopped.evaluations < 1000


def test_bad_input_is_told_by_name() -> None:
    chain = chain_of("ur5")
    with pytest.raises(InvalidTarget, match="at least one"):
        place_base(chain, [])
    with pytest.raises(InvalidBounds, match="x, y and yaw"):
        place_base(chain, poses(), region=mik.Box([0.0], [1.0]))
