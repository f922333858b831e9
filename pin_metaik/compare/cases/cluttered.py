"""Cluttered: the tip is in a shelf, and nothing may touch anything."""

from __future__ import annotations

import numpy as np

from pin_metaik.collision import CollisionWorld, load_scene
from pin_metaik.compare.cases.case import Case, NoTask, Task
from pin_metaik.kinematics import Chain
from pin_metaik.robots import Robot

SCENE = "shelf"
LOWER, UPPER = (0.5, -0.4, 0.16), (0.8, 0.4, 0.74)  # m; the inside of the shelf
BATCH, BATCHES = 512, 100


def shelf(robot: Robot) -> CollisionWorld:
    """The robot in front of the shelf."""
    return CollisionWorld(robot, load_scene(SCENE))


def draw(chain: Chain, rng: np.random.Generator) -> Task:
    """A pose with the tip inside the shelf.

    Raises:
        NoTask: The arm does not get there.
    """
    for _ in range(BATCHES):
        X = chain.box.sample(rng, BATCH)
        tips = chain.poses(X)[:, 0, :3, 3]
        inside = np.flatnonzero(((tips > LOWER) & (tips < UPPER)).all(axis=1))
        if len(inside):
            return Task.at(chain, X[inside[:1]])
    raise NoTask(f"none of {BATCH * BATCHES:,} random configurations has its tip in the shelf")


CLUTTERED = Case(
    "cluttered",
    "Poses of collision-free configurations with the tip inside a shelf that stands in front of the arm.",
    draw,
    world=shelf,
    success="The target is met and nothing touches anything, by coal; answers that collide may be followed by others.",
)
