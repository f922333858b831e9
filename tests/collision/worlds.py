"""Worlds that several tests look at, built once a process, and brute-force answers to compare them with."""

from functools import cache

import coal
import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

import pin_metaik as mik
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


def brute_force(world: mik.CollisionWorld, q: NDArray[np.float64]) -> bool:
    """By Pinocchio and coal alone: every pair of the original geometry that the world does not exempt."""
    robot = world.robot
    geometry = robot.collision_model.clone()
    for obstacle in world.obstacles:
        geometry.addGeometryObject(pin.GeometryObject(obstacle.name, 0, 0, obstacle.pose, obstacle.shape.geometry()))
    data, shapes = robot.model.createData(), geometry.createData()
    pin.updateGeometryPlacements(robot.model, data, geometry, shapes, q)
    names = [robot.model.frames[o.parentFrame].name for o in robot.collision_model.geometryObjects]
    names += [obstacle.name for obstacle in world.obstacles]
    objects = list(geometry.geometryObjects)
    for j in range(len(objects)):
        for i in range(j):
            first, second = sorted((names[i], names[j]))
            apart = objects[i].parentJoint != objects[j].parentJoint
            if apart and (first, second) not in world.disabled:
                result = coal.CollisionResult()
                poses = [coal.Transform3s(shapes.oMg[k].rotation, shapes.oMg[k].translation) for k in (i, j)]
                coal.collide(
                    objects[i].geometry, poses[0], objects[j].geometry, poses[1], coal.CollisionRequest(), result
                )
                if result.isCollision():
                    return True
    return False
