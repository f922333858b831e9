"""Worlds that several tests look at, built once a process, and brute-force answers to compare them with."""

from functools import cache

import numpy as np
from numpy.typing import NDArray

import pin_metaik as mik
from benchmarks.collision_truth import Truth
from pin_metaik.collision import load_scene
from pin_metaik.collision.simplify import Simplify
from pin_metaik.collision.touch import random_configurations


@cache
def robot_of(name: str) -> mik.Robot:
    return mik.load_robot(name)


@cache
def world_of(
    name: str, scene: str | None = None, simplify: Simplify = "convex", exact: bool = True
) -> mik.CollisionWorld:
    obstacles = () if scene is None else load_scene(scene)
    return mik.CollisionWorld(robot_of(name), obstacles, simplify=simplify, exact=exact)


def configurations(name: str, count: int, seed: int = 0) -> NDArray[np.float64]:
    return random_configurations(robot_of(name).model, np.random.default_rng(seed), count)


@cache
def _truth(world: mik.CollisionWorld) -> Truth:
    return Truth.of(world)


def brute_force(world: mik.CollisionWorld, q: NDArray[np.float64]) -> bool:
    """By Pinocchio and coal alone: every pair of the original geometry that the world does not exempt."""
    return _truth(world).least(q) <= world.margin
