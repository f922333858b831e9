"""Paths among balls that leave little of a self-motion free: cases for the path's benchmark and its test."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

import pin_metaik as mik
from pin_metaik.collision import Obstacle, Sphere
from pin_metaik.ik.labels import signs_of
from pin_metaik.ik.layers import Layers
from pin_metaik.ik.problem import IKProblem
from pin_metaik.ik.ways import Ways

Floats = NDArray[np.float64]

BALL, MOST, CLEAR = 0.02, 60, 0.002  # m: radius of a ball; balls; distance that they keep from the known path
APART = 0.06  # rad: configurations this near to the known path may stay free
TRIES, ABOUT = 60, 0.1  # places for a ball that are tried, and how far from a joint they are, m
LOOK, SPAN = 0.1, 0.3  # rad between points of a self-motion that are looked at, and between those to be barred


def among_balls(robot: mik.Robot, chain: mik.Chain, seed: int) -> tuple[mik.CollisionWorld, list[pin.SE3], Floats]:
    """A world, four poses, and the configurations (4, nq) that are known to lead through them.

    The poses are those of a straight joint move of at most 0.1 rad. Balls that are clear of it are put in the way of
    the other solutions of the second pose, one after the other, as long as a place is found for one.
    """
    rng, world = np.random.default_rng(seed), mik.CollisionWorld(robot)
    q = np.zeros((0, chain.model.nq))
    while not len(q) or not world.clear_between(q[0], q[-1]):
        X = chain.box.sample(rng, 1) + np.linspace(0.0, 1.0, 4)[:, None] * rng.uniform(-0.1, 0.1, chain.n)
        q = chain.q(X) if all(chain.limits.contains(x) for x in X) else q[:0]
    poses = [chain.placements(one)[0] for one in q]
    motions = mik.self_motions(chain, poses[1], q[1])
    before = -1
    while before < len(world.obstacles) < MOST:
        before = len(world.obstacles)
        for curve in motions:
            for begin, end in curve.free(world, LOOK):
                places = np.linspace(begin, end, 3 + int((end - begin) / SPAN))[1:-1]
                for other in curve.q(places):
                    if np.abs(chain.x(other) - chain.x(q[1])).max() > APART and not world.in_collision(other):
                        bar(world, other, q, rng)
    return world, poses, q


def bar(world: mik.CollisionWorld, other: Floats, q: Floats, rng: np.random.Generator) -> None:
    """Put a ball in the way of a configuration that is clear of those in q (k, nq), if a place for it is found."""
    data = world.model.createData()
    pin.forwardKinematics(world.model, data, other)
    for joint in rng.integers(2, world.model.njoints - 1, TRIES).tolist():
        at = data.oMi[joint].act(rng.uniform(-ABOUT, ABOUT, 3))
        ball = Obstacle(f"ball {len(world.obstacles)}", Sphere(BALL), at)
        world.add(ball)
        if world.in_collision(other) and min(world.min_distance(one).distance for one in q) > CLEAR:
            return
        world.remove(ball.name)


def without_self_motions(chain: mik.Chain, poses: list[pin.SE3], world: mik.CollisionWorld, step: float) -> bool:
    """Whether the layers that descents alone fill have a path with steps of at most so much, rad."""
    base = chain.reference
    problems = [IKProblem.of(chain, pose, world).at(base) for pose in poses]
    layers = Layers(problems, base, np.full(chain.n, step), None, None)
    layers.fill(False, None)
    ways = Ways(chain, layers.found, layers.bound, None, base, world, False, lambda i, X: signs_of(problems[i], X))
    layers.widen(ways.best().breaks, None)
    way = replace(ways).best()
    return len(way.rows) == len(poses) and not way.breaks
